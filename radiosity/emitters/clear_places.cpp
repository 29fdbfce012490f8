#include "radiosity/emitters/clear_places.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <variant>

#include "mesh/geometry/box_tree.h"
#include "mesh/geometry/welded_points.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/emitters/find_emitters.h"
#include "scene/round_shape.h"
#include "scene/scenery_box.h"

namespace lightwell {
namespace {

// The plane of a surface beside a lamp.
struct NearPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, to the lamp's side
  double height = 0.0;                                // m, of the lamp over the plane
};

class NearSurfaces {
 public:
  NearSurfaces(const Scene& scene, const std::vector<double>& distance)
      : scene_(scene),
        distance_(distance),
        most_(*std::ranges::max_element(distance)),
        rounding_(weld_share * scenery_box(scene).diagonal().norm()),
        planes_(scene.lamps.size()),
        tree_(places(scene)) {
    for (const Surface& surface : scene.surfaces) {
      if (const auto* mesh = std::get_if<PolygonMesh>(&surface.shape)) {
        for (const Facet& facet : mesh->facets) add(surface, *mesh, facet);
      } else {
        add(surface, *round_shape(surface));
      }
    }
  }

  const std::vector<NearPlane>& of(std::size_t lamp) const { return planes_[lamp]; }

 private:
  static std::vector<Eigen::AlignedBox3d> places(const Scene& scene) {
    std::vector<Eigen::AlignedBox3d> places;
    for (const Lamp& lamp : scene.lamps) places.emplace_back(lamp.position);
    return places;
  }

  // The lamps within the largest distance of a box.
  const std::vector<int>& lamps_at(const Eigen::AlignedBox3d& box) {
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(most_);
    tree_.find_overlaps({box.min() - margin, box.max() + margin}, found_);
    return found_;
  }

  void add(const Surface& surface, const PolygonMesh& mesh, const Facet& facet) {
    Eigen::AlignedBox3d box;
    for (const int v : facet.boundary) box.extend(mesh.vertices[v]);
    if (lamps_at(box).empty()) return;
    const Eigen::Vector3d front = facet_normal(mesh, facet);
    const std::vector<Loop> loops = facet_loops(mesh, facet);
    for (const int lamp : found_) {
      const Eigen::Vector3d& place = scene_.lamps[lamp].position;
      const double height = front.dot(place - loops[0][0]);
      if (std::abs(height) >= distance_[lamp]) continue;
      // A form factor of 1 above the facet, 1/2 at an edge and 1/4 at a right corner.
      constexpr double least = 0.2;
      const Eigen::Vector3d over = place + (distance_[lamp] - height) * front;
      if (std::abs(point_to_polygon(over, -front, loops)) < least) continue;
      add(lamp, surface, front, height);
    }
  }

  void add(const Surface& surface, const RoundShape& shape) {
    for (const int lamp : lamps_at(bounds(shape))) {
      const Eigen::Vector3d& place = scene_.lamps[lamp].position;
      const Eigen::Vector3d foot = nearest_on(shape, place), front = front_normal(shape, place);
      if ((place - foot).norm() >= distance_[lamp]) continue;
      add(lamp, surface, front, front.dot(place - foot));
    }
  }

  void add(int lamp, const Surface& surface, const Eigen::Vector3d& front, double height) {
    const double side = is_behind(scene_.lamps[lamp], surface, front, height) ? -1.0 : 1.0;
    planes_[lamp].push_back({.normal = side * front, .height = side * height});
  }

  bool is_behind(const Lamp& lamp, const Surface& surface, const Eigen::Vector3d& front,
                 double height) const {
    if (scene_.materials[surface.material].one_sided) return false;
    if (std::abs(height) > rounding_) return height < 0.0;
    return relative_intensity(lamp, front) < relative_intensity(lamp, -front);
  }

  const Scene& scene_;
  const std::vector<double>& distance_;
  double most_, rounding_;
  std::vector<std::vector<NearPlane>> planes_;
  BoxTree tree_;
  std::vector<int> found_{};
};

// Cimmino's method (1938): the mean of the steps to all planes that are too near, again and again.
Eigen::Vector3d step_away(std::span<const NearPlane> planes, double distance) {
  constexpr int passes = 16;  // each leaves 2/3 in a corner of three walls: 0.2 % in all
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  for (int pass = 0; pass < passes; ++pass) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int count = 0;
    for (const NearPlane& plane : planes) {
      const double lacking = distance - plane.height - plane.normal.dot(step);
      if (!(lacking > 0.0)) continue;
      sum += lacking * plane.normal;
      ++count;
    }
    if (count == 0) break;
    step += sum / count;
  }
  return step;
}

}  // namespace

std::vector<Eigen::Vector3d> clear_places(const Scene& scene, std::span<const double> clearance) {
  std::vector<Eigen::Vector3d> places;
  if (scene.lamps.empty()) return places;
  std::vector<double> distance;
  for (const double c : clearance) distance.push_back(2.0 * c);
  const NearSurfaces near(scene, distance);
  for (std::size_t i = 0; i < scene.lamps.size(); ++i) {
    places.push_back(scene.lamps[i].position + step_away(near.of(i), distance[i]));
  }
  return places;
}

}  // namespace lightwell
