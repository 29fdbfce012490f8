#include "scene/rays/cast_round_shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "scene/rays/float_rounding.h"

namespace lightwell {

namespace {

// Smallest root of |o + t d - c| = r. For a ray that starts on the sphere, the root of smaller
// magnitude is the ray's own origin.
double root_of(const Sphere& sphere, const Ray& ray, bool starts_here) {
  const Eigen::Vector3d oc = ray.origin - sphere.center;
  const double a = ray.direction.squaredNorm();
  const double half_b = oc.dot(ray.direction);
  // The perpendicular distance form keeps digits when the origin is far away (Haines et al. 2019,
  // "Precision improvements for ray/sphere intersection").
  const Eigen::Vector3d perpendicular = oc - (half_b / a) * ray.direction;
  const double discriminant = a * (sphere.radius * sphere.radius - perpendicular.squaredNorm());
  if (!(discriminant > 0.0)) return -1.0;
  const double root = std::sqrt(discriminant);
  const double low = (-half_b - root) / a, high = (-half_b + root) / a;
  if (starts_here) return std::abs(low) > std::abs(high) ? low : high;
  return low > 0.0 ? low : high;
}

// A disc or ring, which no ray meets that starts on it.
double root_of_ring(const Frustum& ring, const Ray& ray, bool starts_here) {
  if (starts_here) return -1.0;
  const Eigen::Vector3d from_base = ray.origin - ring.base;
  const double t = -from_base.dot(ring.axis) / ray.direction.dot(ring.axis);
  if (!(t > 0.0)) return -1.0;
  const Eigen::Vector3d at = from_base + t * ray.direction;
  const double across2 = at.squaredNorm();
  const auto [inner, outer] = std::minmax(ring.base_radius, ring.top_radius);
  return across2 >= inner * inner && across2 <= outer * outer ? t : -1.0;
}

// The roots of A t^2 + 2 B t + C = 0 for the double cone that a frustum is part of. The ray's
// origin is moved to the point nearest to the frustum's middle, so that no digits are lost where
// the origin is far away.
double root_of(const Frustum& frustum, const Ray& ray, bool starts_here) {
  if (is_flat(frustum)) return root_of_ring(frustum, ray, starts_here);
  const double length2 = ray.direction.squaredNorm();
  const Eigen::Vector3d middle = frustum.base + 0.5 * frustum.height * frustum.axis;
  const double near = (middle - ray.origin).dot(ray.direction) / length2;
  const Eigen::Vector3d o = (ray.origin - frustum.base) + near * ray.direction;
  const double oz = o.dot(frustum.axis), dz = ray.direction.dot(frustum.axis);
  const Eigen::Vector3d across = o - oz * frustum.axis, d = ray.direction - dz * frustum.axis;
  const double slope = (frustum.top_radius - frustum.base_radius) / frustum.height;
  const double radius = frustum.base_radius + slope * oz;
  const double A = d.squaredNorm() - slope * slope * dz * dz;
  const double B = across.dot(d) - slope * radius * dz;
  const double C = across.squaredNorm() - radius * radius;
  const double discriminant = B * B - A * C;
  if (!(discriminant > 0.0)) return -1.0;
  const double q = -(B + std::copysign(std::sqrt(discriminant), B));
  double low = near + q / A, high = near + C / q;  // infinite where the ray runs along a generator
  if (low > high) std::swap(low, high);
  const auto is_on = [&](double t) {
    const double z = oz + (t - near) * dz;
    return t > 0.0 && z >= 0.0 && z <= frustum.height;
  };
  if (starts_here) {
    const double other = std::abs(low) > std::abs(high) ? low : high;
    return is_on(other) ? other : -1.0;
  }
  return is_on(low) ? low : is_on(high) ? high : -1.0;
}

}  // namespace

double round_root(const RoundShape& shape, const Ray& ray, bool starts_here) {
  return std::visit([&](const auto& s) { return root_of(s, ray, starts_here); }, shape);
}

namespace {

void round_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& set = *static_cast<const RoundShapeSet*>(args->geometryUserPtr);
  const Eigen::AlignedBox3d box = bounds(set.shapes[args->primID]);
  const Eigen::Vector3d reach =
      Eigen::Vector3d::Constant(std::max(set.rounding, ray_rounding(box, set.center)));
  const Eigen::Vector3f lower = (box.min() - set.center - reach).cast<float>();
  const Eigen::Vector3f upper = (box.max() - set.center + reach).cast<float>();
  args->bounds_o->lower_x = lower.x();
  args->bounds_o->lower_y = lower.y();
  args->bounds_o->lower_z = lower.z();
  args->bounds_o->upper_x = upper.x();
  args->bounds_o->upper_y = upper.y();
  args->bounds_o->upper_z = upper.z();
}

void round_intersect(const RTCIntersectFunctionNArguments* args) {
  const auto& set = *static_cast<const RoundShapeSet*>(args->geometryUserPtr);
  const Ray* rays = static_cast<const QueryContext*>(args->context)->rays;
  RTCRayN* query = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* hit = RTCRayHitN_HitN(args->rayhit, args->N);
  for (unsigned lane = 0; lane < args->N; ++lane) {
    if (!args->valid[lane]) continue;
    const Ray& ray = rays[RTCRayN_id(query, args->N, lane)];
    const double t =
        round_root(set.shapes[args->primID], ray, set.group[args->primID] == ray.origin_group);
    if (!(t > RTCRayN_tnear(query, args->N, lane) && t < RTCRayN_tfar(query, args->N, lane))) {
      continue;
    }
    RTCRayN_tfar(query, args->N, lane) = static_cast<float>(t);
    RTCHitN_geomID(hit, args->N, lane) = args->geomID;
    RTCHitN_primID(hit, args->N, lane) = args->primID;
    RTCHitN_u(hit, args->N, lane) = RTCHitN_v(hit, args->N, lane) = 0.0f;
  }
}

void round_occluded(const RTCOccludedFunctionNArguments* args) {
  const auto& set = *static_cast<const RoundShapeSet*>(args->geometryUserPtr);
  const Ray* rays = static_cast<const QueryContext*>(args->context)->rays;
  const int group = set.group[args->primID];
  for (unsigned lane = 0; lane < args->N; ++lane) {
    if (!args->valid[lane]) continue;
    const Ray& ray = rays[RTCRayN_id(args->ray, args->N, lane)];
    if (group == ray.target_group) continue;
    const double t = round_root(set.shapes[args->primID], ray, group == ray.origin_group);
    if (t > RTCRayN_tnear(args->ray, args->N, lane) && t < RTCRayN_tfar(args->ray, args->N, lane)) {
      RTCRayN_tfar(args->ray, args->N, lane) = -std::numeric_limits<float>::infinity();
    }
  }
}

}  // namespace

RTCGeometry round_geometry(RTCDevice device, RoundShapeSet& set) {
  const RTCGeometry user = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(user, static_cast<unsigned>(set.shapes.size()));
  rtcSetGeometryUserData(user, &set);
  rtcSetGeometryBoundsFunction(user, round_bounds, nullptr);
  rtcSetGeometryIntersectFunction(user, round_intersect);
  rtcSetGeometryOccludedFunction(user, round_occluded);
  return user;
}

}  // namespace lightwell
