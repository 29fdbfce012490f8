#include "cli/scene_hints.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <utility>
#include <variant>

namespace lightwell {
namespace {

Eigen::AlignedBox3d bounds_of(const Scene& scene) {
  Eigen::AlignedBox3d box;
  for (const Surface& surface : scene.surfaces) {
    if (const auto* mesh = std::get_if<PolygonMesh>(&surface.shape)) {
      for (const Eigen::Vector3d& vertex : mesh->vertices) box.extend(vertex);
    } else {
      const auto& sphere = std::get<Sphere>(surface.shape);
      const auto radius = Eigen::Vector3d::Constant(sphere.radius);
      box.extend(sphere.center - radius);
      box.extend(sphere.center + radius);
    }
  }
  return box;
}

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
  const Eigen::AlignedBox3d box = bounds_of(scene);
  if (box.isEmpty()) return {};
  std::vector<std::string> hints;
  for (std::string hint : {size_hint(box), lamp_hint(scene, box)}) {
    if (!hint.empty()) hints.push_back(std::move(hint));
  }
  return hints;
}

}  // namespace lightwell
