#include "raytrace/shading/visible_lamps.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <span>
#include <variant>

#include "radiosity/emitters/free_source.h"
#include "raytrace/shading/shown_radiance.h"
#include "scene/lamp_faces.h"

namespace lightwell {
namespace {

double area_of(const LampOpening& opening) {
  return luminous_area(opening, 0.0, Eigen::Vector3d::UnitZ());
}

Eigen::Vector3d normal_of(const std::vector<Eigen::Vector3d>& outline) {
  return (outline[1] - outline[0]).cross(outline[2] - outline[0]).normalized();
}

/// A caster of convex faces, each a group of its own: a quad, or a fan of triangles. Null for none.
std::unique_ptr<const RayCaster> caster_of(std::span<const std::vector<Eigen::Vector3d>> outlines) {
  if (outlines.empty()) return nullptr;
  CastGeometry geometry;
  std::vector<int> groups_of_quads;
  for (std::size_t f = 0; f < outlines.size(); ++f) {
    const auto first = static_cast<int>(geometry.vertices.size());
    const auto corners = static_cast<int>(outlines[f].size());
    geometry.vertices.insert(geometry.vertices.end(), outlines[f].begin(), outlines[f].end());
    if (corners == 4) {
      geometry.quads.push_back({first, first + 1, first + 2, first + 3});
      groups_of_quads.push_back(static_cast<int>(f));
      continue;
    }
    for (int i = 1; i + 1 < corners; ++i) {
      geometry.triangles.push_back({first, first + i, first + i + 1});
      geometry.group.push_back(static_cast<int>(f));
    }
  }
  // Triangles are numbered before quads.
  geometry.group.insert(geometry.group.end(), groups_of_quads.begin(), groups_of_quads.end());
  return std::make_unique<const RayCaster>(geometry);
}

}  // namespace

VisibleLamps::VisibleLamps(const Scene& scene, const ElementCaster& caster,
                           const DirectLight& direct_light, const RadiositySolution& solution)
    : scene_(&scene), intensity_(scene.lamps.size(), Spectrum::Zero(scene.bands.count())) {
  for (const FreeSource& source : direct_light.free_sources()) {
    if (!std::holds_alternative<LampLight>(source.shape)) continue;
    intensity_[static_cast<std::size_t>(source.number)] = source.light;
  }
  const DrawnLamps drawn(scene, caster);
  const auto is_body = [](const DrawnLamps::Face& face) { return !face.shines; };
  BandArray L;
  if (std::ranges::any_of(drawn.faces(), is_body)) {
    L = drawn.radiance(caster.mesh(), shown_radiance(caster.mesh(), solution, scene.materials), {});
  }
  std::vector<std::vector<Eigen::Vector3d>> openings, bodies;
  double place = 0.0;  // of the last opening
  for (std::size_t f = 0; f < drawn.faces().size(); ++f) {
    const DrawnLamps::Face& face = drawn.faces()[f];
    if (is_body(face)) {
      body_.push_back({.lamp = face.lamp,
                       .normal = normal_of(face.outline),
                       .radiance = L.row(static_cast<Eigen::Index>(f)).transpose()});
      bodies.push_back(face.outline);
      continue;
    }
    // One face is seen from either side.
    if (!opening_.empty() && opening_.back().lamp == face.lamp && place == face.place) continue;
    place = face.place;
    openings.push_back(opening_outline(scene.lamps[static_cast<std::size_t>(face.lamp)], place));
    opening_.push_back({.lamp = face.lamp, .normal = normal_of(openings.back())});
  }
  openings_ = caster_of(openings);
  bodies_ = caster_of(bodies);
}

VisibleLamps::Seen VisibleLamps::seen(const Face& face, std::size_t number, const Ray& ray,
                                      double t) {
  Seen result{.lamp = face.lamp,
              .face = static_cast<int>(number),
              .t = t,
              .normal = face.normal,
              .radiance = face.radiance};
  if (face.normal.dot(ray.direction) > 0.0) result.normal = -face.normal;
  return result;
}

std::optional<VisibleLamps::Seen> VisibleLamps::first(const Ray& ray, double end) const {
  const std::optional<Seen> body = first_body(ray, end);
  double way = end / way_before_opening;
  // An opening lies in the plane of its body's end.
  constexpr double rounding = 0.002;  // m, less than any body is thick
  if (body) way = std::min(body->t / way_before_opening, body->t + rounding);
  std::optional<Seen> opening = first_opening(ray, way);
  return opening ? opening : body;
}

std::optional<VisibleLamps::Seen> VisibleLamps::first_body(const Ray& ray, double end) const {
  if (!bodies_) return {};
  const Ray before{.origin = ray.origin, .direction = ray.direction, .t_max = end};
  Hit hit;
  bodies_->closest_hits({&before, 1}, {&hit, 1});
  if (hit.group < 0) return {};
  const auto number = static_cast<std::size_t>(hit.group);
  Seen result = seen(body_[number], opening_.size() + number, ray, hit.t);
  result.is_body = true;
  return result;
}

std::optional<VisibleLamps::Seen> VisibleLamps::first_opening(const Ray& ray, double end) const {
  if (!openings_) return {};
  Ray rest{.origin = ray.origin, .direction = ray.direction, .t_max = end};
  // A ray passes an opening that sends no light its way; few openings stand one behind another.
  constexpr int most_passed = 8;
  for (int passed = 0; passed < most_passed; ++passed) {
    Hit hit;
    openings_->closest_hits({&rest, 1}, {&hit, 1});
    if (hit.group < 0) return {};
    const auto number = static_cast<std::size_t>(hit.group);
    const Lamp& lamp = scene_->lamps[static_cast<std::size_t>(opening_[number].lamp)];
    const double share = relative_intensity(lamp, -ray.direction);
    const double t = (rest.origin - ray.origin).dot(ray.direction) + hit.t;
    if (share > 0.0) {
      const Eigen::Vector3d way = lamp.axes.transpose() * -ray.direction;
      const double area =
          std::max(luminous_area(lamp.opening, 0.0, way), rim_of_opening * area_of(lamp.opening));
      const auto per_area = static_cast<float>(share / area);
      Seen result = seen(opening_[number], number, ray, t);
      result.radiance = intensity_[static_cast<std::size_t>(result.lamp)] * per_area;
      return result;
    }
    rest.origin += hit.t * rest.direction;
    rest.origin_group = hit.group;
    rest.t_max = end - (rest.origin - ray.origin).dot(ray.direction);
  }
  return {};
}

}  // namespace lightwell
