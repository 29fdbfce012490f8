#include "scene/round_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/sampling.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

/// A point in the half plane through a frustum's axis: the distance from the axis, the height over
/// the base, and the unit direction away from the axis (any, on the axis itself: zero).
struct ProfilePoint {
  double across = 0.0, height = 0.0;
  Vector3d outward = Vector3d::Zero();
};

ProfilePoint profile_point(const Frustum& frustum, const Vector3d& point) {
  const Vector3d from_base = point - frustum.base;
  const double height = from_base.dot(frustum.axis);
  const Vector3d outward = from_base - height * frustum.axis;
  const double across = outward.norm();
  return {across, height, across > 0.0 ? Vector3d(outward / across) : Vector3d::Zero()};
}

double reach_of(const Sphere& sphere, const Vector3d& along) {
  return sphere.center.dot(along) + sphere.radius;
}

// A circle of radius r about the axis a reaches r sqrt(1 - (a . n)^2) along n.
double reach_of(const Frustum& frustum, const Vector3d& along) {
  const double cosine = frustum.axis.dot(along);
  const double share = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  return frustum.base.dot(along) + std::max(frustum.base_radius * share,
                                            frustum.height * cosine + frustum.top_radius * share);
}

Vector3d nearest_of(const Sphere& sphere, const Vector3d& point) {
  const Vector3d from_center = point - sphere.center;
  if (from_center.isZero()) return sphere.center + sphere.radius * Vector3d::UnitZ();
  const Vector3d direction = from_center.normalized();
  return sphere.center + sphere.radius * direction;
}

Vector3d nearest_of(const Frustum& frustum, const Vector3d& point) {
  ProfilePoint at = profile_point(frustum, point);
  if (at.outward.isZero()) at.outward = longitudes(frustum).zero;
  const double place = std::clamp(place_along(frustum, point), 0.0, 1.0);
  return frustum.base + place * frustum.height * frustum.axis +
         radius_at(frustum, place) * at.outward;
}

Vector3d normal_of(const Sphere& sphere, const Vector3d& point) {
  return (point - sphere.center).normalized();
}

Vector3d normal_of(const Frustum& frustum, const Vector3d& point) {
  const ProfilePoint at = profile_point(frustum, point);
  const double fall = frustum.base_radius - frustum.top_radius;
  const Vector3d normal = (frustum.height * at.outward + fall * frustum.axis).normalized();
  return frustum.inward ? Vector3d(-normal) : normal;
}

}  // namespace

std::optional<RoundShape> round_shape(const Surface& surface) {
  if (const auto* sphere = std::get_if<Sphere>(&surface.shape)) return *sphere;
  if (const auto* frustum = std::get_if<Frustum>(&surface.shape)) return *frustum;
  return std::nullopt;
}

void set_shape(Surface& surface, const RoundShape& shape) {
  std::visit([&](const auto& s) { surface.shape = s; }, shape);
}

double area(const RoundShape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    return 4.0 * pi * sphere->radius * sphere->radius;
  }
  const auto& frustum = std::get<Frustum>(shape);
  return pi * (frustum.base_radius + frustum.top_radius) * slant_height(frustum);
}

Eigen::AlignedBox3d bounds(const RoundShape& shape) {
  Eigen::AlignedBox3d box;
  for (int i = 0; i < 3; ++i) {
    box.min()[i] = -reach(shape, -Vector3d::Unit(i));
    box.max()[i] = reach(shape, Vector3d::Unit(i));
  }
  return box;
}

double reach(const RoundShape& shape, const Vector3d& along) {
  return std::visit([&](const auto& s) { return reach_of(s, along); }, shape);
}

Sphere ball_around(const RoundShape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return *sphere;
  const auto& frustum = std::get<Frustum>(shape);
  const double half = 0.5 * frustum.height;
  return {.center = frustum.base + half * frustum.axis,
          .radius = std::hypot(half, std::max(frustum.base_radius, frustum.top_radius))};
}

Vector3d nearest_on(const RoundShape& shape, const Vector3d& point) {
  return std::visit([&](const auto& s) { return nearest_of(s, point); }, shape);
}

Vector3d front_normal(const RoundShape& shape, const Vector3d& point) {
  return std::visit([&](const auto& s) { return normal_of(s, point); }, shape);
}

RoundShape moved(const RoundShape& shape, const Eigen::Isometry3d& pose) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    return Sphere{.center = pose * sphere->center, .radius = sphere->radius};
  }
  Frustum frustum = std::get<Frustum>(shape);
  frustum.base = pose * frustum.base;
  frustum.axis = (pose.linear() * frustum.axis).normalized();
  return frustum;
}

double radius_at(const Frustum& frustum, double along) {
  return frustum.base_radius + along * (frustum.top_radius - frustum.base_radius);
}

double place_along(const Frustum& frustum, const Vector3d& point) {
  const ProfilePoint at = profile_point(frustum, point);
  const double rise = frustum.top_radius - frustum.base_radius, slant = slant_height(frustum);
  return ((at.across - frustum.base_radius) * rise + at.height * frustum.height) / (slant * slant);
}

double slant_height(const Frustum& frustum) {
  return std::hypot(frustum.height, frustum.base_radius - frustum.top_radius);
}

bool is_flat(const Frustum& frustum) {
  return frustum.height == 0.0;
}

LongitudeFrame longitudes(const Frustum& frustum) {
  LongitudeFrame frame;
  tangent_frame(frustum.axis, frame.zero, frame.quarter);
  // The frame of a normal n is right-handed: zero x quarter = n.
  if (frustum.inward) frame.quarter = -frame.quarter;
  return frame;
}

bool sees_itself(const RoundShape& shape, bool is_back) {
  const auto* frustum = std::get_if<Frustum>(&shape);
  if (!frustum) return is_back;
  return !is_flat(*frustum) && is_back != frustum->inward;
}

RoundShapes::RoundShapes(const Scene& scene) {
  const std::vector<FacetRef> facets = scene_facets(scene);
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const Surface& surface = scene.surfaces[static_cast<std::size_t>(facets[f].surface)];
    if (const auto shape = round_shape(surface)) {
      shapes_.emplace_back(static_cast<int>(f), *shape);
    }
  }
}

const RoundShape* RoundShapes::of(int facet) const {
  const auto found = std::lower_bound(shapes_.begin(), shapes_.end(), facet,
                                      [](const auto& entry, int f) { return entry.first < f; });
  return found != shapes_.end() && found->first == facet ? &found->second : nullptr;
}

}  // namespace lightwell
