#include "viewer/report/heat_map.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <iterator>
#include <vector>

#include "raytrace/pictures/encode_png.h"
#include "scene/io/weather/weather_file.h"
#include "viewer/export/page_data.h"
#include "viewer/report/colour_scale.h"

namespace lightwell {
namespace {

constexpr int days_of_a_leap_year = 366;
constexpr double map_width = 146.0, map_height = 48.0;  // mm, of the map

constexpr std::array<const char*, 12> months = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};

// A pixel for each hour, as PNG.
std::string picture_of(std::span<const float> values, const LuxRange& range) {
  const int days = static_cast<int>(values.size()) / hours_a_day;
  const std::vector<std::uint8_t> colours = false_colors({values.begin(), values.end()}, range);
  std::vector<std::uint8_t> rgba;
  for (int row = hours_a_day - 1; row >= 0; --row) {
    for (int day = 0; day < days; ++day) {
      const std::size_t at = 3 * static_cast<std::size_t>(day * hours_a_day + row);
      rgba.insert(rgba.end(), {colours[at], colours[at + 1], colours[at + 2], 255});
    }
  }
  return encode_png(days, hours_a_day, rgba);
}

void add_axes(int days, std::string& svg) {
  const auto out = std::back_inserter(svg);
  const bool is_leap_year = days == days_of_a_leap_year;
  for (int m = 0; m < static_cast<int>(months.size()); ++m) {
    const double first = number_of({.month = m + 1, .day = 1}, is_leap_year) / double{hours_a_day};
    constexpr double middle = 15.0;  // days
    fmt::format_to(out,
                   "<path class=\"tick\" d=\"M{0:.2f} {1:.2f}v1.5\"/><text x=\"{2:.2f}\" "
                   "y=\"{3:.2f}\" class=\"axis\">{4}</text>\n",
                   first / days * map_width, map_height, (first + middle) / days * map_width,
                   map_height + 4.2, months[static_cast<std::size_t>(m)]);
  }
  constexpr int step = 6;
  for (int hour = 0; hour <= hours_a_day; hour += step) {
    const double y = map_height * (1.0 - static_cast<double>(hour) / hours_a_day);
    fmt::format_to(out,
                   "<path class=\"tick\" d=\"M-1.5 {0:.2f}h1.5\"/><text x=\"-2.2\" "
                   "y=\"{1:.2f}\" class=\"axis left\">{2} h</text>\n",
                   y, y + 1.0, hour);
  }
}

}  // namespace

std::string heat_map_svg(std::span<const float> values, const LuxRange& range,
                         const std::string& unit) {
  constexpr double left = 11.0, top = 3.0, beside = 27.0, below = 7.0;  // mm
  std::string svg = fmt::format(
      "<svg class=\"plan\" viewBox=\"-{} -{} {:.2f} {:.2f}\" width=\"{:.2f}mm\" role=\"img\">\n"
      "<image width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" "
      "style=\"image-rendering: pixelated\" href=\"data:image/png;base64,{}\"/>\n",
      left, top, left + map_width + beside, top + map_height + below, left + map_width + beside,
      map_width, map_height, base64(picture_of(values, range)));
  add_axes(static_cast<int>(values.size()) / hours_a_day, svg);
  constexpr double gap = 5.0;
  svg += colour_scale_svg(range, unit, {map_width + gap, 0.0}, map_height);
  return svg + "</svg>\n";
}

}  // namespace lightwell
