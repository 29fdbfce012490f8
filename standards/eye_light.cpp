#include "standards/eye_light.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/colour_matching.h"
#include "scene/spectrum_samples.h"
#include "standards/colour_rendering.h"

namespace lightwell {
namespace {

const std::vector<SpectrumSamples>& action_spectra() {
  static const auto spectra = spectra_of_table(standards_data::action_spectra);
  return spectra;
}

// E_alpha of each receptor, W/m^2.
std::array<double, receptor_count> alpha_opic(const SpectralPower& power) {
  std::array<double, receptor_count> sums{};
  for_each_visible_interval(power, [&](double low, double high, double watts) {
    for (std::size_t a = 0; a < sums.size(); ++a) {
      sums[a] += watts * mean(action_spectra()[a], low, high);
    }
  });
  return sums;
}

// E_alpha for each lux of D65, W/lm (CIE S 026:2018, table 2).
constexpr std::array<double, receptor_count> daylight_efficacies = {0.8173e-3, 1.4558e-3, 1.6289e-3,
                                                                    1.4497e-3, 1.3262e-3};

}  // namespace

const char* receptor_name(Receptor receptor) {
  constexpr std::array names = {"S-cone-opic", "M-cone-opic", "L-cone-opic", "rhodopic",
                                "melanopic"};
  return names[static_cast<std::size_t>(receptor)];
}

std::optional<SpectralPower> spectral_power(const Bands& bands, const Spectrum& values) {
  if (bands.wavelengths_nm.empty()) return {};
  // Bands are equally wide; a single band does not know its width.
  const auto& centre = bands.wavelengths_nm;
  if (centre.size() < 2) return {};
  const double width = centre[1] - centre[0];
  SpectralPower power;
  for (std::size_t k = 0; k < centre.size(); ++k) {
    power.edges_nm.push_back(centre[k] - 0.5 * width);
    power.watts.push_back(double{values[static_cast<Eigen::Index>(k)]});
  }
  power.edges_nm.push_back(centre.back() + 0.5 * width);
  return power;
}

std::optional<EyeLight> eye_light(const SpectralPower& power) {
  const Eigen::Vector3d xyz = tristimulus(power);
  if (!(xyz.sum() > 0.0) || !(xyz[1] > 0.0)) return {};
  EyeLight light{.lux = greatest_luminous_efficacy * xyz[1],
                 .alpha_opic = alpha_opic(power),
                 .x = xyz[0] / xyz.sum(),
                 .y = xyz[1] / xyz.sum()};
  for (std::size_t a = 0; a < light.alpha_opic.size(); ++a) {
    light.equivalent_daylight[a] = light.alpha_opic[a] / daylight_efficacies[a];
  }
  const NearestBlackBody nearest = nearest_black_body(uv_of(light.x, light.y));
  light.duv = nearest.duv;
  // CIE 15 defines no CCT farther away.
  constexpr double farthest = 0.05;
  if (std::abs(nearest.duv) > farthest || nearest.is_at_end) return light;
  light.colour_temperature = nearest.kelvin;
  light.colour_rendering = general_colour_rendering(power, nearest);
  return light;
}

SpectralPower in_wider_intervals(const SpectralPower& power) {
  SpectralPower wider{.edges_nm = {power.edges_nm.front()}};
  for (std::size_t k = 0; k < power.watts.size(); k += 2) {
    const std::size_t end = std::min(k + 2, power.watts.size());
    wider.edges_nm.push_back(power.edges_nm[end]);
    wider.watts.push_back(power.watts[k] + (end > k + 1 ? power.watts[k + 1] : 0.0));
  }
  return wider;
}

std::optional<RatedColour> rated_colour(const SpectralPower& power) {
  const auto light = eye_light(power);
  if (!light || !light->colour_rendering) return {};
  const auto coarse = eye_light(in_wider_intervals(power));
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  return RatedColour{.rendering = *light->colour_rendering,
                     .within = coarse && coarse->colour_rendering
                                   ? std::abs(*coarse->colour_rendering - *light->colour_rendering)
                                   : unknown};
}

}  // namespace lightwell
