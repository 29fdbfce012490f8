#include "scene/optics.h"

#include <algorithm>
#include <cmath>

namespace lightwell {

PolarisedReflectance polarised_reflectance(double cos_incident, double relative_index) {
  const double sin2_transmitted =
      (1.0 - cos_incident * cos_incident) / (relative_index * relative_index);
  if (sin2_transmitted >= 1.0) return {1.0, 1.0};
  const double cos_transmitted = std::sqrt(1.0 - sin2_transmitted);
  const double s = (cos_incident - relative_index * cos_transmitted) /
                   (cos_incident + relative_index * cos_transmitted);
  const double p = (relative_index * cos_incident - cos_transmitted) /
                   (relative_index * cos_incident + cos_transmitted);
  return {s * s, p * p};
}

double fresnel_reflectance(double cos_incident, double relative_index) {
  const PolarisedReflectance R = polarised_reflectance(cos_incident, relative_index);
  return 0.5 * (R.s + R.p);
}

double pane_reflectance(double cos_incident, double index) {
  const PolarisedReflectance R = polarised_reflectance(cos_incident, index);
  return R.s / (1.0 + R.s) + R.p / (1.0 + R.p);
}

PaneShares pane_shares(double cos_incident, double index, double transmissivity) {
  const double sin2_refracted = (1.0 - cos_incident * cos_incident) / (index * index);
  if (sin2_refracted >= 1.0) return {.reflected = 1.0};
  const double d = std::pow(transmissivity, 1.0 / std::sqrt(1.0 - sin2_refracted));
  const PolarisedReflectance face = polarised_reflectance(cos_incident, index);
  PaneShares mean;
  for (const double r : {face.s, face.p}) {
    const double T = r < 1.0 ? (1.0 - r) * (1.0 - r) * d / (1.0 - r * r * d * d) : 0.0;
    mean.passed += 0.5 * T;
    mean.reflected += 0.5 * r * (1.0 + d * T);
  }
  return mean;
}

Eigen::Vector3d reflect(const Eigen::Vector3d& direction, const Eigen::Vector3d& normal) {
  return direction - 2.0 * direction.dot(normal) * normal;
}

Eigen::Vector3d visible_normal(const Eigen::Vector3d& direction, const Eigen::Vector3d& flat,
                               const Eigen::Vector3d& smooth) {
  const Eigen::Vector3d mirrored = reflect(direction, smooth);
  const double height = mirrored.dot(flat);
  // Light that grazes the surface is mirrored to less than its own height.
  const double least = std::min(0.01, -0.9 * direction.dot(flat));
  if (height >= least) return smooth;
  const Eigen::Vector3d raised = (mirrored + (least - height) * flat).normalized();
  return (raised - direction).normalized();
}

std::optional<Eigen::Vector3d> refract(const Eigen::Vector3d& direction,
                                       const Eigen::Vector3d& normal, double relative_index) {
  const double cos_incident = -direction.dot(normal);
  const double sin2_transmitted =
      (1.0 - cos_incident * cos_incident) / (relative_index * relative_index);
  if (sin2_transmitted >= 1.0) return std::nullopt;
  const double cos_transmitted = std::sqrt(1.0 - sin2_transmitted);
  return (direction + cos_incident * normal) / relative_index - cos_transmitted * normal;
}

}  // namespace lightwell
