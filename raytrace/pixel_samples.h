#pragma once

#include <array>

#include "raytrace/camera_ray.h"
#include "raytrace/shade.h"
#include "scene/sampling.h"

namespace lightwell {

/// Places about a pixel's centre with the density of the Blackman-Harris window over three pixels
/// (Harris 1978), a reconstruction filter without negative lobes: a plain mean of samples at such
/// places is the filtered picture (Ernst, Stamminger & Greiner 2006).
class FilterPlaces {
 public:
  FilterPlaces();
  /// Of u in [0,1): -1.5 to 1.5 pixels.
  double offset(double u) const;

 private:
  static constexpr int steps_ = 256;
  std::array<double, steps_ + 1> cdf_{};
};

/// A pixel by many looks, each through a place of its own of picture and lens: for what no
/// subdivision of the pixel's square resolves, gloss and depth of field (Cook, Porter & Carpenter
/// 1984). Samples are points of one scrambled Sobol sequence per pixel, and neighbours share none.
class PixelSamples {
 public:
  PixelSamples(const CameraRays& rays, const RayTree& tree, const SampleOptions& options);

  struct Result {
    Sight sum{};  ///< of all looks: divide by `count`; its fingerprint means nothing
    int count = 0;
  };
  /// Looks until the standard error of the mean is below SampleOptions::noise of it, at most
  /// SampleOptions::most times. The error is that of as many independent looks: stratified ones are
  /// better than that.
  Result operator()(int x, int y) const;

 private:
  const CameraRays& rays_;
  const RayTree& tree_;
  SampleOptions options_;
  SobolPoints points_;
  FilterPlaces filter_;
};

}  // namespace lightwell
