#include "validation/cases/sky_scenes.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace lightwell {

Sky numbered_sky(int number, const Eigen::Vector3d& to_sun) {
  constexpr int overcast = 16;
  Sky sky{.up = Eigen::Vector3d::UnitZ(),
          .north = Eigen::Vector3d::UnitY(),
          .bright = to_sun.normalized(),
          .scale = constant_spectrum(rgb_bands(), 1.0f),
          .ground = constant_spectrum(rgb_bands(), 0.0f)};
  if (number == overcast) {
    sky.kind = SkyKind::overcast;
  } else {
    sky.gradation = standard_sky(number);
  }
  return sky;
}

Eigen::Vector3d Opening::normal() const {
  return u.cross(v).normalized();
}

ClearPane pane_of_transmittance(double T) {
  ClearPane pane;
  const double root = (pane.index - 1.0) / (pane.index + 1.0), r = root * root;
  // r^2 T t^2 + (1 - r)^2 t - T = 0
  const double b = (1.0 - r) * (1.0 - r), a = r * r * T;
  pane.transmissivity = (-b + std::sqrt(b * b + 4.0 * a * T)) / (2.0 * a);
  return pane;
}

double pane_transmittance(const ClearPane& pane, double cosine) {
  const double n = pane.index;
  const double inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (n * n));
  const double s = (cosine - n * inside) / (cosine + n * inside);
  const double p = (n * cosine - inside) / (n * cosine + inside);
  const double d = std::pow(pane.transmissivity, 1.0 / inside);
  const auto slab = [d](double r) { return (1.0 - r) * (1.0 - r) * d / (1.0 - r * r * d * d); };
  return 0.5 * (slab(s * s) + slab(p * p));
}

double light_through(const Opening& opening, const Sky& sky, const SurfacePoint& at,
                     const std::function<double(double cosine)>& transmittance) {
  // Three points of Gauss's rule in each of `pieces` along a side.
  constexpr int pieces = 32;
  const std::array<double, 3> place = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)};
  const std::array<double, 3> weight = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  const Eigen::Vector3d normal = opening.normal();
  double sum = 0.0;
  for (int i = 0; i < 3 * pieces; ++i) {
    for (int j = 0; j < 3 * pieces; ++j) {
      const auto a = static_cast<std::size_t>(i % 3), b = static_cast<std::size_t>(j % 3);
      const Eigen::Vector3d to = opening.origin + (i / 3 + place[a]) / pieces * opening.u +
                                 (j / 3 + place[b]) / pieces * opening.v - at.position;
      const double r2 = to.squaredNorm();
      const Eigen::Vector3d direction = to / std::sqrt(r2);
      const double here = direction.dot(at.normal), there = std::abs(direction.dot(normal));
      if (here <= 0.0) continue;
      sum += weight[a] * weight[b] * static_cast<double>(sky_radiance(sky, direction)[0]) *
             transmittance(there) * here * there / r2;
    }
  }
  return sum / (pieces * pieces) * opening.u.cross(opening.v).norm();
}

Material pane_material(const Bands& bands, const ClearPane& pane) {
  return {.name = "glass",
          .reflectance = constant_spectrum(bands, 0.0f),
          .specular = constant_spectrum(bands, 0.0f),
          .dielectric = Dielectric{.index_of_refraction = static_cast<float>(pane.index),
                                   .tint = constant_spectrum(bands, 1.0f),
                                   .thin = true,
                                   .transmissivity = constant_spectrum(
                                       bands, static_cast<float>(pane.transmissivity))},
          .emission = constant_spectrum(bands, 0.0f)};
}

}  // namespace lightwell
