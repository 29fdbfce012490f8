#include "cli/scene_hints.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <utility>

namespace lightwell {
namespace {

// Halls, stadiums and streets are shorter than this; a room of 2 m in millimetres is longer.
constexpr double longest_building = 1500.0;  // m

std::string size_hint(const Eigen::AlignedBox3d& box) {
  const double length = box.sizes().maxCoeff();
  if (!(length > longest_building)) return {};
  return fmt::format(
      "The scene is {:.4g} m long. Are its numbers millimetres? A .toml scene says so with unit = "
      "\"mm\"; models of other formats are to be scaled.",
      length);
}

std::string lamp_hint(const Scene& scene, const Eigen::AlignedBox3d& box) {
  const double far = box.diagonal().norm();
  const Lamp* first = nullptr;
  int count = 0;
  for (const Lamp& lamp : scene.lamps) {
    if (!(box.exteriorDistance(lamp.position) > far)) continue;
    if (count++ == 0) first = &lamp;
  }
  if (count == 0) return {};
  return fmt::format(
      "Lamp '{}'{} lies {:.4g} m outside of all surfaces, which measure {:.4g} m across. Are its "
      "coordinates in the unit of the scene?",
      first->name, count == 1 ? "" : fmt::format(" and {} more", count - 1),
      box.exteriorDistance(first->position), far);
}

}  // namespace

std::vector<std::string> scene_hints(const Scene& scene) {
  if (scene.surfaces.empty()) return {};
  const Bounds bounds = scene_bounds(scene);
  const Eigen::AlignedBox3d box(bounds.low, bounds.high);
  std::vector<std::string> hints;
  for (std::string hint : {size_hint(box), lamp_hint(scene, box)}) {
    if (!hint.empty()) hints.push_back(std::move(hint));
  }
  return hints;
}

}  // namespace lightwell
