#pragma once

#include <array>
#include <deque>
#include <optional>
#include <vector>

#include "raytrace/cameras/camera_ray.h"
#include "raytrace/product_cuts/pixel_point.h"
#include "raytrace/shading/shade.h"
#include "scene/sampling.h"

namespace lightwell {

/// Sampler of positions about a pixel's centre, distributed by the Blackman-Harris window over
/// three pixels (Harris 1978), a reconstruction filter without negative lobes. The plain mean of
/// samples at such positions is the filtered picture (Ernst, Stamminger & Greiner 2006).
class FilterSampler {
 public:
  FilterSampler();
  /// Offset from the pixel's centre along one axis for u in [0,1): -1.5 to 1.5 pixels.
  double offset(double u) const;

 private:
  static constexpr int steps_ = 256;
  std::array<double, steps_ + 1> cdf_{};
};

/// Radiance in the first samples of pixels that are too noisy, mean of the bands.
struct NearbyNoise {
  double brightest = 0.0;  ///< of a sample
  double mean = 0.0;
};

/// Sums over the samples of one pixel.
struct PixelTally {
  /// Sum over samples, without what these found by chance; the fingerprint has no meaning.
  RaySample sum{};
  std::vector<Spectrum> by_chance{};  ///< RaySample::by_chance of the samples that have any
  int count = 0;
  /// Sums of the bands' mean radiance and of its square; direct light of points about as the
  /// solution has it.
  double light = 0.0, square = 0.0;
  double brightest = 0.0;  ///< greatest of these radiances
  double drawn = 0.0;      ///< variance of the sum of gathered light, mean of the bands
  double spread = 0.0;     ///< of the first samples' gathered light, see GatheredLight

  /// Mean of the samples' radiances that `light` is the sum of; there is a sample.
  double mean_light() const { return light / count; }

  /// Returns whether the standard error of the mean, without what is found by chance, is at most
  /// the share `noise` of the mean; false for `noise` 0 or fewer than two samples. The standard
  /// error is that of independent samples, with that of gathered light; stratified samples have a
  /// smaller one.
  bool is_good(float noise) const;
  /// Returns whether is_good(), and whether something as bright as in the pixels `beside`, which no
  /// sample of this one shows, can be left out within the error `noise` of the brighter of both
  /// means. A share p of the pixel is missed by n samples with the probability (1 - p)^n, so the
  /// light that is lost by ending after n samples is p (1 - p)^n <= 1 / (e n) of the brightest.
  bool is_good_beside(const NearbyNoise& beside, float noise) const;
};

/// Interval in which a shutter is open; a picture is the mean over the interval.
struct Exposure {
  ElementCaster caster;                 ///< caster with the scene's motions
  double open = 0.0, close = 0.0;       ///< s
  std::optional<RigidMotion> camera{};  ///< motion of the camera; none: the camera stands still
};

/// The samples that a pixel is the mean of: those of its square, or those of FilterSampler's
/// window.
enum class PixelFilter { square, window };

/// Sampler of a pixel by many samples, each through its own point of picture and lens: for gloss,
/// depth of field and motion, which no subdivision of the pixel's square resolves (Cook, Porter &
/// Carpenter 1984). The samples are points of one scrambled Sobol sequence per pixel, in picture,
/// lens and time. Neighbours share no samples. Where lights are clustered, the direct light of all
/// samples of a pixel is found together (see gathered_light()).
class PixelSamples {
 public:
  PixelSamples(const CameraRays& rays, const RayTree& tree, const SampleOptions& options,
               PixelFilter filter = PixelFilter::window, std::optional<Exposure> exposure = {});

  /// Takes the first samples of pixel (x, y): `times` SampleOptions::least, but at most
  /// SampleOptions::most.
  PixelTally first_samples(int x, int y, int times = 1) const;
  /// Takes more samples of pixel (x, y) until the error is at most SampleOptions::noise, and at
  /// most SampleOptions::most samples in all. The test is PixelTally::is_good_beside(), since
  /// samples may have missed something small and bright; `beside` is of pixels near by whose first
  /// samples are too noisy, zero if there are none.
  void take_more(int x, int y, const NearbyNoise& beside, PixelTally& tally) const;

  /// The mean of a pixel's samples: radiance and layers. Light found by chance counts in each
  /// sample up to four times the mean of the other samples, or a tenth of the pixel's other light.
  RaySample mean(const PixelTally& tally) const;

  const SampleOptions& options() const { return options_; }

 private:
  /// Samples whose direct light is not yet in the tally.
  struct Pending {
    std::vector<PixelPoint> points{};
    std::deque<ElementCaster> casters{};  ///< of the points, if something moves
    double other = 0.0;                   ///< sum of the samples' other radiance, mean of the bands
  };
  void take(int x, int y, int until, PixelTally& tally, Pending& pending) const;
  void add_gathered(int x, int y, Pending pending, PixelTally& tally) const;
  double offset(double u) const;
  RaySample sample_at_time(Ray ray, double time, std::uint64_t key, int number,
                           const PixelCone& cone, Pending& pending) const;
  RaySample traced(const Ray& ray, std::uint64_t key, int number, const ElementCaster& caster,
                   const PixelCone& cone, Pending& pending) const;
  static void add(RaySample sample, double of_points, PixelTally& tally);

  const CameraRays& rays_;
  const RayTree& tree_;
  SampleOptions options_;
  std::optional<Exposure> exposure_;  // empty: nothing moves
  SobolPoints points_;
  PixelFilter filter_;
  FilterSampler window_;
  bool gathers_light_ = false;
};

}  // namespace lightwell
