#pragma once

#include <gtest/gtest.h>

#include <string>

#include "scene/errors.h"
#include "scene/io/read_scene.h"
#include "tests/temporary_folder.h"

namespace lightwell::test {

/// A test with a temporary folder for scene files.
class SceneFileTest : public testing::Test {
 protected:
  Scene read_file(const std::string& name, const std::string& content) const {
    return read_scene(folder.write(name, content));
  }
  /// The material of the scene's first surface.
  static Material first_material(const Scene& scene) {
    return scene.materials.at(static_cast<std::size_t>(scene.surfaces.at(0).material));
  }
  TemporaryFolder folder;
};

}  // namespace lightwell::test
