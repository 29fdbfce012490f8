#include "viewer/report/colour_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace lightwell {

std::string hex_colour(double place) {
  const Eigen::Array3f c =
      255.0f * false_color(std::clamp(static_cast<float>(place), 0.0f, 1.0f)) + 0.5f;
  return fmt::format("#{:02x}{:02x}{:02x}", static_cast<int>(c[0]), static_cast<int>(c[1]),
                     static_cast<int>(c[2]));
}

std::string colour_scale_svg(const LuxRange& range, const std::string& unit,
                             const Eigen::Vector2d& corner, double height, Language language) {
  std::string svg;
  const auto out = std::back_inserter(svg);
  const double left = corner.x(), top = corner.y();
  constexpr int steps = 64;
  constexpr double bar = 4.0;  // mm
  for (int i = 0; i < steps; ++i) {
    fmt::format_to(out,
                   "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{}\" height=\"{:.2f}\" "
                   "fill=\"{}\"/>\n",
                   left, top + height * (steps - 1 - i) / steps, bar, height / steps + 0.05,
                   hex_colour((i + 0.5) / steps));
  }
  for (const double value : scale_steps(range)) {
    fmt::format_to(out, "<text x=\"{:.2f}\" y=\"{:.2f}\" class=\"axis right\">{} {}</text>\n",
                   left + bar + 1.2, top + height * (1.0 - place_on_scale(value, range)) + 0.8,
                   number_in(language, fmt::format("{:.6g}", value)), unit);
  }
  return svg;
}

}  // namespace lightwell
