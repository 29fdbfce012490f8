#include "radiosity/solvers/radiosity_system.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

template <class Weights>
LaneArray dot(const Weights& w, const LightVector& a, const LightVector& b) {
  LaneArray sum = LaneArray::Zero(a.cols());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    if constexpr (std::is_same_v<Weights, LightVector>) {
      sum += w.row(i) * a.row(i) * b.row(i);
    } else {
      sum += w[i] * a.row(i) * b.row(i);
    }
  }
  return sum;
}

}  // namespace

RadiositySystem::RadiositySystem(const PatchMesh& mesh, const FormFactors& form_factors,
                                 std::function<void()> pause, const BandArray& arriving)
    : RowGather(form_factors, static_cast<int>(mesh.emission.cols()), std::move(pause)),
      squared_index(form_factors.squared_index()),
      area(squared_index.size() > 0 ? squared_index * mesh.area : mesh.area),
      M(basic(mesh.emission)),
      rho(with_lanes(mesh.reflectance)),
      albedo(rho),
      behind_(mesh.behind) {
  if (!mesh.behind.empty()) {
    tau = with_lanes(mesh.transmittance);
    for (int i = 0; squared_index.size() > 0 && i < patch_count(); ++i) {
      if (behind(i) >= 0) tau.row(i) *= squared_index[behind(i)] / squared_index[i];
    }
    albedo += tau;
  }
  if (arriving.size() > 0) M += scattered(basic(arriving));
}

LightVector RadiositySystem::basic(const BandArray& values) const {
  LightVector result = with_lanes(values);
  if (squared_index.size() > 0) result.colwise() /= squared_index;
  return result;
}

BandArray RadiositySystem::without_index(LightVector values) const {
  if (squared_index.size() > 0) values.colwise() *= squared_index;
  return without_lanes(values);
}

LightVector RadiositySystem::scattered(const LightVector& E) const {
  LightVector B = rho * E;
  if (!is_translucent()) return B;
  for (int i = 0; i < patch_count(); ++i) {
    if (behind(i) >= 0) B.row(i) += tau.row(i) * E.row(behind(i));
  }
  return B;
}

LightVector RadiositySystem::residual(const LightVector& B) const {
  LightVector r;
  pass([&] { r = all(B); }, r);
  r = M + scattered(r) - B;
  return r;
}

LightVector RadiositySystem::product(const LightVector& x) const {
  LightVector y;
  pass([&] { y = all(x); }, y);
  y = x - scattered(y);
  return y;
}

double RadiositySystem::asymmetry() const {
  // For random x, y of mean 0 the mean of (y . S x - x . S y)^2 is ||S - S^T||^2 <x^2> <y^2>, and
  // that of |S x|^2 is ||S||^2 <x^2>.
  LightVector x(patch_count(), lanes()), y(patch_count(), lanes());
  const auto random = [](Eigen::Index i, std::uint64_t k) {
    return 2.0 * random_uniform(
                     random_key(static_cast<std::uint64_t>(i), RandomPurpose::asymmetry, k)) -
           1.0;
  };
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    x.row(i).setConstant(random(i, 0));
    y.row(i).setConstant(random(i, 1));
  }
  LightVector Sx = all(x), Sy = all(y);
  Sx.colwise() *= area;
  Sy.colwise() *= area;
  const LaneArray difference = (y * Sx - x * Sy).colwise().sum();
  const LaneArray size = Sx.square().colwise().sum();
  constexpr double mean_square = 1.0 / 3.0;
  double worst = 0.0;
  for (int k = 0; k < bands(); ++k) {
    if (size[k] > 0.0) {
      worst = std::max(worst, std::abs(difference[k]) / std::sqrt(size[k] * mean_square));
    }
  }
  return worst;
}

LaneArray weighted_dot(const Eigen::ArrayXd& w, const LightVector& a, const LightVector& b) {
  return dot(w, a, b);
}

LaneArray weighted_dot(const LightVector& w, const LightVector& a, const LightVector& b) {
  return dot(w, a, b);
}

}  // namespace lightwell
