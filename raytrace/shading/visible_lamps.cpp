#include "raytrace/shading/visible_lamps.h"

#include <algorithm>
#include <variant>

#include "scene/lamp_faces.h"

namespace lightwell {
namespace {

double area_of(const LampOpening& opening) {
  return luminous_area(opening, 0.0, Eigen::Vector3d::UnitZ());
}

// Adds the opening of a lamp as one group: a quad, or a fan of triangles for an ellipse.
void add_opening(const Lamp& lamp, int group, CastGeometry& geometry) {
  const std::vector<Eigen::Vector3d> outline = opening_outline(lamp);
  const auto first = static_cast<int>(geometry.vertices.size());
  geometry.vertices.insert(geometry.vertices.end(), outline.begin(), outline.end());
  if (!lamp.opening.is_round) {
    geometry.quads.push_back({first, first + 1, first + 2, first + 3});
    return;
  }
  for (int i = 1; i + 1 < static_cast<int>(outline.size()); ++i) {
    geometry.triangles.push_back({first, first + i, first + i + 1});
    geometry.group.push_back(group);
  }
}

}  // namespace

VisibleLamps::VisibleLamps(const Scene& scene, const DirectLight& direct_light)
    : scene_(scene), intensity_(scene.lamps.size()) {
  for (const FreeSource& source : direct_light.free_sources()) {
    if (!std::holds_alternative<LampLight>(source.shape)) continue;
    intensity_[static_cast<std::size_t>(source.number)] = source.light;
  }
  CastGeometry geometry;
  std::vector<int> groups_of_quads;
  // Triangles are numbered before quads.
  for (const bool is_round : {true, false}) {
    for (std::size_t i = 0; i < scene.lamps.size(); ++i) {
      const Lamp& lamp = scene.lamps[i];
      if (!lamp.visible || lamp.opening.is_round != is_round || !(area_of(lamp.opening) > 0.0)) {
        continue;
      }
      const auto group = static_cast<int>(lamp_.size());
      lamp_.push_back(static_cast<int>(i));
      add_opening(lamp, group, geometry);
      if (!is_round) groups_of_quads.push_back(group);
    }
  }
  if (lamp_.empty()) return;
  geometry.group.insert(geometry.group.end(), groups_of_quads.begin(), groups_of_quads.end());
  caster_ = std::make_unique<const RayCaster>(geometry);
}

std::optional<VisibleLamps::Seen> VisibleLamps::first(const Ray& ray, double end) const {
  if (!caster_) return {};
  end /= way_before_opening;
  Ray rest{.origin = ray.origin, .direction = ray.direction, .t_max = end};
  // A ray passes an opening that sends no light its way; few openings stand one behind another.
  constexpr int most_passed = 8;
  for (int passed = 0; passed < most_passed; ++passed) {
    Hit hit;
    caster_->closest_hits({&rest, 1}, {&hit, 1});
    if (hit.group < 0) return {};
    const int number = lamp_[static_cast<std::size_t>(hit.group)];
    const Lamp& lamp = scene_.lamps[static_cast<std::size_t>(number)];
    const double share = relative_intensity(lamp, -ray.direction);
    if (share > 0.0) {
      const Eigen::Vector3d way = lamp.axes.transpose() * -ray.direction;
      const double area =
          std::max(luminous_area(lamp.opening, 0.0, way), rim_of_opening * area_of(lamp.opening));
      const auto per_area = static_cast<float>(share / area);
      return Seen{number, intensity_[static_cast<std::size_t>(number)] * per_area};
    }
    rest.origin += hit.t * rest.direction;
    rest.origin_group = hit.group;
    rest.t_max = end - (rest.origin - ray.origin).dot(ray.direction);
  }
  return {};
}

}  // namespace lightwell
