#include <algorithm>
#include <array>
#include <string>

#include "scene/io/pov/pov_language.h"
#include "scene/io/pov/pov_shapes.h"
#include "scene/io/pov/pov_view.h"
#include "scene/io/read_scene.h"
#include "scene/io/remarks.h"

namespace lightwell {
namespace {

constexpr std::array<std::string_view, 5> pov_left_out = {"media", "fog", "rainbow", "photons",
                                                          "atmosphere"};

}  // namespace

Scene read_pov(const std::filesystem::path& path) {
  Scene scene{.file = path, .title = path.stem().string(), .relative_units = true};
  scene.notes.emplace_back(
      "POV-Ray files name no units: lengths were read as metres. Light is relative: a surface of "
      "colour 1 that diffuses all light of a lamp of colour 1 has the radiance 1 W/(sr m2).");
  Remarks remarks;
  PovLanguage language(remarks);
  PovShapes shapes(scene, remarks);
  language.read(path, [&](const PovNode& block) {
    const std::string_view word = block.keyword;
    if (word == "camera") return add_pov_camera(block, scene, remarks);
    if (word == "sky_sphere" || word == "background") {
      return add_pov_sky(block, language.gamma(), scene, remarks);
    }
    if (word == "global_settings") return;
    if (std::ranges::find(pov_left_out, word) != pov_left_out.end()) {
      return remarks.add("Blocks that have no equal were left out", word);
    }
    if (!shapes.add(block, language.defaults().get(), language.gamma())) {
      block.fail("is no block that is known here");
    }
  });
  shapes.finish();
  if (scene.surfaces.empty()) {
    fail_without_surfaces(path, "the scene has no shapes that can be read", remarks);
  }
  finish_scene(shapes.repairs(), remarks, scene);
  return scene;
}

}  // namespace lightwell
