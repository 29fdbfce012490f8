#pragma once

#include <string>

#include "tests/scene/scene_file_test.h"

namespace lightwell::test {

/// Reads scenes in Mitsuba's format.
class MitsubaTest : public SceneFileTest {
 protected:
  Scene read(const std::string& content) const {
    return read_file("scene.xml", "<scene version=\"3.0.0\">\n" + content + "</scene>");
  }
  // Material of a rectangle with this BSDF.
  Material material(const std::string& bsdf) const {
    return first_material(read("<shape type=\"rectangle\">" + bsdf + "</shape>"));
  }
  std::string error(const std::string& content) const {
    return message_of<InputError>([&] { read(content); });
  }
};

}  // namespace lightwell::test
