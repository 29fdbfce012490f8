#include "scene/bands.h"

#include <fmt/format.h>

#include <Eigen/LU>

#include <array>
#include <cmath>
#include <stdexcept>

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

double lobe(double nm, double centre, double left, double right) {
  const double t = (nm - centre) * (nm < centre ? left : right);
  return std::exp(-0.5 * t * t);
}

// Wyman, Sloan & Shirley 2013, "Simple analytic approximations to the CIE XYZ color matching
// functions", table 1, two and three lobes: within 1 % of the 1931 table's peak.
std::array<double, 3> colour_matching(double nm) {
  return {0.362 * lobe(nm, 442.0, 0.0624, 0.0374) + 1.056 * lobe(nm, 599.8, 0.0264, 0.0323) -
              0.065 * lobe(nm, 501.1, 0.0490, 0.0382),
          0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322),
          1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725)};
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
  bands.xyz.setZero(3, count);
  const double width = (last_nm - first_nm) / count;
  constexpr int samples = 16;  // the functions are smooth at 1 nm; bands may be 100 nm wide
  for (int k = 0; k < count; ++k) {
    const double left = first_nm + k * width;
    bands.names.push_back(fmt::format("{:g}-{:g}nm", left, left + width));
    bands.wavelengths_nm.push_back(left + 0.5 * width);
    for (int s = 0; s < samples; ++s) {
      const auto matching = colour_matching(left + width * (s + 0.5) / samples);
      for (int c = 0; c < 3; ++c) bands.xyz(c, k) += static_cast<float>(matching[c] / samples);
    }
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
