#include "standards/colour_fidelity.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "scene/cie_daylight.h"
#include "scene/io/comma_fields.h"
#include "scene/io/text_file.h"
#include "standards/colour_rendering.h"

namespace lightwell {
namespace {

constexpr std::size_t sample_count = 99;

/// Tristimulus values of a white surface and of the samples below a light, Y of white 100.
struct LitSamples {
  Eigen::Vector3d white = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> samples{};
};

// Means of the colour-matching functions of the CIE 1964 observer over [low, high] nm.
Eigen::Vector3d matching_10(double low, double high) {
  static const auto matching = spectra_of_table(standards_data::colour_matching_10);
  return {mean(matching[0], low, high), mean(matching[1], low, high), mean(matching[2], low, high)};
}

LitSamples lit_samples(const SpectralPower& power, const ColourSamples& samples) {
  LitSamples lit{.samples{samples.size(), Eigen::Vector3d::Zero()}};
  for_each_visible_interval(power, [&](double low, double high, double watts) {
    const Eigen::Vector3d light = watts * matching_10(low, high);
    lit.white += light;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      lit.samples[i] += mean(samples[i], low, high) * light;
    }
  });
  constexpr double percent = 100.0;
  const double scale = percent / lit.white.y();
  lit.white *= scale;
  for (Eigen::Vector3d& sample : lit.samples) sample *= scale;
  return lit;
}

/// CIECAM02 for an average surround, L_A = 100 cd/m^2, Y_b = 20 and full adaptation (CIE 159:2004).
class ColourAppearance {
 public:
  explicit ColourAppearance(const Eigen::Vector3d& white);

  // J', a', b' of CAM02-UCS (Luo, Cui & Li 2006).
  Eigen::Vector3d uniform(const Eigen::Vector3d& xyz) const;

 private:
  Eigen::Array3d response(const Eigen::Vector3d& xyz) const;
  double achromatic(const Eigen::Array3d& response) const {
    return (2.0 * response[0] + response[1] + response[2] / 20.0 - 0.305) * induction_;
  }

  Eigen::Matrix3d sharp_{}, cones_{};
  Eigen::Array3d adaptation_{};
  double luminance_factor_ = 1.0, induction_ = 1.0, white_ = 1.0;
  static constexpr double background = 0.2;  // Y_b / Y_w
};

ColourAppearance::ColourAppearance(const Eigen::Vector3d& white) {
  sharp_ << 0.7328, 0.4296, -0.1624, -0.7036, 1.6975, 0.0061, 0.0030, 0.0136, 0.9834;
  Eigen::Matrix3d hunt;
  hunt << 0.38971, 0.68898, -0.07868, -0.22981, 1.18340, 0.04641, 0.0, 0.0, 1.0;
  cones_ = hunt * sharp_.inverse();
  adaptation_ = white.y() / (sharp_ * white).array();
  constexpr double five_adapting = 5.0 * 100.0;  // 5 L_A
  const double k = 1.0 / (five_adapting + 1.0), k4 = k * k * k * k;
  luminance_factor_ =
      0.2 * k4 * five_adapting + 0.1 * (1.0 - k4) * (1.0 - k4) * std::cbrt(five_adapting);
  induction_ = 0.725 * std::pow(1.0 / background, 0.2);
  white_ = achromatic(response(white));
}

Eigen::Array3d ColourAppearance::response(const Eigen::Vector3d& xyz) const {
  const Eigen::Array3d adapted = adaptation_ * (sharp_ * xyz).array();
  const Eigen::Array3d cones = (cones_ * adapted.matrix()).array();
  const Eigen::Array3d power = (luminance_factor_ / 100.0 * cones.abs()).pow(0.42);
  return 400.0 * cones.sign() * power / (power + 27.13) + 0.1;
}

Eigen::Vector3d ColourAppearance::uniform(const Eigen::Vector3d& xyz) const {
  constexpr double surround = 0.69;  // c
  const Eigen::Array3d r = response(xyz);
  const double a = r[0] - 12.0 * r[1] / 11.0 + r[2] / 11.0;
  const double b = (r[0] + r[1] - 2.0 * r[2]) / 9.0;
  const double hue = std::atan2(b, a);
  const double eccentricity = 0.25 * (std::cos(hue + 2.0) + 3.8);
  const double t =
      50000.0 / 13.0 * induction_ * eccentricity * std::hypot(a, b) / (r[0] + r[1] + 1.05 * r[2]);
  const double lightness = 100.0 * std::pow(std::max(0.0, achromatic(r) / white_),
                                            surround * (1.48 + std::sqrt(background)));
  const double colourfulness = std::pow(t, 0.9) * std::sqrt(lightness / 100.0) *
                               std::pow(1.64 - std::pow(0.29, background), 0.73) *
                               std::pow(luminance_factor_, 0.25);
  const double m = std::log(1.0 + 0.0228 * colourfulness) / 0.0228;
  return {1.7 * lightness / (1.0 + 0.007 * lightness), m * std::cos(hue), m * std::sin(hue)};
}

std::vector<Eigen::Vector3d> uniform_colours(const SpectralPower& power,
                                             const ColourSamples& samples) {
  const LitSamples lit = lit_samples(power, samples);
  const ColourAppearance appearance(lit.white);
  std::vector<Eigen::Vector3d> colours;
  for (const Eigen::Vector3d& sample : lit.samples) colours.push_back(appearance.uniform(sample));
  return colours;
}

SpectralPower scaled_power(SpectralPower power, double factor) {
  for (double& watts : power.watts) watts *= factor;
  return power;
}

// Y of the 1964 observer of a light on white.
double white_of(const SpectralPower& power) {
  double sum = 0.0;
  for_each_visible_interval(power, [&](double low, double high, double watts) {
    sum += watts * matching_10(low, high).y();
  });
  return sum;
}

SpectralPower reference_of(double kelvin) {
  constexpr double last_black_body = 4000.0, first_daylight = 5000.0;
  if (kelvin <= last_black_body) return black_body_power(kelvin);
  const SpectralPower day = daylight_illuminant(kelvin);
  if (kelvin >= first_daylight) return day;
  const double share = (kelvin - last_black_body) / (first_daylight - last_black_body);
  const SpectralPower body = black_body_power(kelvin);
  SpectralPower mixed = scaled_power(body, (1.0 - share) / white_of(body));
  const double of_day = share / white_of(day);
  for (std::size_t k = 0; k < mixed.watts.size(); ++k) mixed.watts[k] += of_day * day.watts[k];
  return mixed;
}

// Area of the polygon of the mean colours in bins of hue, by the hues below the reference.
double gamut_area(const std::vector<Eigen::Vector3d>& colours,
                  const std::vector<Eigen::Vector3d>& reference) {
  constexpr int bins = 16;
  std::array<Eigen::Vector2d, bins> sums;
  std::array<int, bins> counts{};
  sums.fill(Eigen::Vector2d::Zero());
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const double turn = std::atan2(reference[i][2], reference[i][1]) / (2.0 * std::numbers::pi);
    const int bin = std::min(bins - 1, static_cast<int>((turn - std::floor(turn)) * bins));
    sums[static_cast<std::size_t>(bin)] += colours[i].tail<2>();
    ++counts[static_cast<std::size_t>(bin)];
  }
  std::vector<Eigen::Vector2d> corners;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    if (counts[bin] > 0) corners.emplace_back(sums[bin] / counts[bin]);
  }
  double area = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d &p = corners[i], &q = corners[(i + 1) % corners.size()];
    area += 0.5 * (p.x() * q.y() - p.y() * q.x());
  }
  return area;
}

