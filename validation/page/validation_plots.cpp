#include "validation/page/validation_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "viewer/export/page_data.h"

namespace lightwell {
namespace {

constexpr std::array<const char*, 4> line_colors = {"#1769c2", "#d2380b", "#2e7d32", "#7a1fa2"};

// The scale of shares: 1e-6 and below at the left, 10 and above at the right.
constexpr double least_power = -6.0, greatest_power = 1.0;

double share_place(double share, double left, double width) {
  const double power = std::clamp(std::log10(std::max(share, 1e-300)), least_power, greatest_power);
  return left + width * (power - least_power) / (greatest_power - least_power);
}

struct GroupRow {
  std::string name{};
  std::vector<const CaseResult*> cases{};
};

std::vector<GroupRow> rows_of_groups(const ValidationRun& run) {
  std::vector<GroupRow> rows;
  for (const CaseResult& one : run.results) {
    if (one.worst() == nullptr) continue;
    if (rows.empty() || rows.back().name != one.about.group) rows.push_back({one.about.group, {}});
    rows.back().cases.push_back(&one);
  }
  return rows;
}

struct PlotSeries {
  std::string name{};
  std::vector<const ComparedValue*> values{};
};

std::pair<std::string, std::string> parted_place(const std::string& place) {
  const std::size_t comma = place.find(", ");
  const bool is_point = !place.empty() && place.find('(') != std::string::npos;
  if (comma == std::string::npos || is_point) return {"", place};
  return {place.substr(0, comma), place.substr(comma + 2)};
}

// At most four lines, evenly among all.
std::vector<PlotSeries> plot_series(const CaseResult& result) {
  std::vector<PlotSeries> all;
  for (const ComparedValue& value : result.values) {
    const std::string name = parted_place(value.place).first;
    auto found = all.begin();
    while (found != all.end() && found->name != name) ++found;
    if (found == all.end()) found = all.insert(all.end(), {name, {}});
    found->values.push_back(&value);
  }
  if (all.size() <= line_colors.size()) return all;
  std::vector<PlotSeries> some;
  for (std::size_t i = 0; i < line_colors.size(); ++i) {
    some.push_back(all[i * (all.size() - 1) / (line_colors.size() - 1)]);
  }
  return some;
}

// Two panels: values above, and below them errors from -1 to 1 of the tolerance.
struct PlotFrame {
  double width = 170.0, height = 84.0, left = 16.0, top = 4.0, right = 6.0, bottom = 34.0;
  double strip_middle = 68.0, strip_half = 7.0;
  double least = 0.0, greatest = 1.0;
  std::size_t places = 1;

