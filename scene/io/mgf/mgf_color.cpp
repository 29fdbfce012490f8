#include "scene/io/mgf/mgf_color.h"

#include <Eigen/LU>
#include <algorithm>

#include "scene/bands.h"
#include "scene/black_body.h"
#include "scene/errors.h"
#include "scene/io/spectrum_file.h"

namespace lightwell {
namespace {

// Linear RGB of X, Y, Z relative to equal energy, which is this format's white.
MgfColor rgb_of(const Eigen::Array3d& xyz) {
  const Eigen::Matrix3d xyz_of_rgb = rgb_bands().xyz.matrix().cast<double>();
  const Eigen::Array3d white = xyz_of_rgb.rowwise().sum().array();
  const Eigen::Vector3d rgb = xyz_of_rgb.inverse() * (white * xyz).matrix();
  return with_unit_luminance(rgb.array().max(0.0));
}

}  // namespace

MgfColor with_unit_luminance(const MgfColor& color) {
  const Eigen::Array3d weights = rgb_bands().xyz.row(1).transpose().cast<double>();
  const double luminance = (weights * color).sum();
  if (!(luminance > 0.0) || !color.isFinite().all()) {
    throw InputError("the colour has no luminance");
  }
  return color / luminance;
}

MgfColor mgf_chromaticity(double x, double y) {
  return rgb_of({x / y, 1.0, (1.0 - x - y) / y});
}

MgfColor mgf_spectrum(double low, double high, std::span<const double> values) {
  SpectrumSamples samples;
  if (low > 400.0) {
    samples.wavelengths_nm = {std::min(400.0, low - 1.0), low - 1e-3};
    samples.values = {0.0, 0.0};
  }
  const double step = (high - low) / static_cast<double>(values.size() - 1);
  for (std::size_t i = 0; i < values.size(); ++i) {
    samples.wavelengths_nm.push_back(low + step * static_cast<double>(i));
    samples.values.push_back(values[i]);
  }
  if (high < 700.0) {
    samples.wavelengths_nm.insert(samples.wavelengths_nm.end(),
                                  {high + 1e-3, std::max(700.0, high + 1.0)});
    samples.values.insert(samples.values.end(), {0.0, 0.0});
  }
  return with_unit_luminance(
      {mean(samples, 600, 700), mean(samples, 500, 600), mean(samples, 400, 500)});
}

MgfColor mgf_black_body(double kelvin) {
  const Bands bands = spectral_bands(380.0, 780.0, 80);
  Eigen::Array3d xyz = Eigen::Array3d::Zero();
  for (int k = 0; k < bands.count(); ++k) {
    xyz += bands.xyz.col(k).cast<double>() *
           black_body_radiance(bands.wavelengths_nm[static_cast<std::size_t>(k)], kelvin);
  }
  if (!(xyz[1] > 0.0)) throw InputError("the black body is too cold to be seen");
  return rgb_of(xyz / xyz[1]);
}

}  // namespace lightwell
