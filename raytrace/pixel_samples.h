#pragma once

#include <array>
#include <optional>

#include "raytrace/camera_ray.h"
#include "raytrace/shade.h"
#include "scene/sampling.h"

namespace lightwell {

/// Places about a pixel's centre with the density of the Blackman-Harris window over three pixels
/// (Harris 1978), a reconstruction filter without negative lobes: a plain mean of samples at such
/// places is the filtered picture (Ernst, Stamminger & Greiner 2006).
class FilterSampler {
 public:
  FilterSampler();
  /// Of u in [0,1): -1.5 to 1.5 pixels.
  double offset(double u) const;

 private:
  static constexpr int steps_ = 256;
  std::array<double, steps_ + 1> cdf_{};
};

/// What looks through one pixel saw.
struct PixelTally {
  RaySample sum{};  ///< of all samples; its fingerprint means nothing
  int count = 0;
  double light = 0.0, square = 0.0;  ///< sums of the bands' mean radiance and of its square

  /// Whether the standard error of the mean is at most `noise`, above 0, of it: that of as many
  /// independent samples; stratified ones are better.
  bool is_good(float noise) const;
};

/// While a shutter is open; a picture is the mean over that time.
struct Exposure {
  ElementCaster caster;                 ///< knows what moves
  double open = 0.0, close = 0.0;       ///< s
  std::optional<RigidMotion> camera{};  ///< of the camera itself
};

/// A pixel by many samples, each through a place of its own of picture and lens: for what no
/// subdivision of the pixel's square resolves, gloss, depth of field and motion (Cook, Porter &
/// Carpenter 1984). Samples are points of one scrambled Sobol sequence per pixel, in picture, lens
/// and time, and neighbours share none.
class PixelSamples {
 public:
  PixelSamples(const CameraRays& rays, const RayTree& tree, const SampleOptions& options,
               std::optional<Exposure> exposure = {});

  /// SampleOptions::least samples.
  PixelTally first_samples(int x, int y) const;
  /// More, until the error is what SampleOptions::noise asks for, at most SampleOptions::most.
  /// Beside a pixel whose first samples are not good, four times `least` come before the first
  /// judgement: what is small and bright may have escaped them.
  void take_more(int x, int y, bool is_beside_noise, PixelTally& tally) const;

  const SampleOptions& options() const { return options_; }

 private:
  void take(int x, int y, int until, PixelTally& tally) const;
  RaySample sample_at_time(Ray ray, double time, std::uint64_t key, int number) const;

  const CameraRays& rays_;
  const RayTree& tree_;
  SampleOptions options_;
  std::optional<Exposure> exposure_;  // none: nothing moves
  SobolPoints points_;
  FilterSampler filter_;
};

}  // namespace lightwell
