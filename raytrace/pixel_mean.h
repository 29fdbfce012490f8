#pragma once

#include <array>
#include <vector>

#include "raytrace/eye.h"
#include "raytrace/layer_film.h"
#include "scene/sampling.h"

namespace lightwell {

/// Radiance and sampled layers, averaged together.
struct PixelValue {
  Spectrum radiance{};
  SampledLayers layers = SampledLayers::Zero();

  static PixelValue zero(int bands) { return {.radiance = Spectrum::Zero(bands)}; }
  template <class Seen>  // RaySample or PixelValue
  void add(const Seen& seen, float share) {
    radiance += share * seen.radiance;
    layers += share * seen.layers;
  }
};

/// Mean radiance over a pixel's square by adaptive subdivision (Whitted 1980): the mean of the four
/// corners if they agree, else of the four quarters.
class PixelMean {
 public:
  /// Corners of a cell: top left, top right, bottom left, bottom right.
  using Corners = std::array<const RaySample*, 4>;

  PixelMean(const Eye& eye, const RenderOptions& options);

  /// Returns the mean over the pixel of column `x` and row `y` with these corners.
  PixelValue operator()(int x, int y, const Corners& corners);
  /// True if a sample of the last pixel, beside its corners, met a rough surface.
  bool met_gloss() const { return met_gloss_; }

 private:
  int slot(int i, int j) const { return j * (cells_ + 1) + i; }
  void keep(int i, int j, RaySample sample);
  const RaySample* sample(int i, int j);
  PixelValue cell_mean(int i, int j, int size);
  PixelValue split(int i, int j, int size);
  PixelValue edge_mean(int i, int j, const Corners& corners) const;
  bool must_split(int i, int j, int size, const Corners& corners) const;

  const Eye& eye_;
  const RenderOptions& options_;
  const SobolPoints edge_points_{16};
  int cells_, steps_per_cell_;
  int x_ = 0, y_ = 0, panel_ = 0;
  bool met_gloss_ = false;
  std::vector<RaySample> lattice_samples_;  // samples at this pixel's lattice points
  std::vector<char> known_;
};

}  // namespace lightwell
