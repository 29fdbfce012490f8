#include "standards/colour_rendering.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/black_body.h"
#include "scene/cie_daylight.h"
#include "scene/colour_matching.h"

namespace lightwell {
namespace {

constexpr int test_colours = 8;

const std::vector<SpectrumSamples>& rendering_tables() {
  static const auto tables = spectra_of_table(standards_data::rendering_tables);
  return tables;
}

// Intervals of 1 nm around 380 to 780 nm with the power that `at` gives at their middles.
template <class At>
SpectralPower sampled(const At& at) {
  SpectralPower power{.edges_nm = {first_receptor_nm - 0.5}};
  for (double nm = first_receptor_nm; nm <= last_receptor_nm; nm += 1.0) {
    power.edges_nm.push_back(nm + 0.5);
    power.watts.push_back(at(nm));
  }
  return power;
}

Eigen::Vector2d uv_of(const Eigen::Vector3d& xyz) {
  const double sum = xyz.sum();
  return lightwell::uv_of(xyz[0] / sum, xyz[1] / sum);
}

// Colour matching of the intervals of sampled(): a row each.
const Eigen::Matrix<double, Eigen::Dynamic, 3>& sampled_matching() {
  static const auto rows = [] {
    const SpectralPower even = sampled([](double) { return 1.0; });
    Eigen::Matrix<double, Eigen::Dynamic, 3> made(static_cast<Eigen::Index>(even.watts.size()), 3);
    for (Eigen::Index k = 0; k < made.rows(); ++k) {
      SpectralPower one = even;
      one.watts.assign(even.watts.size(), 0.0);
      one.watts[static_cast<std::size_t>(k)] = 1.0;
      made.row(k) = tristimulus(one).transpose();
    }
    return made;
  }();
  return rows;
}

Eigen::Vector2d uv_of_black_body(double kelvin) {
  const SpectralPower power = black_body_power(kelvin);
  const Eigen::Map<const Eigen::VectorXd> watts(power.watts.data(),
                                                static_cast<Eigen::Index>(power.watts.size()));
  return uv_of(sampled_matching().transpose() * watts);
}

// Coordinates c and d of CIE 13.3, in which von Kries' adaptation is a product.
Eigen::Array2d adaptable(const Eigen::Vector2d& uv) {
  return {(4.0 - uv[0] - 10.0 * uv[1]) / uv[1], (1.708 * uv[1] + 0.404 - 1.481 * uv[0]) / uv[1]};
}

// CIE 1964 U*, V*, W* of a colour of luminance factor `Y` (percent) and chromaticity `uv`.
Eigen::Vector3d uniform(double Y, const Eigen::Vector2d& uv, const Eigen::Vector2d& white) {
  const double w = 25.0 * std::cbrt(Y) - 17.0;
  return {13.0 * w * (uv[0] - white[0]), 13.0 * w * (uv[1] - white[1]), w};
}

}  // namespace

SpectralPower black_body_power(double kelvin) {
  constexpr double at_nm = 560.0;
  return sampled([&](double nm) {
    return black_body_radiance(nm, kelvin) / black_body_radiance(at_nm, kelvin);
  });
}

Eigen::Vector3d tristimulus(const SpectralPower& power, const SpectrumSamples* reflectance) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for_each_visible_interval(power, [&](double low, double high, double watts) {
    const double rho = reflectance ? mean(*reflectance, low, high) : 1.0;
    const auto matching = colour_matching(low, high);
    sum += watts * rho * Eigen::Vector3d(matching[0], matching[1], matching[2]);
  });
  return sum;
}

Eigen::Vector2d uv_of(double x, double y) {
  const double scale = -2.0 * x + 12.0 * y + 3.0;
  return {4.0 * x / scale, 6.0 * y / scale};
}

NearestBlackBody nearest_black_body(const Eigen::Vector2d& uv) {
  // A search over reciprocal temperatures, in which the black bodies are nearly evenly spaced.
  constexpr double coolest = 1000.0, hottest = 100000.0;
  constexpr int coarse = 64, halvings = 40;
  const auto distance = [&](double mired) { return (uv - uv_of_black_body(1e6 / mired)).norm(); };
  const double low = 1e6 / hottest, high = 1e6 / coolest, step = (high - low) / coarse;
  double best = low;
  for (int i = 0; i <= coarse; ++i) {
    if (distance(low + i * step) < distance(best)) best = low + i * step;
  }
  constexpr double golden = 0.6180339887498949;
  double from = std::max(low, best - step), to = std::min(high, best + step);
  for (int i = 0; i < halvings; ++i) {
    const double a = to - golden * (to - from), b = from + golden * (to - from);
    (distance(a) < distance(b) ? to : from) = distance(a) < distance(b) ? b : a;
  }
  const double kelvin = 1e6 / (0.5 * (from + to));
  const Eigen::Vector2d off = uv - uv_of_black_body(kelvin);
  const double at = 1e6 / kelvin, rounding = 1e-6 * step;
  return {.kelvin = kelvin,
          .duv = std::copysign(off.norm(), off[1]),
          .is_at_end = at < low + rounding || at > high - rounding};
}

SpectralPower daylight_illuminant(double kelvin) {
  const SpectrumSamples daylight = daylight_spectrum(kelvin);
  constexpr double narrow = 1e-3;  // nm, of the interval that stands for a wavelength
  SpectralPower power = sampled([&](double nm) {
    return mean(daylight, std::max(first_receptor_nm, nm - narrow),
                std::min(last_receptor_nm, nm + narrow));
  });
  const double lux = greatest_luminous_efficacy * tristimulus(power)[1];
  for (double& watts : power.watts) watts /= lux;
  return power;
}

std::optional<double> general_colour_rendering(const SpectralPower& power,
                                               const NearestBlackBody& nearest) {
  constexpr double farthest = 5.4e-3, first_daylight = 5000.0;
  if (std::abs(nearest.duv) > farthest || nearest.kelvin > hottest_daylight) return {};
  const SpectralPower reference = nearest.kelvin < first_daylight
                                      ? black_body_power(nearest.kelvin)
                                      : daylight_illuminant(nearest.kelvin);
  const Eigen::Vector3d white = tristimulus(power);
  const Eigen::Vector3d reference_white = tristimulus(reference);
  const Eigen::Vector2d uv_white = uv_of(white), uv_reference = uv_of(reference_white);
  const Eigen::Array2d adaptation = adaptable(uv_reference) / adaptable(uv_white);
  constexpr double percent = 100.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < test_colours; ++i) {
    const SpectrumSamples& colour = rendering_tables()[i];
    const Eigen::Vector3d lit = tristimulus(power, &colour);
    const Eigen::Vector3d referred = tristimulus(reference, &colour);
    const Eigen::Array2d cd = adaptation * adaptable(uv_of(lit));
    const double scale = 16.518 + 1.481 * cd[0] - cd[1];
    const Eigen::Vector2d adapted((10.872 + 0.404 * cd[0] - 4.0 * cd[1]) / scale, 5.520 / scale);
    const double difference =
        (uniform(percent * lit[1] / white[1], adapted, uv_reference) -
         uniform(percent * referred[1] / reference_white[1], uv_of(referred), uv_reference))
            .norm();
    sum += percent - 4.6 * difference;
  }
  return sum / test_colours;
}

}  // namespace lightwell
