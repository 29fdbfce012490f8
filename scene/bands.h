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

/// What the K columns of every spectral quantity mean, and how they become light that people see.
struct Bands {
  std::vector<std::string> names{};      ///< "r", "g", "b", or "400-404nm" ...
  std::vector<double> wavelengths_nm{};  ///< band centres; empty for RGB
  /// Rows X, Y, Z: what 1 W of band k adds to CIE 1931 X, Y, Z. Y is scaled to 1 for a unit of
  /// white RGB; for wavelengths it is the colour-matching function itself.
  Eigen::Array<float, 3, Eigen::Dynamic> xyz{};
  double lumens_per_watt = 683.0;  ///< luminous efficacy that multiplies Y

  int count() const { return static_cast<int>(names.size()); }
};

/// Linear RGB with Rec. 709 primaries: luminance weights 0.2126, 0.7152, 0.0722.
/// `lumens_per_watt` is 683 unless a format says otherwise (RADIANCE files: 179).
Bands rgb_bands(double lumens_per_watt = 683.0);

/// `count` equal bands from `first_nm` to `last_nm` (edges). A band's value is the power in the
/// band (W per band, not per nm). CIE 1931 colour matching after Wyman, Sloan & Shirley 2013
/// (multi-lobe fit), averaged over each band. Throws std::invalid_argument unless 360 <= first <
/// last <= 830 and 1 <= count <= max_bands.
Bands spectral_bands(double first_nm, double last_nm, int count);

/// lm/W times sum_k Y_k values_k: lux from irradiance, cd/m^2 from radiance, lumens from watts.
double luminous(const Bands& bands, const Eigen::Ref<const Spectrum>& values);

/// Linear sRGB (may lie outside [0,1]) for display. RGB bands are returned as they are.
Eigen::Array3f linear_rgb(const Bands& bands, const Eigen::Ref<const Spectrum>& values);

/// Every band set to `value`.
Spectrum constant_spectrum(const Bands& bands, float value);

}  // namespace lightwell
