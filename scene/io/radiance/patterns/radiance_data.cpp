#include "scene/io/radiance/patterns/radiance_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "scene/io/radiance/text/radiance_text.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

constexpr int most_dimensions = 10;
constexpr std::size_t most_values = 10'000'000;

double number_of(RadianceText& text, const char* what) {
  const std::string_view word = text.next_word();
  const auto value = parse_finite(word);
  if (!value) {
    text.location().fail(word.empty()
                             ? fmt::format("the table ends where {} is needed", what)
                             : fmt::format("the table has no number where {} is needed", what));
  }
  return *value;
}

std::size_t count_of(RadianceText& text, double least, double most, const char* what) {
  const double value = number_of(text, what);
  if (!(value >= least && value <= most) || value != std::floor(value)) {
    text.location().fail(
        fmt::format("{} is {}; a whole number from {} to {} is needed", what, value, least, most));
  }
  return static_cast<std::size_t>(value);
}

std::vector<double> points_of(RadianceText& text) {
  const double begin = number_of(text, "the beginning of a coordinate");
  const double end = number_of(text, "the end of a coordinate");
  const std::size_t count =
      count_of(text, 2, static_cast<double>(most_values), "the number of points of a coordinate");
  std::vector<double> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back(begin == end ? number_of(text, "a point of a coordinate")
                                  : begin + (end - begin) * static_cast<double>(i) /
                                                static_cast<double>(count - 1));
  }
  return points;
}

}  // namespace

RadianceData::RadianceData(const std::filesystem::path& path) {
  const TextFile file(path);
  RadianceText text(file.text(), path);
  const std::size_t dimensions =
      count_of(text, 1, most_dimensions, "the number of coordinates of the table");
  std::size_t size = 1;
  for (std::size_t i = 0; i < dimensions; ++i) {
    Axis axis{.points = points_of(text)};
    if (axis.points.back() < axis.points.front()) axis.direction = -1.0;
    for (double& point : axis.points) point *= axis.direction;
    if (std::ranges::adjacent_find(axis.points, std::greater_equal<>()) != axis.points.end()) {
      text.location().fail("the points of a coordinate of the table neither rise nor fall");
    }
    size *= axis.points.size();
    if (size > most_values) {
      text.location().fail(fmt::format("the table has more than {} values", most_values));
    }
    axes_.push_back(std::move(axis));
  }
  for (std::size_t i = 0; i < size; ++i) values_.push_back(number_of(text, "a value"));
}

double RadianceData::at(std::span<const double> coordinates) const {
  return along(0, 0, coordinates);
}

// Value over the coordinates from `axis` on, of the part of the table that begins at value `first`.
double RadianceData::along(std::size_t axis, std::size_t first,
                           std::span<const double> coordinates) const {
  if (axis == axes_.size()) return values_[first];
  const auto& [points, direction] = axes_[axis];
  std::size_t stride = 1;
  for (std::size_t i = axis + 1; i < axes_.size(); ++i) stride *= axes_[i].points.size();
  const double x = coordinates[axis] * direction;
  const auto after = std::upper_bound(points.begin() + 1, points.end() - 1, x);
  const auto i = static_cast<std::size_t>(after - points.begin()) - 1;
  const double t = (x - points[i]) / (points[i + 1] - points[i]);
  const double low = along(axis + 1, first + i * stride, coordinates);
  const double high = along(axis + 1, first + (i + 1) * stride, coordinates);
  if (t > 2.0) return (2.0 * high - low) / (t - 1.0);
  if (t < -1.0) return (2.0 * low - high) / -t;
  return low + t * (high - low);
}

}  // namespace lightwell
