#include "radiosity/emitters/emitter_shadows.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "radiosity/emitters/emitter_point.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// A shadow ray to a sample point of a polygon; its weight is the sample's kernel cos cos / r^2.
ShadowSample polygon_sample(const Emitter& emitter, const Eigen::Vector3d& point,
                            const Eigen::Vector3d& normal, double u, double v) {
  const Eigen::Vector3d to = emitter_point(emitter, u, v) - point;
  const double r2 = to.squaredNorm();
  const double cos_cos = to.dot(normal) * std::abs(to.dot(emitter.normal));
  return {.ray = {.origin = point, .direction = to, .t_max = 1.0},
          .weight = cos_cos > 0.0 ? cos_cos / (r2 * r2) : 0.0};
}

// Samples are uniform over the cone of directions that the sphere fills, seen from outside.
ShadowSample sphere_sample(const Emitter& emitter, const Eigen::Vector3d& point,
                           const Eigen::Vector3d& normal, double u, double v) {
  const Eigen::Vector3d to_center = emitter.sphere.center - point;
  const double distance = to_center.norm();
  const double sin_alpha = emitter.sphere.radius / distance;
  const double cos_alpha = std::sqrt(std::max(0.0, 1.0 - sin_alpha * sin_alpha));
  const double cos_beta = 1.0 - u * (1.0 - cos_alpha);
  const double sin_beta = std::sqrt(std::max(0.0, 1.0 - cos_beta * cos_beta));
  const double phi = 2.0 * std::numbers::pi * v;
  const Eigen::Vector3d axis = to_center / distance;
  Eigen::Vector3d a, b;
  tangent_frame(axis, a, b);
  const Eigen::Vector3d direction =
      sin_beta * (std::cos(phi) * a + std::sin(phi) * b) + cos_beta * axis;
  const double reach =
      distance * cos_beta - std::sqrt(std::max(0.0, emitter.sphere.radius * emitter.sphere.radius -
                                                        distance * distance * sin_beta * sin_beta));
  return {.ray = {.origin = point, .direction = direction, .t_max = reach},
          .weight = std::max(0.0, direction.dot(normal))};
}

// Samples of a polygon close by are uniform in solid angle, so the kernel is the cosine.
ShadowSample solid_angle_sample(const SolidAngleSampler& sampler, const Eigen::Vector3d& point,
                                const Eigen::Vector3d& normal, double u, double v) {
  const Eigen::Vector3d to = sampler.to_point(u, v);
  return {.ray = {.origin = point, .direction = to, .t_max = 1.0},
          .weight = std::max(0.0, to.normalized().dot(normal))};
}

// Samples of a picture from afar are as dense as the light of its parts.
ShadowSample picture_sample(const Emitter& emitter, const EmissionTree::View& view,
                            const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double u,
                            double v) {
  const EmissionTree::Sample at = emitter.picture->sample(view, u, v);
  const Eigen::Vector3d to = at.point - point;
  const double r2 = to.squaredNorm();
  const double cos_cos = to.dot(normal) * std::abs(to.dot(emitter.normal));
  return {.ray = {.origin = point, .direction = to, .t_max = 1.0},
          .weight = cos_cos > 0.0 ? at.area_per_share * cos_cos / (r2 * r2) : 0.0,
          .exitance = at.exitance};
}

}  // namespace

ShadowSample emitter_shadow_sample(const Emitter& emitter, const SolidAngleSampler& sampler,
                                   const SurfacePoint& at, double u, double v,
                                   const EmissionTree::View* view) {
  const auto& [point, normal, facet] = at;
  const bool by_picture = view && sampler.empty();
  ShadowSample sample = emitter.is_sphere ? sphere_sample(emitter, point, normal, u, v)
                        : by_picture      ? picture_sample(emitter, *view, point, normal, u, v)
                        : sampler.empty() ? polygon_sample(emitter, point, normal, u, v)
                                          : solid_angle_sample(sampler, point, normal, u, v);
  if (view && !by_picture) {
    sample.exitance = &emitter.picture->taken_at(point + sample.ray.direction);
  }
  sample.ray.origin_group = facet;
  sample.ray.target_group = emitter.facet;
  return sample;
}

double expected_emitter_weight(const Emitter& emitter, const SolidAngleSampler& sampler,
                               const Eigen::Vector3d& point, double F) {
  double range = emitter.area;
  if (emitter.is_sphere) {
    const double sin_alpha = emitter.sphere.radius / (emitter.sphere.center - point).norm();
    const double sine2 = std::min(1.0, sin_alpha * sin_alpha);
    range = 2.0 * std::numbers::pi * sine2 / (1.0 + std::sqrt(1.0 - sine2));
  } else if (!sampler.empty()) {
    range = sampler.solid_angle();
  }
  return std::numbers::pi * F / range;
}

}  // namespace lightwell
