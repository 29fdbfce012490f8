#include "daylight/year_error.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lightwell {

std::vector<SkyHour> spread_over(std::span<const SkyHour> hours, int samples) {
  std::vector<SkyHour> some;
  const auto count = std::min(hours.size(), static_cast<std::size_t>(samples));
  for (std::size_t i = 0; i < count; ++i) {
    some.push_back(hours[(2 * i + 1) * hours.size() / (2 * count)]);
  }
  return some;
}

double relative_difference(const Eigen::ArrayXd& difference, const Eigen::ArrayXd& light) {
  if (light.size() == 0) return 0.0;
  if (!(light.mean() > 0.0)) return (difference.abs() > 0.0).any() ? 1.0 : 0.0;
  constexpr double least_share = 0.25;
  const Eigen::ArrayXd reference = light.max(least_share * light.mean());
  return std::sqrt((difference / reference).square().mean());
}

namespace {

// The sum over hours of each sensor's light but direct sunlight, lx.
Eigen::ArrayXd diffuse_sum(const DaylightModel& model, const SkyCoefficients& sky,
                           std::span<const SkyHour> hours, double ground_reflectance) {
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(model.sensor_count());
  simulate_year(model, sky, hours, ground_reflectance, [&](const HourBlock& block) {
    sum += (block.total - block.sunlight).cast<double>().rowwise().sum();
  });
  return sum;
}

// A quarter of the patches and half of the rays.
DaylightOptions coarse_options(DaylightOptions options) {
  MeshOptions& mesh = options.mesh;
  mesh.auto_patch_count = std::max(1, mesh.auto_patch_count / 4);
  mesh.max_patch_size *= 2.0;
  options.form_factors.rays_per_patch = std::max(1, options.form_factors.rays_per_patch / 2);
  options.points_of_patch = std::max(1, options.points_of_patch / 2);
  options.points.rays /= 2;
  options.patches.rays /= 2;
  options.gather_rays = std::max(1, options.gather_rays / 2);
  ++options.replica;
  return options;
}

// Factor of d for n sensors: the 95 % quantile of Student's distribution with n degrees of freedom
// over 2, that of many, by its expansion in 1/n (12.7 at n = 1, 2.23 at n = 10).
double few_sensors(double n) {
  constexpr double many = 1.96;
  const double quantile =
      n < 1.5 ? 12.71 : many * (1.0 + 1.21 / n + 1.42 / (n * n) + 4.0 / (n * n * n));
  return std::max(1.0, quantile / 2.0);
}

}  // namespace

double year_error(const DaylightModel& model, const SkyCoefficients& sky,
                  std::span<const SkyHour> hours, double ground_reflectance, int samples) {
  const std::vector<SkyHour> some = spread_over(hours, samples);
  DaylightModel coarse(model.scene(), model.sky().up(), model.sky().north(),
                       coarse_options(model.options()));
  coarse.set_sensors(model.sensors());
  const Eigen::ArrayXd fine_sum = diffuse_sum(model, sky, some, ground_reflectance),
                       coarse_sum = diffuse_sum(coarse, coarse.sky_coefficients().sum(), some,
                                                ground_reflectance);
  return few_sensors(static_cast<double>(fine_sum.size())) *
         relative_difference(coarse_sum - fine_sum, fine_sum);
}

}  // namespace lightwell
