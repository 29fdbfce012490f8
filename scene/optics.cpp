#include "scene/optics.h"

#include <algorithm>
#include <cmath>
#include <complex>

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

double diffuse_fresnel(double index) {
  // Midpoint rule in cos^2: 2 cos dcos = d(cos^2), so the weights are equal.
  constexpr int steps = 1000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) sum += fresnel_reflectance(std::sqrt((i + 0.5) / steps), index);
  return sum / steps;
}

double pane_reflectance(double cos_incident, double index) {
  const PolarisedReflectance R = polarised_reflectance(cos_incident, index);
  return R.s / (1.0 + R.s) + R.p / (1.0 + R.p);
}

InterfaceShares face_shares(double cos_incident, double relative_index) {
  const double n2 = relative_index * relative_index;
  const double cos2_transmitted = 1.0 - (1.0 - cos_incident * cos_incident) / n2;
  // Amplitudes r; beyond the critical angle the wave decays with the imaginary cosine.
  const std::complex<double> cos_transmitted = std::sqrt(std::complex<double>(cos2_transmitted));
  const std::complex<double> s = (cos_incident - relative_index * cos_transmitted) /
                                 (cos_incident + relative_index * cos_transmitted);
  const std::complex<double> p = (relative_index * cos_incident - cos_transmitted) /
                                 (relative_index * cos_incident + cos_transmitted);
  InterfaceShares shares{
      .reflected = {.s = 1.0, .p = 1.0, .u = std::clamp((s * std::conj(p)).real(), -1.0, 1.0)}};
  if (!(cos2_transmitted > 0.0)) return shares;
  shares.reflected.s = std::norm(s);
  shares.reflected.p = std::norm(p);
  shares.passed = {.s = 1.0 - shares.reflected.s, .p = 1.0 - shares.reflected.p};
  shares.passed.u = std::sqrt(shares.passed.s * shares.passed.p);
  return shares;
}

InterfaceShares pane_interface(double cos_incident, double index, double transmissivity) {
  const double sin2_refracted = (1.0 - cos_incident * cos_incident) / (index * index);
  const PolarisedShares face = face_shares(cos_incident, index).reflected;
  if (sin2_refracted >= 1.0) return {.reflected = face};
  const double d = std::pow(transmissivity, 1.0 / std::sqrt(1.0 - sin2_refracted));
  // Sums over an even number of inner reflections; a and b are reflectances of one face for the two
  // amplitudes whose product is summed.
  const auto passed = [&](double a, double b) {
    return a < 1.0 && b < 1.0 ? (1.0 - a) * (1.0 - b) * d / (1.0 - a * b * d * d) : 0.0;
  };
  InterfaceShares pane;
  pane.passed = {passed(face.s, face.s), passed(face.p, face.p), passed(face.s, face.p)};
  pane.reflected = {.s = face.s * (1.0 + d * pane.passed.s),
                    .p = face.p * (1.0 + d * pane.passed.p),
                    .u = face.u * (1.0 + d * pane.passed.u)};
  return pane;
}

PaneShares pane_shares(double cos_incident, double index, double transmissivity) {
  const auto [reflected, passed] = pane_interface(cos_incident, index, transmissivity);
  return {.reflected = 0.5 * (reflected.s + reflected.p), .passed = 0.5 * (passed.s + passed.p)};
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
