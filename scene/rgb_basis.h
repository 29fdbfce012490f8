#pragma once

#include <Eigen/Core>

#include "scene/bands.h"

namespace lightwell {

/// Reflectances of colours in the bands of a scene. A colour of linear Rec. 709 shares r, g, b has
/// the reflectance
///
///     rho(lambda) = r R(lambda) + g G(lambda) + b B(lambda)
///
/// with three smooth functions in [0,1] whose sum is 1 at every wavelength, so that white stays
/// white and no colour reflects more than its largest share (Mallett & Yuksel 2019, "Spectral
/// Primary Decomposition for Rendering with sRGB Reflectance"). Under CIE's daylight D65 the
/// reflectance has the colour that it was made of. In RGB bands rho is the colour itself.
class RgbBasis {
 public:
  /// RGB bands.
  RgbBasis() = default;
  /// A band has the mean of the functions over it, those of 380 and 730 nm beyond.
  explicit RgbBasis(const Bands& bands);

  /// rho per band of a colour whose shares are in [0,1].
  Spectrum reflectance(const Eigen::Array3f& rgb) const;

 private:
  Eigen::Array<float, Eigen::Dynamic, 3> per_band_{};  // R, G, B; empty: RGB bands
};

}  // namespace lightwell
