#include "raytrace/pixel_samples.h"

#include "scene/found_by_chance.h"
#include "scene/random_purpose.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace lightwell {
namespace {

constexpr double filter_radius = 1.5;  // pixels

// Blackman-Harris window for x in [-1, 1]; 1 in the middle.
double blackman_harris(double x) {
  const double a = std::numbers::pi * (x + 1.0);
  return 0.35875 - 0.48829 * std::cos(a) + 0.14128 * std::cos(2.0 * a) -
         0.01168 * std::cos(3.0 * a);
}

}  // namespace

bool PixelTally::is_good(float noise) const {
  if (!(noise > 0.0f) || count < 2) return false;
  const double mean = mean_light();
  // The solution may be coarse where a lamp is near, and light without occluders has no shadows.
  const double variance = std::max(spread, square / count - mean * mean) / (count - 1) +
                          drawn / (static_cast<double>(count) * count);
  return std::sqrt(variance) <= static_cast<double>(noise) * mean;
}

bool PixelTally::is_good_beside(const NearbyNoise& beside, float noise) const {
  if (!is_good(noise)) return false;
  const double missed = std::max(0.0, beside.brightest - brightest) / (std::numbers::e * count);
  return missed <= static_cast<double>(noise) * std::max(mean_light(), beside.mean);
}

FilterSampler::FilterSampler() {
  for (int i = 0; i < steps_; ++i) {
    cdf_[i + 1] = cdf_[i] + blackman_harris(2.0 * (i + 0.5) / steps_ - 1.0);
  }
  for (double& share : cdf_) share /= cdf_[steps_];
}

double FilterSampler::offset(double u) const {
  const auto above = std::upper_bound(cdf_.begin() + 1, cdf_.end() - 1, u);
  const auto step = above - cdf_.begin() - 1;
  const double within = (u - *(above - 1)) / (*above - *(above - 1));
  return filter_radius * (2.0 * (static_cast<double>(step) + within) / steps_ - 1.0);
}

PixelSamples::PixelSamples(const CameraRays& rays, const RayTree& tree,
                           const SampleOptions& options, PixelFilter filter,
                           std::optional<Exposure> exposure)
    : rays_(rays),
      tree_(tree),
      options_(options),
      exposure_(std::move(exposure)),
      points_(options.most),
      filter_(filter),
      gathers_light_(tree.gathers_light()) {}

PixelTally PixelSamples::first_samples(int x, int y, int times) const {
  PixelTally tally;
  Pending pending;
  take(x, y, std::min(times * options_.least, options_.most), tally, pending);
  add_gathered(x, y, std::move(pending), tally);
  return tally;
}

void PixelSamples::take_more(int x, int y, const NearbyNoise& beside, PixelTally& tally) const {
  const auto is_over = [&] {
    return tally.count >= options_.most || tally.is_good_beside(beside, options_.noise);
  };
  while (!is_over()) {
    Pending pending;
    // The light of all points together takes little more time than that of some.
    while (!is_over()) take(x, y, std::min(2 * tally.count, options_.most), tally, pending);
    add_gathered(x, y, std::move(pending), tally);
  }
}

// Adds the direct light of the points that samples left.
void PixelSamples::add_gathered(int x, int y, Pending pending, PixelTally& tally) const {
  if (pending.points.empty()) return;
  const std::uint64_t key =
      random_key(random_key(static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y),
                            RandomPurpose::pixel_shading),
                 RandomPurpose::light_pairs, static_cast<std::uint64_t>(tally.count));
  const GatheredLight found = tree_.gathered(pending.points, key, pending.other);
  tally.sum.radiance += found.radiance;
  tally.drawn += found.noise * found.noise;
  tally.spread = std::max(tally.spread, found.spread);
}

RaySample PixelSamples::mean(const PixelTally& tally) const {
  // Less than eyes see in one pixel among others of its noise.
  constexpr float of_other_light = 0.1f;
  RaySample mean = tally.sum;
  if (!tally.by_chance.empty()) {
    const float besides = of_other_light * mean.radiance.mean();
    tree_.add_specular(limited_sum(tally.by_chance, tally.count, besides), mean);
  }
  const float share = 1.0f / static_cast<float>(tally.count);
  mean.radiance *= share;
  mean.layers *= share;
  return mean;
}

RaySample PixelSamples::traced(const Ray& ray, std::uint64_t key, int number,
                               const ElementCaster& caster, const PixelCone& cone,
                               Pending& pending) const {
  if (!gathers_light_) return tree_.trace_one_of_many(ray, key, number, caster, cone);
  return tree_.trace_to_gather(ray, key, number, caster, cone, pending.points);
}

RaySample PixelSamples::sample_at_time(Ray ray, double time, std::uint64_t key, int number,
                                       const PixelCone& cone, Pending& pending) const {
  if (exposure_->camera) {
    const Eigen::Isometry3d moved = exposure_->camera->at(time);
    ray.origin = moved * ray.origin;
    ray.direction = moved.linear() * ray.direction;
  }
  pending.casters.push_back(exposure_->caster.at(time));
  return traced(ray, key, number, pending.casters.back(), cone, pending);
}

// Offset of a sample from the pixel's centre along one axis.
double PixelSamples::offset(double u) const {
  return filter_ == PixelFilter::square ? u - 0.5 : window_.offset(u);
}

void PixelSamples::take(int x, int y, int until, PixelTally& tally, Pending& pending) const {
  const auto column = static_cast<std::uint64_t>(x), row = static_cast<std::uint64_t>(y);
  const std::uint64_t sample_key = random_key(column, row, RandomPurpose::pixel_points);
  const std::uint64_t shading_key = random_key(column, row, RandomPurpose::pixel_shading);
  const int panel = rays_.panel_at(x + 0.5, y + 0.5);
  const PixelCone cone = rays_.cone(x + 0.5, y + 0.5, panel);
  const auto sample_of = [&](const Ray& ray) {
    if (!exposure_) return traced(ray, shading_key, tally.count, tree_.caster(), cone, pending);
    const double part = SobolPoints::fifth(tally.count, sample_key);
    const double time = exposure_->open + part * (exposure_->close - exposure_->open);
    return sample_at_time(ray, time, shading_key, tally.count, cone, pending);
  };
  for (; tally.count < until; ++tally.count) {
    const Eigen::Array4d u = points_.point(tally.count, sample_key).cast<double>();
    const auto ray =
        rays_.ray_at(x + 0.5 + offset(u[0]), y + 0.5 + offset(u[1]), u[2], u[3], panel);
    const std::size_t before = pending.points.size();
    RaySample sample = ray ? sample_of(*ray) : tree_.nothing();
    double of_points = 0.0;
    for (std::size_t i = before; i < pending.points.size(); ++i) {
      of_points += pending.points[i].about;
    }
    pending.other += static_cast<double>(sample.radiance.mean());
    add(std::move(sample), of_points, tally);
  }
}

// Adds a sample, whose points have about the radiance `of_points`.
void PixelSamples::add(RaySample sample, double of_points, PixelTally& tally) {
  const double light = static_cast<double>(sample.radiance.mean()) + of_points;
  tally.light += light;
  tally.square += light * light;
  tally.brightest = std::max(tally.brightest, light);
  if (sample.by_chance.size() > 0) tally.by_chance.push_back(std::move(sample.by_chance));
  if (tally.count == 0) {
    tally.sum = std::move(sample);
    return;
  }
  tally.sum.radiance += sample.radiance;
  tally.sum.layers += sample.layers;
  tally.sum.depth_cut += sample.depth_cut;
  tally.sum.cut_weight += sample.cut_weight;
}

}  // namespace lightwell
