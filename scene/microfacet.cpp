#include "scene/microfacet.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace lightwell {

double ggx_lambda(double cosine, double alpha) {
  const double cos2 = cosine * cosine;
  const double tan2 = std::max(0.0, 1.0 - cos2) / cos2;
  return 0.5 * (std::sqrt(1.0 + alpha * alpha * tan2) - 1.0);
}

double ggx_normals(double cosine, double alpha) {
  const double a2 = alpha * alpha, b = cosine * cosine * (a2 - 1.0) + 1.0;
  return a2 / (std::numbers::pi * b * b);
}

Eigen::Vector3d ggx_visible_normal(const Eigen::Vector3d& outwards, double alpha, double u,
                                   double v) {
  // Stretching by alpha turns the microfacets into a hemisphere. The visible part of the hemisphere
  // projects to a disk whose far half is foreshortened.
  const Eigen::Vector3d w =
      Eigen::Vector3d(alpha * outwards.x(), alpha * outwards.y(), outwards.z()).normalized();
  const double across = std::hypot(w.x(), w.y());
  const Eigen::Vector3d first = across > 0.0 ? Eigen::Vector3d(-w.y() / across, w.x() / across, 0.0)
                                             : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d second = w.cross(first);
  const double r = std::sqrt(u), phi = 2.0 * std::numbers::pi * v;
  const double a = r * std::cos(phi);
  const double fraction = 0.5 * (1.0 + w.z());
  const double b =
      (1.0 - fraction) * std::sqrt(std::max(0.0, 1.0 - a * a)) + fraction * r * std::sin(phi);
  const Eigen::Vector3d m =
      a * first + b * second + std::sqrt(std::max(0.0, 1.0 - a * a - b * b)) * w;
  return Eigen::Vector3d(alpha * m.x(), alpha * m.y(), std::max(1e-12, m.z())).normalized();
}

}  // namespace lightwell
