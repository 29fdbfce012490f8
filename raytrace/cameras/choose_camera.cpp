#include "raytrace/cameras/choose_camera.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "scene/errors.h"
#include "scene/io/nearest_name.h"
#include "scene/name_in_messages.h"

namespace lightwell {

const Camera& choose_camera(const Scene& scene, const std::string& name) {
  if (scene.cameras.empty()) {
    throw InputError(fmt::format(
        "{} has no camera, so there is nothing to look from; add one "
        "([[cameras]] in a .toml scene, see docs/scene-format.md), or use 'lightwell solve'",
        name_in_messages(scene)));
  }
  if (name.empty()) return scene.cameras.front();
  std::vector<std::string> names;
  for (const Camera& camera : scene.cameras) {
    if (camera.name == name) return camera;
    names.push_back(camera.name);
  }
  throw InputError(fmt::format("{}: there is no camera '{}'; the scene has: {}.{}",
                               name_in_messages(scene), name, fmt::join(names, ", "),
                               did_you_mean(name, names)));
}

}  // namespace lightwell
