#include "cli/scene_hints.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

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

// The middle of a scene's vertices, by their medians, and the distance from it within which three
// of four vertices lie, along the axis where that is most.
struct Bulk {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double radius = 0.0;  // m
};

Bulk bulk_of(const std::vector<Eigen::Vector3d>& vertices) {
  constexpr std::size_t enough = 100000;  // vertices
  const std::size_t stride = vertices.size() / enough + 1;
  Bulk bulk;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> x;
    for (std::size_t v = 0; v < vertices.size(); v += stride) x.push_back(vertices[v][axis]);
    const auto at = [&](std::size_t rank) {
      const auto place = x.begin() + static_cast<std::ptrdiff_t>(rank);
      std::ranges::nth_element(x, place);
      return *place;
    };
    bulk.middle[axis] = at(x.size() / 2);
    for (double& value : x) value = std::abs(value - bulk.middle[axis]);
    bulk.radius = std::max(bulk.radius, at(x.size() * 3 / 4));
  }
  return bulk;
}

// Rays have the digits of single precision over the whole scene, so a stray part takes the digits
// of the rest.
std::string stray_hint(const Scene& scene) {
  constexpr double apart = 2000.0;  // radii of the rest; rounding is then 1e-4 of the radius
  std::vector<Eigen::Vector3d> vertices;
  for (const Surface& surface : scene.surfaces) {
    const auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
    if (mesh) vertices.insert(vertices.end(), mesh->vertices.begin(), mesh->vertices.end());
  }
  if (vertices.empty()) return {};
  const Bulk bulk = bulk_of(vertices);
  const Surface* first = nullptr;
  int count = 0;
  double farthest = 0.0;
  for (const Surface& surface : scene.surfaces) {
    const auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
    if (!mesh) continue;
    double reach = 0.0;
    for (const Eigen::Vector3d& vertex : mesh->vertices) {
      reach = std::max(reach, (vertex - bulk.middle).cwiseAbs().maxCoeff());
    }
    if (!(reach > apart * bulk.radius)) continue;
    if (count++ == 0) first = &surface;
    farthest = std::max(farthest, reach);
  }
  if (count == 0) return {};
  return fmt::format(
      "Surface '{}'{} reaches {:.3g} m from the middle of the scene, most of which lies within "
      "{:.3g} m. Light there may be wrong by rounding. Leave such surfaces out, or move them "
      "closer.",
      first->name, count == 1 ? "" : fmt::format(" and {} more", count - 1), farthest, bulk.radius);
}

// Programs that keep coordinates in single precision round them far from the origin. Half of the
// numbers that are rounded have a mantissa whose last bit is set; numbers that a person writes,
// such as whole metres, have not.
std::string rounding_hint(const Scene& scene, const Eigen::AlignedBox3d& box) {
  constexpr double harmless = 1e-4;  // of the scene's length
  const double unit = scene.metres_per_unit, length = box.sizes().maxCoeff() / unit;
  double step = 0.0;
  for (const Surface& surface : scene.surfaces) {
    const auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
    if (!mesh) return {};
    for (const Eigen::Vector3d& vertex : mesh->vertices) {
      for (const double metres : vertex) {
        const double x = metres / unit;
        const auto single = static_cast<float>(x);
        constexpr double exactly = 1e-14;  // rounding of doubles by the unit
        if (std::abs(static_cast<double>(single) - x) > exactly * std::abs(x)) return {};
        if ((std::bit_cast<std::uint32_t>(single) & 1u) == 0) continue;
        const int exponent = std::ilogb(single) - std::numeric_limits<float>::digits + 1;
        step = std::max(step, std::ldexp(1.0, exponent));
      }
    }
  }
  if (!(step > harmless * length)) return {};
  const double far =
      std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff()) / unit;
  return fmt::format(
      "The scene lies {:.3g} {} from the origin of its coordinates, which seem to be rounded there "
      "to multiples of {:.3g} {} (single precision). Move the model close to the origin before it "
      "is exported.",
      far, unit == 1.0 ? "m" : "units", step, unit == 1.0 ? "m" : "units");
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
  const std::string stray = stray_hint(scene);
  // A stray part makes the scene long.
  const std::string size = stray.empty() ? size_hint(box) : stray;
  for (std::string hint : {size, rounding_hint(scene, box), lamp_hint(scene, box)}) {
    if (!hint.empty()) hints.push_back(std::move(hint));
  }
  return hints;
}

}  // namespace lightwell