  double x(std::size_t i) const {
    const double share =
        places > 1 ? static_cast<double>(i) / static_cast<double>(places - 1) : 0.5;
    return left + share * (width - left - right);
  }
  double y(double value) const {
    return top + (height - top - bottom) * (greatest - value) / (greatest - least);
  }
  /// Place of a signed error, which ends a little beyond its tolerance.
  double y_of_error(const ComparedValue& value) const {
    constexpr double most = 1.3;
    const double share = std::min(value.share(), most);
    return strip_middle - strip_half * (value.computed < value.expected ? -share : share);
  }
};

// A step of 1, 2 or 5 times a power of ten that makes three to seven ticks.
double tick_step(double range) {
  const double power = std::pow(10.0, std::floor(std::log10(range)));
  for (const double step : {0.2, 0.5, 1.0}) {
    if (range / (step * power) <= 6.0) return step * power;
  }
  return 2.0 * power;
}

// The place without the words that all places of a line share.
std::string place_label(const std::string& place) {
  std::string label = parted_place(place).second;
  for (const std::string_view word : {"point ", "type ", "rho ", "x = "}) {
    if (label.starts_with(word)) label.erase(0, word.size());
  }
  if (label.ends_with(" m")) label.resize(label.size() - 2);
  constexpr std::size_t most = 12;
  return label.substr(0, most);
}

std::string axes_of(const PlotFrame& frame, const PlotSeries& first) {
  std::string svg;
  const double step = tick_step(frame.greatest - frame.least);
  for (double value = std::ceil(frame.least / step) * step; value <= frame.greatest;
       value += step) {
    const double shown = std::abs(value) < 1e-9 * step ? 0.0 : value;
    svg += fmt::format(
        "<path class='ring' d='M{:.2f} {:.2f}H{:.2f}'/><text class='axis left' x='{:.2f}' "
        "y='{:.2f}'>{:g}</text>",
        frame.left, frame.y(value), frame.width - frame.right, frame.left - 1.0,
        frame.y(value) + 1.0, shown);
  }
  for (const double share : {-1.0, 0.0, 1.0}) {
    const double y = frame.strip_middle - frame.strip_half * share;
    svg += fmt::format(
        "<path class='ring' style='{}' d='M{:.2f} {:.2f}H{:.2f}'/><text class='axis left' "
        "x='{:.2f}' y='{:.2f}'>{:g}</text>",
        share == 0.0 ? "" : "stroke:#d2380b", frame.left, y, frame.width - frame.right,
        frame.left - 1.0, y + 1.0, share);
  }
  std::vector<std::string> labels;
  std::size_t longest = 1;
  for (const ComparedValue* const value : first.values) {
    labels.push_back(place_label(value->place));
    longest = std::max(longest, labels.back().size());
  }
  // A character is about 1.7 wide; labels have gaps of two.
  const double room =
      (frame.width - frame.left - frame.right) / (1.7 * static_cast<double>(longest) + 3.4);
  const auto every =
      static_cast<std::size_t>(std::ceil(static_cast<double>(labels.size()) / std::max(1.0, room)));
  for (std::size_t i = 0; i < labels.size(); i += every) {
    svg += fmt::format("<text class='axis' x='{:.2f}' y='{:.2f}'>{}</text>", frame.x(i),
                       frame.height - frame.bottom + 4.0, html_text(labels[i]));
  }
  return svg;
}

std::string series_of(const PlotFrame& frame, const PlotSeries& series, const char* color) {
  std::string path, dots, errors;
  for (std::size_t i = 0; i < series.values.size(); ++i) {
    const ComparedValue& value = *series.values[i];
    path += fmt::format("{}{:.2f} {:.2f}", i == 0 ? "M" : "L", frame.x(i), frame.y(value.expected));
    dots += fmt::format(
        "<circle cx='{:.2f}' cy='{:.2f}' r='.8' fill='{}'><title>{}: expected {:.6g}, computed "
        "{:.6g}</title></circle>",
        frame.x(i), frame.y(value.computed), color, html_text(value.place), value.expected,
        value.computed);
    errors += fmt::format("<circle cx='{:.2f}' cy='{:.2f}' r='.6' fill='{}'/>", frame.x(i),
                          frame.y_of_error(value), color);
  }
  return fmt::format("<path d='{}' style='stroke:{};stroke-width:.3;fill:none'/>{}{}", path, color,
                     dots, errors);
}

}  // namespace

std::string share_plot(const ValidationRun& run) {
  const std::vector<GroupRow> rows = rows_of_groups(run);
  if (rows.empty()) return "";
  constexpr double width = 180.0, left = 32.0, row_height = 7.0, right = 6.0;
  const double span = width - left - right, height = row_height * static_cast<double>(rows.size());
  std::string svg =
      fmt::format("<svg class='plan' viewBox='0 0 {} {}' role='img'>", width, height + 10.0);
  for (double power = least_power; power <= greatest_power; power += 1.0) {
    const double x = share_place(std::pow(10.0, power), left, span);
    const char* const style = power == 0.0 ? "stroke:#d2380b;stroke-width:.5" : "";
    svg += fmt::format(
        "<path class='ring' style='{}' d='M{:.2f} 0V{:.2f}'/><text class='axis' x='{:.2f}' "
        "y='{:.2f}'>{:g}</text>",
        style, x, height, x, height + 4.0, std::pow(10.0, power));
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const double middle = row_height * (static_cast<double>(r) + 0.5);
    svg += fmt::format("<text class='axis left' x='{}' y='{:.2f}'>{}</text>", left - 2.0,
                       middle + 1.0, html_text(rows[r].name));
    for (std::size_t i = 0; i < rows[r].cases.size(); ++i) {
      const CaseResult& one = *rows[r].cases[i];
      // Dots of a row lie a little above each other, so that equal ones can be told apart.
      const double y = middle + 0.7 * (static_cast<double>(i % 7) - 3.0);
      svg += fmt::format(
          "<circle cx='{:.2f}' cy='{:.2f}' r='.75' fill='{}' fill-opacity='.75'><title>{}: error "
          "{:.2g} of the tolerance</title></circle>",
          share_place(one.worst()->share(), left, span), y,
          one.verdict == Verdict::passed ? "#1769c2" : "#d2380b", html_text(one.about.id),
          one.worst()->share());
    }
  }
  return svg + "</svg>";
}

std::string values_plot(const CaseResult& result) {
  constexpr std::size_t fewest = 5, most = 80;
  const std::vector<PlotSeries> series = plot_series(result);
  PlotFrame frame;
  frame.least = 0.0;
  frame.greatest = 0.0;
  for (const PlotSeries& one : series) {
    if (one.values.size() < fewest || one.values.size() > most) return "";
    frame.places = std::max(frame.places, one.values.size());
    for (const ComparedValue* const value : one.values) {
      if (!std::isfinite(value->computed)) return "";
      frame.least = std::min({frame.least, value->expected, value->computed});
      frame.greatest = std::max({frame.greatest, value->expected, value->computed});
    }
  }
  if (series.empty() || !(frame.greatest > frame.least)) return "";
  std::string svg =
      fmt::format("<svg class='plan' viewBox='0 0 {} {}' role='img'>", frame.width, frame.height);
  svg += axes_of(frame, series.front());
  for (std::size_t i = 0; i < series.size(); ++i) {
    svg += series_of(frame, series[i], line_colors[i]);
    if (series[i].name.empty()) continue;
    svg += fmt::format("<text class='axis scale' style='fill:{}' x='{:.2f}' y='{:.2f}'>{}</text>",
                       line_colors[i], frame.left + 36.0 * static_cast<double>(i),
                       frame.height - 1.5, html_text(series[i].name));
  }
  return svg + "</svg>";
}

}  // namespace lightwell
