#include "scene/conductor.h"

#include <cmath>
#include <complex>

namespace lightwell {
namespace {

double metal_reflectance(double cosine, std::complex<double> index) {
  if (!(std::abs(index) > 0.0)) return 1.0;
  const std::complex<double> inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
  const auto across = (cosine - index * inside) / (cosine + index * inside);
  const auto along = (index * cosine - inside) / (index * cosine + inside);
  return 0.5 * (std::norm(across) + std::norm(along));
}

}  // namespace

Spectrum reflectance_at(const Conductor& metal, double cosine) {
  Spectrum result(metal.eta.size());
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    const std::complex<double> index(double{metal.eta[i]}, double{metal.k[i]});
    result[i] = static_cast<float>(metal_reflectance(cosine, index));
  }
  return result;
}

Spectrum mean_reflectance(const Conductor& metal) {
  // Midpoint rule in cos^2: 2 cos dcos = d(cos^2), so the weights are equal.
  constexpr int steps = 1000;
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(metal.eta.size());
  for (int i = 0; i < steps; ++i) {
    sum += reflectance_at(metal, std::sqrt((i + 0.5) / steps)).cast<double>();
  }
  return (sum / steps).cast<float>();
}

}  // namespace lightwell
