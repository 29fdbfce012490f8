#include "viewer/export/false_color.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "raytrace/readings/round_step.h"

namespace lightwell {
namespace {

/// Even steps, each 1, 2 or 5 times a power of ten: at least two, at most five.
std::vector<double> even_steps(double high) {
  const double step = round_step(0.999 * high / 4.0);
  std::vector<double> steps;
  for (int i = 0; i * step <= 1.001 * high; ++i) steps.push_back(i * step);
  return steps;
}

}  // namespace

LuxRange lux_range(const std::vector<float>& lux) {
  std::vector<float> lit;
  for (const float value : lux) {
    if (value > 0.0f && std::isfinite(value)) lit.push_back(value);
  }
  if (lit.empty()) return {};
  std::sort(lit.begin(), lit.end());
  const double darkest = lit.front();
  const double brightest =
      lit[static_cast<std::size_t>(0.995 * static_cast<double>(lit.size() - 1))];
  LuxRange range;
  range.high = round_step(brightest);
  // 1, 2 and 5 times the powers of ten are also their own reciprocals times a power of ten.
  range.low = 1.0 / round_step(1.0 / std::max(darkest, range.high / 1000.0));
  if (!(range.low < range.high)) range.low = range.high / 10.0;
  return range;
}

std::vector<double> scale_steps(const LuxRange& range) {
  if (range.is_even()) return even_steps(range.high);
  std::vector<double> steps;
  const bool is_long = range.high > 100.0 * range.low;
  for (double power = std::pow(10.0, std::floor(std::log10(range.low))); power <= range.high;
       power *= 10.0) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double value = factor * power;
      const bool inside = value >= 0.999 * range.low && value <= 1.001 * range.high;
      const bool is_end = value <= 1.001 * range.low || value >= 0.999 * range.high;
      if (inside && (factor == 1.0 || is_end || !is_long)) steps.push_back(value);
    }
  }
  return steps;
}

double place_on_scale(double value, const LuxRange& range) {
  if (range.is_even()) return value / range.high;
  return value > 0.0 ? std::log(value / range.low) / std::log(range.high / range.low) : 0.0;
}

Eigen::Array3f false_color(float place) {
  // Lightness rises evenly from stop to stop.
  static const std::array<Eigen::Array3f, 6> stops = {
      Eigen::Array3f{0.16f, 0.05f, 0.36f}, Eigen::Array3f{0.16f, 0.29f, 0.60f},
      Eigen::Array3f{0.08f, 0.49f, 0.58f}, Eigen::Array3f{0.20f, 0.66f, 0.44f},
      Eigen::Array3f{0.63f, 0.81f, 0.27f}, Eigen::Array3f{1.00f, 0.93f, 0.33f}};
  const float x = std::clamp(place, 0.0f, 1.0f) * (stops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(x), stops.size() - 2);
  return stops[i] + (x - static_cast<float>(i)) * (stops[i + 1] - stops[i]);
}

std::vector<std::uint8_t> false_colors(const std::vector<float>& lux, const LuxRange& range) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * lux.size());
  for (const float value : lux) {
    for (const float c : false_color(static_cast<float>(place_on_scale(value, range)))) {
      bytes.push_back(static_cast<std::uint8_t>(255.0f * c + 0.5f));
    }
  }
  return bytes;
}

}  // namespace lightwell
