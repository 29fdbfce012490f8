#include "scene/bands.h"

#include <fmt/format.h>

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "scene/colour_matching.h"

namespace lightwell {
namespace {

// CIE XYZ (D65) of the Rec. 709 primaries (ITU-R BT.709); the Y row is the luminance weights.
const Eigen::Matrix3f& xyz_from_rgb() {
  static const Eigen::Matrix3f matrix =
      (Eigen::Matrix3f() << 0.4124564f, 0.3575761f, 0.1804375f, 0.2126729f, 0.7151522f, 0.0721750f,
       0.0193339f, 0.1191920f, 0.9503041f)
          .finished();
  return matrix;
}

}  // namespace

Bands rgb_bands(double lumens_per_watt) {
  return {
      .names = {"r", "g", "b"}, .xyz = xyz_from_rgb().array(), .lumens_per_watt = lumens_per_watt};
}

Bands spectral_bands(double first_nm, double last_nm, int count) {
  if (!(first_nm >= 360.0 && first_nm < last_nm && last_nm <= 830.0)) {
    throw std::invalid_argument(fmt::format(
        "bands from {} nm to {} nm: give a rising range within 360-830 nm", first_nm, last_nm));
  }
  if (count < 1 || count > max_bands) {
    throw std::invalid_argument(fmt::format("{} bands: give between 1 and {}", count, max_bands));
  }
  Bands bands;
  bands.xyz.resize(3, count);
  const double width = (last_nm - first_nm) / count;
  for (int k = 0; k < count; ++k) {
    const double left = first_nm + k * width;
    bands.names.push_back(fmt::format("{:g}-{:g}nm", left, left + width));
    bands.wavelengths_nm.push_back(left + 0.5 * width);
    const auto matching = colour_matching(left, std::min(left + width, last_nm));
    for (int c = 0; c < 3; ++c) bands.xyz(c, k) = static_cast<float>(matching[c]);
  }
  return bands;
}

double luminous(const Bands& bands, const Eigen::Ref<const Spectrum>& values) {
  return bands.lumens_per_watt * (bands.xyz.row(1).transpose() * values).cast<double>().sum();
}

Eigen::Array3f linear_rgb(const Bands& bands, const Eigen::Ref<const Spectrum>& values) {
  if (bands.wavelengths_nm.empty()) return values.head<3>();
  static const Eigen::Matrix3f rgb_from_xyz = xyz_from_rgb().inverse();
  return (rgb_from_xyz * (bands.xyz.matrix() * values.matrix())).array();
}

Spectrum constant_spectrum(const Bands& bands, float value) {
  return Spectrum::Constant(bands.count(), value);
}

}  // namespace lightwell