// R_f and R_g without bounds.
std::optional<ColourFidelity> fidelity_of(const SpectralPower& power,
                                          const ColourSamples& samples) {
  const auto light = eye_light(power);
  if (!light || !light->colour_temperature || *light->colour_temperature > hottest_daylight) {
    return {};
  }
  const auto test = uniform_colours(power, samples);
  const auto reference = uniform_colours(reference_of(*light->colour_temperature), samples);
  double sum = 0.0;
  for (std::size_t i = 0; i < test.size(); ++i) sum += (test[i] - reference[i]).norm();
  const double raw = 100.0 - 6.73 * sum / static_cast<double>(test.size());
  const double area = gamut_area(reference, reference);
  return ColourFidelity{.fidelity = 10.0 * std::log1p(std::exp(raw / 10.0)),
                        .gamut = area > 0.0 ? 100.0 * gamut_area(test, reference) / area : 0.0};
}

}  // namespace

ColourSamples read_colour_samples(const std::filesystem::path& path) {
  const TextFile file(path);
  ColourSamples samples(sample_count);
  int last = 1;
  file.for_each_line([&](int line, std::string_view text) {
    last = line;
    if (trimmed(text).empty()) return;
    const auto fields = comma_fields(text);
    const auto nm = parse_finite(fields.front());
    if (!nm && samples.front().values.empty()) return;  // names
    if (fields.size() != sample_count + 1) {
      file.fail(line,
                fmt::format("has {} fields; a line needs a wavelength and the reflectances of "
                            "99 samples",
                            fields.size()));
    }
    const auto& known = samples.front().wavelengths_nm;
    if (!nm || (!known.empty() && !(*nm > known.back()))) {
      file.fail(line, "must begin with a wavelength in nm that rises from line to line");
    }
    for (std::size_t i = 0; i < sample_count; ++i) {
      const auto value = parse_finite(fields[i + 1]);
      if (!value || *value < 0.0 || *value > 1.0) {
        file.fail(line, fmt::format("'{}' is no reflectance from 0 to 1", excerpt(fields[i + 1])));
      }
      samples[i].wavelengths_nm.push_back(*nm);
      samples[i].values.push_back(*value);
    }
  });
  if (!covers(samples.front(), first_receptor_nm, last_receptor_nm)) {
    file.fail(last, "ends a table that does not reach from 380 to 780 nm");
  }
  return samples;
}

std::optional<ColourFidelity> colour_fidelity(const SpectralPower& power,
                                              const ColourSamples& samples) {
  auto rated = fidelity_of(power, samples);
  if (!rated) return {};
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const auto coarse = fidelity_of(in_wider_intervals(power), samples);
  rated->fidelity_within = coarse ? std::abs(coarse->fidelity - rated->fidelity) : unknown;
  rated->gamut_within = coarse ? std::abs(coarse->gamut - rated->gamut) : unknown;
  return rated;
}

}  // namespace lightwell
