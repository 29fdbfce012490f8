#include "viewer/report/road_drawings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "viewer/document/document.h"
#include "viewer/report/plan_svg.h"

namespace lightwell {
namespace {

using Eigen::Vector2d;

constexpr double luminaire_length = 0.7, luminaire_width = 0.3;  // m, drawn where none is known

// Masts of a row, m along y.
double mast_of(const Road& road, const LuminaireRowPlace& row) {
  if (road.luminaires.arrangement == RoadArrangement::median) {
    const double middle = 0.5 * road.median;
    return road.drives_on_left ? -middle : road.width + middle;
  }
  constexpr double set_back = 0.5;  // m from the edge to masts, as drawn
  const double behind = std::min(-set_back, road.luminaires.overhang);
  return row.facing > 0.0 ? behind : road.width - behind;
}

/// Lines along the road, m along y: edges of carriageways and strips, and between lanes.
struct RoadEdges {
  std::vector<double> edges{}, lanes{};
};

RoadEdges edges_of(const Road& road) {
  RoadEdges found;
  const auto add_carriageway = [&](double right) {
    found.edges.insert(found.edges.end(), {right, right + road.width});
    for (int lane = 1; lane < road.lanes; ++lane) {
      found.lanes.push_back(right + lane * road.lane_width());
    }
  };
  add_carriageway(0.0);
  if (road.median > 0.0) {
    const double apart = road.width + road.median;
    add_carriageway(road.drives_on_left ? -apart : apart);
  }
  for (const RoadStrip& strip : road.strips) {
    const double right = right_edge(road, strip);
    found.edges.insert(found.edges.end(), {right, right + strip.width});
  }
  return found;
}

void add_dashes(double y, double length, PlanLines& lines) {
  constexpr double dash = 1.5, gap = 1.5;  // m
  for (double x = 0.0; x < length; x += dash + gap) {
    lines.edges.push_back({{x, y}, {std::min(length, x + dash), y}});
  }
}

PlanLines lines_of(const Road& road, const LuxGrid& grid) {
  constexpr double border = 1.0;  // m
  const double length = grid.columns * grid.step_u, width = grid.rows * grid.step_v;
  PlanLines lines{.low = {-border, -border}, .high = {length + border, width + border}};
  const auto shown = [&](double y) { return y >= lines.low.y() && y <= lines.high.y(); };
  const RoadEdges found = edges_of(road);
  for (const double edge : found.edges) {
    const double y = edge - grid.corner.y();
    if (shown(y)) lines.walls.push_back({{0.0, y}, {length, y}});
  }
  for (const double lane : found.lanes) {
    const double y = lane - grid.corner.y();
    if (shown(y)) add_dashes(y, length, lines);
  }
  for (const LuminaireRowPlace& row : luminaire_rows(road)) {
    for (double x = row.first; x <= length + 1e-9; x += road.luminaires.spacing) {
      const Vector2d at(x, row.y - grid.corner.y());
      if (!shown(at.y())) continue;
      const Vector2d u(0.5 * luminaire_width, 0.0), v(0.0, 0.5 * luminaire_length);
      lines.luminaires.push_back({{{at - u - v, at + u - v, at + u + v, at - u + v}}, at});
    }
  }
  return lines;
}

/// Millimetres of paper of a cross-section: y of the road to the left, heights upwards.
struct SectionPaper {
  double left = 0.0, mm = 1.0;  ///< m along y at the left end; mm for each metre

