#include "raytrace/pixel_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lightwell {
namespace {

constexpr std::uint64_t place_purpose = 0x9face, look_purpose = 0x9faced;
constexpr double filter_radius = 1.5;  // pixels

// x in [-1, 1] over the window's width; 1 in the middle.
double blackman_harris(double x) {
  const double a = std::numbers::pi * (x + 1.0);
  return 0.35875 - 0.48829 * std::cos(a) + 0.14128 * std::cos(2.0 * a) -
         0.01168 * std::cos(3.0 * a);
}

// Means of band-mean radiance, for the error of a pixel's mean.
struct Tally {
  double sum = 0.0, square = 0.0;

  void add(double L) {
    sum += L;
    square += L * L;
  }
  bool is_good(int n, double noise) const {
    const double mean = sum / n;
    const double variance = std::max(0.0, square / n - mean * mean) / (n - 1);
    return std::sqrt(variance) <= noise * mean;
  }
};

}  // namespace

FilterPlaces::FilterPlaces() {
  for (int i = 0; i < steps_; ++i) {
    cdf_[i + 1] = cdf_[i] + blackman_harris(2.0 * (i + 0.5) / steps_ - 1.0);
  }
  for (double& share : cdf_) share /= cdf_[steps_];
}

double FilterPlaces::offset(double u) const {
  const auto above = std::upper_bound(cdf_.begin() + 1, cdf_.end() - 1, u);
  const auto step = above - cdf_.begin() - 1;
  const double within = (u - *(above - 1)) / (*above - *(above - 1));
  return filter_radius * (2.0 * (static_cast<double>(step) + within) / steps_ - 1.0);
}

PixelSamples::PixelSamples(const CameraRays& rays, const RayTree& tree,
                           const SampleOptions& options)
    : rays_(rays), tree_(tree), options_(options), points_(options.most) {}

PixelSamples::Result PixelSamples::operator()(int x, int y) const {
  const auto column = static_cast<std::uint64_t>(x), row = static_cast<std::uint64_t>(y);
  const std::uint64_t place_key = random_key(column, row, place_purpose);
  const std::uint64_t look_key = random_key(column, row, look_purpose);
  Result result;
  Tally tally;
  int judged_at = std::min(options_.least, options_.most);
  while (result.count < options_.most) {
    const Eigen::Array4d u = points_.point(result.count, place_key).cast<double>();
    const Ray ray =
        rays_.ray(x + 0.5 + filter_.offset(u[0]), y + 0.5 + filter_.offset(u[1]), u[2], u[3]);
    const Sight sight = tree_.look_one_of_many(ray, look_key, result.count);
    if (result.count == 0) {
      result.sum = sight;
    } else {
      result.sum.radiance += sight.radiance;
      result.sum.layers += sight.layers;
      result.sum.depth_cut += sight.depth_cut;
    }
    tally.add(static_cast<double>(sight.radiance.mean()));
    if (++result.count < judged_at) continue;
    if (result.count > 1 && tally.is_good(result.count, options_.noise)) break;
    judged_at *= 2;
  }
  return result;
}

}  // namespace lightwell
