#include "scene/rays/cast_spheres.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace lightwell {

double sphere_root(const Sphere& sphere, const Ray& ray, bool starts_here) {
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

namespace {

void sphere_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& set = *static_cast<const SphereSet*>(args->geometryUserPtr);
  const Sphere& s = set.spheres[args->primID];
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(s.radius + set.rounding);
  const Eigen::Vector3f lower = (s.center - set.center - reach).cast<float>();
  const Eigen::Vector3f upper = (s.center - set.center + reach).cast<float>();
  args->bounds_o->lower_x = lower.x();
  args->bounds_o->lower_y = lower.y();
  args->bounds_o->lower_z = lower.z();
  args->bounds_o->upper_x = upper.x();
  args->bounds_o->upper_y = upper.y();
  args->bounds_o->upper_z = upper.z();
}

void sphere_intersect(const RTCIntersectFunctionNArguments* args) {
  const auto& set = *static_cast<const SphereSet*>(args->geometryUserPtr);
  const Ray* rays = static_cast<const QueryContext*>(args->context)->rays;
  RTCRayN* query = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* hit = RTCRayHitN_HitN(args->rayhit, args->N);
  for (unsigned lane = 0; lane < args->N; ++lane) {
    if (!args->valid[lane]) continue;
    const Ray& ray = rays[RTCRayN_id(query, args->N, lane)];
    const double t =
        sphere_root(set.spheres[args->primID], ray, set.group[args->primID] == ray.origin_group);
    if (!(t > RTCRayN_tnear(query, args->N, lane) && t < RTCRayN_tfar(query, args->N, lane))) {
      continue;
    }
    RTCRayN_tfar(query, args->N, lane) = static_cast<float>(t);
    RTCHitN_geomID(hit, args->N, lane) = args->geomID;
    RTCHitN_primID(hit, args->N, lane) = args->primID;
    RTCHitN_u(hit, args->N, lane) = RTCHitN_v(hit, args->N, lane) = 0.0f;
  }
}

void sphere_occluded(const RTCOccludedFunctionNArguments* args) {
  const auto& set = *static_cast<const SphereSet*>(args->geometryUserPtr);
  const Ray* rays = static_cast<const QueryContext*>(args->context)->rays;
  const int group = set.group[args->primID];
  for (unsigned lane = 0; lane < args->N; ++lane) {
    if (!args->valid[lane]) continue;
    const Ray& ray = rays[RTCRayN_id(args->ray, args->N, lane)];
    if (group == ray.target_group) continue;
    const double t = sphere_root(set.spheres[args->primID], ray, group == ray.origin_group);
    if (t > RTCRayN_tnear(args->ray, args->N, lane) && t < RTCRayN_tfar(args->ray, args->N, lane)) {
      RTCRayN_tfar(args->ray, args->N, lane) = -std::numeric_limits<float>::infinity();
    }
  }
}

}  // namespace

RTCGeometry sphere_geometry(RTCDevice device, SphereSet& set) {
  const RTCGeometry user = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(user, static_cast<unsigned>(set.spheres.size()));
  rtcSetGeometryUserData(user, &set);
  rtcSetGeometryBoundsFunction(user, sphere_bounds, nullptr);
  rtcSetGeometryIntersectFunction(user, sphere_intersect);
  rtcSetGeometryOccludedFunction(user, sphere_occluded);
  return user;
}

}  // namespace lightwell