  double x(double y) const { return mm * (left - y); }
};

void add_measure(const SectionPaper& paper, double from, double to, double below,
                 const std::string& text, std::string& svg) {
  const double a = paper.x(to), b = paper.x(from);
  fmt::format_to(std::back_inserter(svg),
                 "<path class=\"tick\" d=\"M{0:.2f} {2:.2f}H{1:.2f}M{0:.2f} {3:.2f}v2M{1:.2f} "
                 "{3:.2f}v2\"/><text x=\"{4:.2f}\" y=\"{5:.2f}\" class=\"axis\">{6}</text>\n",
                 a, b, below, below - 1.0, 0.5 * (a + b), below + 3.4, text);
}

void add_masts(const Road& road, const SectionPaper& paper, std::string& svg) {
  const double height = road.luminaires.height, tilt = road.luminaires.tilt;
  for (const LuminaireRowPlace& row : luminaire_rows(road)) {
    const double x = paper.x(row.y), y = -paper.mm * height, mast = paper.x(mast_of(road, row));
    const double half = 0.5 * luminaire_length * paper.mm;
    fmt::format_to(std::back_inserter(svg),
                   "<path class=\"edge\" d=\"M{0:.2f} 0V{1:.2f}L{2:.2f} {1:.2f}\"/>"
                   "<g transform=\"translate({2:.2f} {1:.2f}) rotate({3:.2f})\"><path "
                   "class=\"luminaire\" d=\"M{4:.2f} -1H{5:.2f}V0H{4:.2f}Z\"/></g>\n",
                   mast, y, x, row.facing * tilt, -half, half);
  }
}

}  // namespace

std::string road_plan_svg(const Road& road, const RoadField& values, const std::string& unit,
                          int number) {
  const CalculationSurface surface{
      .grid = values.grid, .field = values.field, .lines = lines_of(road, values.grid)};
  return plan_svg({.surface = surface,
                   .field = surface.field,
                   .range = plan_range(surface.field),
                   .number = number,
                   .unit = unit});
}

std::string road_section_svg(const Road& road) {
  const RoadEdges found = edges_of(road);
  constexpr double border = 2.0, most_across = 165.0, most_up = 70.0;  // m; mm of paper
  double low = *std::ranges::min_element(found.edges) - border;
  double high = *std::ranges::max_element(found.edges) + border;
  for (const LuminaireRowPlace& row : luminaire_rows(road)) {
    const double mast = mast_of(road, row);
    low = std::min({low, row.y - border, mast - border});
    high = std::max({high, row.y + border, mast + border});
  }
  const double top = road.luminaires.height + border;
  const SectionPaper paper{high, std::min(most_across / (high - low), most_up / top)};
  const double width = paper.mm * (high - low), below = 28.0;  // mm
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plan\" viewBox=\"0 {:.2f} {:.2f} {:.2f}\" "
      "width=\"{:.2f}mm\" role=\"img\">\n<path class=\"edge\" d=\"M0 0H{:.2f}\"/>\n",
      -paper.mm * top, width, paper.mm * top + below, width, width);
  const auto add_carriageway = [&](double right, const std::string& text) {
    fmt::format_to(std::back_inserter(svg), "<path class=\"wall\" d=\"M{:.2f} 0H{:.2f}\"/>\n",
                   paper.x(right + road.width), paper.x(right));
    add_measure(paper, right, right + road.width, 4.0, text, svg);
  };
  add_carriageway(
      0.0, fmt::format("{:g} m, {} lane{}", road.width, road.lanes, road.lanes == 1 ? "" : "s"));
  if (road.median > 0.0) {
    const double side = road.drives_on_left ? -1.0 : 1.0;
    add_carriageway(side * (road.width + road.median), fmt::format("{:g} m", road.width));
    const double right = road.drives_on_left ? -road.median : road.width;
    add_measure(paper, right, right + road.median, 12.0, fmt::format("median {:g} m", road.median),
                svg);
  }
  for (const double lane : found.lanes) {
    fmt::format_to(std::back_inserter(svg), "<path class=\"tick\" d=\"M{:.2f} 0v-1.5\"/>\n",
                   paper.x(lane));
  }
  for (const RoadStrip& strip : road.strips) {
    const double right = right_edge(road, strip);
    // The measure of the median is in the way of its strips.
    const double down = road.has_median_at(strip.is_left) ? 19.0 : 12.0;
    add_measure(paper, right, right + strip.width, down,
                fmt::format("{} {:g} m", marked(strip.name), strip.width), svg);
  }
  add_masts(road, paper, svg);
  const LuminaireRowPlace first = luminaire_rows(road).front();
  fmt::format_to(std::back_inserter(svg),
                 "<text x=\"{:.2f}\" y=\"{:.2f}\" class=\"axis\">{:g} m high, tilt {:g}°, overhang "
                 "{:g} m</text>\n",
                 std::clamp(paper.x(first.y), 30.0, width - 30.0),
                 -paper.mm * road.luminaires.height - 3.0, road.luminaires.height,
                 road.luminaires.tilt, road.luminaires.overhang);
  return svg + "</svg>\n";
}

}  // namespace lightwell
