#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace lightwell {

/// The most spectral bands a scene may have (400-700 nm at 4 nm needs 76).
inline constexpr int max_bands = 96;

/// One value per band: a reflectance, an exitance, a radiance ... Lives on the stack.
using Spectrum = Eigen::Array<float, Eigen::Dynamic, 1, Eigen::ColMajor, max_bands, 1>;

/// One row of bands per patch, element, vertex or pixel; a row is contiguous.
using BandArray = Eigen::Array<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Meaning of the K columns of every spectral quantity, and their conversion to light as people see
/// it.
struct Bands {
  std::vector<std::string> names{};      ///< "r", "g", "b", or "400-404nm" ...
  std::vector<double> wavelengths_nm{};  ///< band centres; empty for RGB
  /// Rows X, Y, Z: contribution of 1 W of band k to CIE 1931 X, Y, Z. For RGB, Y of white (1, 1, 1)
  /// is 1; for wavelengths, Y is the colour-matching function itself.
  Eigen::Array<float, 3, Eigen::Dynamic> xyz{};
  double lumens_per_watt = 683.0;  ///< luminous efficacy that multiplies Y

  int count() const { return static_cast<int>(names.size()); }
};

/// Linear RGB with Rec. 709 primaries: luminance weights 0.2126, 0.7152, 0.0722. `lumens_per_watt`
/// is 683 unless a file format defines another value (RADIANCE files: 179).
Bands rgb_bands(double lumens_per_watt = 683.0);

/// `count` equal bands from `first_nm` to `last_nm` (edges). A band's value is the power in the
/// band (W per band, not per nm). The colour-matching functions of the CIE 1931 standard observer
/// are averaged over each band. Throws std::invalid_argument unless 360 <= first <
/// last <= 830 and 1 <= count <= max_bands.
Bands spectral_bands(double first_nm, double last_nm, int count);

/// Photometric value: lm/W times sum_k Y_k values_k. Lux from irradiance, cd/m^2 from radiance,
/// lumens from watts.
double luminous(const Bands& bands, const Eigen::Ref<const Spectrum>& values);

/// Linear sRGB for display; components may lie outside [0,1]. RGB bands are returned unchanged.
Eigen::Array3f linear_rgb(const Bands& bands, const Eigen::Ref<const Spectrum>& values);

/// Returns a spectrum of `value` in every band.
Spectrum constant_spectrum(const Bands& bands, float value);

}  // namespace lightwell
