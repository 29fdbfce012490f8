#include "viewer/report/plan_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <utility>

#include "raytrace/pictures/encode_png.h"
#include "raytrace/readings/isolux_lines.h"
#include "raytrace/readings/round_step.h"
#include "scene/photometric_web.h"
#include "viewer/export/page_data.h"
#include "viewer/report/colour_scale.h"

namespace lightwell {
namespace {

using Eigen::Vector2d;

/// Millimetres of paper of a plan: x to the right, y downwards.
struct Paper {
  const PlanLines& lines;
  double mm = 1.0;  ///< of paper for each metre

  double width() const { return mm * (lines.high.x() - lines.low.x()); }
  double height() const { return mm * (lines.high.y() - lines.low.y()); }
  Vector2d at(const Vector2d& p) const {
    return {mm * (p.x() - lines.low.x()), mm * (lines.high.y() - p.y())};
  }
};

// A number of the plan's texts.
std::string shown(const PlanContents& plan, std::string number) {
  return number_in(plan.language, std::move(number));
}

// Cells as one picture with a pixel each, for grids of so many points that a page of rectangles
// would be too large to open.
void add_cells_as_picture(const PlanContents& plan, const Paper& paper, std::string& svg) {
  const LuxGrid& grid = plan.surface.grid;
  std::vector<std::uint8_t> rgba(4 * static_cast<std::size_t>(grid.columns) *
                                 static_cast<std::size_t>(grid.rows));
  const std::vector<float> lux(plan.field.lux.begin(), plan.field.lux.end());
  const std::vector<std::uint8_t> colours = false_colors(lux, plan.range);
  for (std::size_t i = 0; i < grid.cell.size(); ++i) {
    const int column = grid.cell[i] % grid.columns, row = grid.cell[i] / grid.columns;
    const int pixel = (grid.rows - 1 - row) * grid.columns + column;
    std::copy_n(colours.begin() + static_cast<std::ptrdiff_t>(3 * i), 3,
                rgba.begin() + std::ptrdiff_t{4} * pixel);
    rgba[4 * static_cast<std::size_t>(pixel) + 3] = 255;
  }
  const Vector2d corner = paper.at({0.0, grid.step_v * grid.rows});
  fmt::format_to(std::back_inserter(svg),
                 "<image x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" "
                 "preserveAspectRatio=\"none\" style=\"image-rendering: pixelated\" "
                 "href=\"data:image/png;base64,{}\"/>\n",
                 corner.x(), corner.y(), paper.mm * grid.step_u * grid.columns,
                 paper.mm * grid.step_v * grid.rows,
                 base64(encode_png(grid.columns, grid.rows, rgba)));
}

void add_cells(const PlanContents& plan, const Paper& paper, std::string& svg) {
  const auto out = std::back_inserter(svg);
  const LuxGrid& grid = plan.surface.grid;
  const double w = paper.mm * grid.step_u, h = paper.mm * grid.step_v;
  constexpr double overlap = 0.05;  // mm; hides hairlines between cells
  for (std::size_t i = 0; i < grid.cell.size(); ++i) {
    const int column = grid.cell[i] % grid.columns, row = grid.cell[i] / grid.columns;
    const auto point = static_cast<Eigen::Index>(i);
    const double lux = plan.field.lux[point], within = plan.field.lux_within[point];
    const Vector2d corner = paper.at({grid.step_u * column, grid.step_v * (row + 1)});
    fmt::format_to(out,
                   "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" "
                   "fill=\"{}\"><title>{} {}{}</title></rect>\n",
                   corner.x(), corner.y(), w + overlap, h + overlap,
                   hex_colour(place_on_scale(lux, plan.range)), shown(plan, lux_text(lux)),
                   plan.unit, std::isfinite(within) ? " ± " + shown(plan, lux_text(within)) : "");
  }
}

void add_values(const PlanContents& plan, const Paper& paper, std::string& svg) {
  const auto out = std::back_inserter(svg);
  const LuxGrid& grid = plan.surface.grid;
  constexpr double letters = 2.1, room_across = 6.5, room_up = 4.0;  // mm
  if (paper.mm * grid.step_u < room_across || paper.mm * grid.step_v < room_up) return;
  for (std::size_t i = 0; i < grid.cell.size(); ++i) {
    const int column = grid.cell[i] % grid.columns, row = grid.cell[i] / grid.columns;
    const double lux = plan.field.lux[static_cast<Eigen::Index>(i)];
    const Vector2d middle = paper.at({grid.step_u * (column + 0.5), grid.step_v * (row + 0.5)});
    constexpr double bright = 0.55;  // place on the scale above which black is easier to read
    fmt::format_to(out, "<text x=\"{:.2f}\" y=\"{:.2f}\" class=\"value\" fill=\"{}\">{}</text>\n",
                   middle.x(), middle.y() + 0.35 * letters,
                   place_on_scale(lux, plan.range) < bright ? "#fff" : "#000",
                   shown(plan, lux_text(lux)));
  }
}

void add_segments(const std::vector<PlanSegment>& segments, const char* kind, const Paper& paper,
                  std::string& svg) {
  if (segments.empty()) return;
  const auto out = std::back_inserter(svg);
  fmt::format_to(out, "<path class=\"{}\" d=\"", kind);
  for (const PlanSegment& segment : segments) {
    const Vector2d a = paper.at(segment.from), b = paper.at(segment.to);
    fmt::format_to(out, "M{:.2f} {:.2f}L{:.2f} {:.2f}", a.x(), a.y(), b.x(), b.y());
  }
  svg += "\"/>\n";
}

std::string path_of(const std::vector<Vector2d>& points, bool is_closed, const Paper& paper) {
  std::string d;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector2d at = paper.at(points[i]);
    fmt::format_to(std::back_inserter(d), "{}{:.2f} {:.2f}", i == 0 ? "M" : "L", at.x(), at.y());
  }
  return is_closed ? d + "Z" : d;
}

// Lines with a light border, so that they are seen on every colour; labels stand in the middle of
// lines that are long enough.
void add_isolines(const PlanContents& plan, const Paper& paper, std::string& svg) {
  const auto out = std::back_inserter(svg);
  constexpr double long_enough = 14.0;  // mm
  std::string labels;
  for (const double value : isolux_values(plan.field.least, plan.field.greatest)) {
    for (const Isoline& line : isolux_lines(plan.surface.grid, plan.field.lux, value)) {
      const std::string d = path_of(line.points, line.is_closed, paper);
      fmt::format_to(out, "<path class=\"iso-under\" d=\"{0}\"/><path class=\"iso\" d=\"{0}\"/>\n",
                     d);
      double length = 0.0;
      for (std::size_t i = 1; i < line.points.size(); ++i) {
        length += paper.mm * (line.points[i] - line.points[i - 1]).norm();
      }
      if (length < long_enough) continue;
      const Vector2d at = paper.at(line.points[line.points.size() / 2]);
      fmt::format_to(std::back_inserter(labels),
                     "<text x=\"{:.2f}\" y=\"{:.2f}\" class=\"label\">{}</text>\n", at.x(),
                     at.y() + 0.9, shown(plan, fmt::format("{:g}", value)));
    }
  }
  svg += labels;
}

// Labels go to `labels`, to be drawn over the values of points.
void add_luminaires(const PlanLines& lines, const Paper& paper, std::string& svg,
                    std::string& labels) {
  const auto out = std::back_inserter(svg);
  for (const PlanLuminaire& luminaire : lines.luminaires) {
    const Vector2d at = paper.at(luminaire.middle);
    std::string outlines;
    for (const auto& outline : luminaire.outlines) outlines += path_of(outline, true, paper);
    constexpr double arm = 1.0;  // mm
    fmt::format_to(out,
                   "<path class=\"luminaire\" d=\"{}\"/><path class=\"cross\" "
                   "d=\"M{:.2f} {:.2f}h{:.2f}M{:.2f} {:.2f}v{:.2f}\"/>\n",
                   outlines, at.x() - arm, at.y(), 2.0 * arm, at.x(), at.y() - arm, 2.0 * arm);
    if (luminaire.label.empty()) continue;
    constexpr double above = 1.6;  // mm
    labels +=
        fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" class=\"label\" fill=\"#d2380b\">{}</text>\n",
                    at.x(), at.y() - above, luminaire.label);
  }
}

void add_eyes(const PlanLines& lines, const Paper& paper, std::string& svg) {
  const auto out = std::back_inserter(svg);
  constexpr double radius = 1.8, reach = 5.0;  // mm
  for (const PlanEye& eye : lines.eyes) {
    const Vector2d at = paper.at(eye.position);
    const Vector2d to = at + reach * Vector2d(eye.direction.x(), -eye.direction.y());
    fmt::format_to(out,
                   "<path class=\"look\" d=\"M{:.2f} {:.2f}L{:.2f} {:.2f}\"/><circle class=\"eye\" "
                   "cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{}\"/><text x=\"{:.2f}\" y=\"{:.2f}\" "
                   "class=\"number\">{}</text>\n",
                   at.x(), at.y(), to.x(), to.y(), at.x(), at.y(), radius, at.x(), at.y() + 0.9,
                   eye.number);
  }
}

/// An axis of the scene that runs along an axis of the plan, or the distance from the corner.
struct PlanAxis {
  std::string name{};
  double offset = 0.0, sign = 1.0;  ///< value in metres = offset + sign * m along the plan's axis
};

PlanAxis axis_along(const Eigen::Vector3d& way, const LuxGrid& grid, Language language) {
  constexpr double parallel = 0.9999;
  constexpr std::array<const char*, 3> names = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) {
    if (std::abs(way[k]) < parallel) continue;
    return {names[static_cast<std::size_t>(k)], grid.corner[k], way[k] > 0.0 ? 1.0 : -1.0};
  }
  return {word_in(language, Word::along_surface)};
}

// Ticks with values below the plan and on its left.
void add_axes(const PlanContents& plan, const Paper& paper, std::string& svg) {
  const auto out = std::back_inserter(svg);
  const LuxGrid& grid = plan.surface.grid;
  constexpr double apart = 12.0, tick = 1.2;  // mm
  const double unit = plan.metres_per_unit;
  const double step = round_step(apart / paper.mm / unit) * unit;
  for (const bool is_across : {true, false}) {
    const PlanAxis axis = axis_along(is_across ? grid.u : grid.v, grid, plan.language);
    const int k = is_across ? 0 : 1;
    const double ends[2] = {axis.offset + axis.sign * paper.lines.low[k],
                            axis.offset + axis.sign * paper.lines.high[k]};
    const double first = std::min(ends[0], ends[1]), last = std::max(ends[0], ends[1]);
    for (double n = std::ceil(first / step); n * step <= last; n += 1.0) {
      const double along = axis.sign * (n * step - axis.offset);
      const std::string value =
          shown(plan, fmt::format("{:.6g}", n == 0.0 ? 0.0 : n * step / unit));
      if (is_across) {
        const double x = paper.at({along, 0.0}).x();
        fmt::format_to(out,
                       "<path class=\"tick\" d=\"M{0:.2f} {1:.2f}v{2}\"/><text x=\"{0:.2f}\" "
                       "y=\"{3:.2f}\" class=\"axis\">{4}</text>\n",
                       x, paper.height(), tick, paper.height() + 4.2, value);
      } else {
        const double y = paper.at({0.0, along}).y();
        fmt::format_to(out,
                       "<path class=\"tick\" d=\"M0 {0:.2f}h-{1}\"/><text x=\"-1.8\" y=\"{2:.2f}\" "
                       "class=\"axis left\">{3}</text>\n",
                       y, tick, y + 0.8, value);
      }
    }
    if (is_across) {
      fmt::format_to(out, "<text x=\"{:.2f}\" y=\"{:.2f}\" class=\"axis\">{}, {}</text>\n",
                     0.5 * paper.width(), paper.height() + 8.0, axis.name, plan.unit_name);
    } else {
      fmt::format_to(out,
                     "<text transform=\"translate(-8 {:.2f}) rotate(-90)\" class=\"axis\">{}, "
                     "{}</text>\n",
                     0.5 * paper.height(), axis.name, plan.unit_name);
    }
  }
}

// The scale of lengths: a bar of a round number of metres, and 1 : N.
void add_scale_bar(const PlanContents& plan, const Paper& paper, int scale, std::string& svg) {
  const auto out = std::back_inserter(svg);
  constexpr double wanted = 20.0;  // mm
  const double metres = round_step(wanted / paper.mm);
  const double y = paper.height() + 12.0, x = paper.width() - paper.mm * metres;
  fmt::format_to(out,
                 "<path class=\"bar\" d=\"M{:.2f} {:.2f}h{:.2f}\"/><text x=\"{:.2f}\" y=\"{:.2f}\" "
                 "class=\"axis\">{} m</text><text x=\"0\" y=\"{:.2f}\" class=\"axis scale\">1 : "
                 "{} {}</text>\n",
                 x, y, paper.mm * metres, x + 0.5 * paper.mm * metres, y + 3.6,
                 shown(plan, fmt::format("{:g}", metres)), y + 1.0, scale,
                 word_in(plan.language, Word::on_paper));
}

void add_north(const Vector2d& north, double x, std::string& svg) {
  const double turn = std::atan2(north.x(), north.y()) * 180.0 / std::numbers::pi;
  fmt::format_to(std::back_inserter(svg),
                 "<g transform=\"translate({:.2f} 6) rotate({:.1f})\"><path class=\"north\" "
                 "d=\"M0 -5L1.6 4L0 2.6L-1.6 4Z\"/><text y=\"-6\" class=\"axis\">N</text></g>\n",
                 x, turn);
}

}  // namespace

std::string lux_text(double lux) {
  return lux >= 99.95   ? fmt::format("{:.0f}", lux)
         : lux >= 9.995 ? fmt::format("{:.1f}", lux)
                        : fmt::format("{:.2f}", lux);
}

LuxRange plan_range(const LuxField& field) {
  constexpr double few_times = 20.0;
  if (field.greatest > few_times * std::max(field.least, 1e-30)) {
    return lux_range({field.lux.begin(), field.lux.end()});
  }
  if (!(field.greatest > 0.0)) return {.low = 0.0, .high = 1.0};
  constexpr double steps = 8.0;
  const double step = round_step(field.greatest / steps);
  return {.low = 0.0, .high = step * std::ceil(field.greatest / step)};
}

int plan_scale(const PlanLines& lines) {
  constexpr double most_across = 145.0, most_up = 165.0;  // mm, beside the colours on A4 paper
  const Vector2d size = lines.high - lines.low;
  const double least = 1000.0 * std::max(size.x() / most_across, size.y() / most_up);
  for (int power = 1; power < 1000000000; power *= 10) {
    for (const double step : {1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 7.5}) {
      const double scale = step * power;
      if (scale >= least && scale == std::floor(scale)) return static_cast<int>(scale);
    }
  }
  return 1000000000;
}

std::optional<Eigen::Vector2d> north_in(const std::optional<Eigen::Vector3d>& north,
                                        const LuxGrid& grid) {
  if (!north) return {};
  const Eigen::Vector2d flat(north->dot(grid.u), north->dot(grid.v));
  constexpr double level = 0.9;
  if (flat.norm() < level) return {};
  return flat.normalized();
}

std::string plan_svg(const PlanContents& plan) {
  const int scale = plan_scale(plan.surface.lines);
  const Paper paper{plan.surface.lines, 1000.0 / scale};
  constexpr double left = 11.0, top = 3.0, below = 17.0, beside = 27.0;  // mm
  const double height = std::max(paper.height(), 45.0);
  const double width = left + paper.width() + beside;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plan\" viewBox=\"-{} -{} {:.2f} {:.2f}\" "
      "width=\"{:.2f}mm\" role=\"img\">\n"
      "<clipPath id=\"area-{}\"><rect width=\"{:.2f}\" height=\"{:.2f}\"/></clipPath>"
      "<g clip-path=\"url(#area-{})\">\n",
      left, top, width, top + height + below, width, plan.number, paper.width(), paper.height(),
      plan.number);
  constexpr std::size_t most_rectangles = 5000;  // half a megabyte
  if (plan.surface.grid.cell.size() <= most_rectangles) {
    add_cells(plan, paper, svg);
  } else {
    add_cells_as_picture(plan, paper, svg);
  }
  add_segments(plan.surface.lines.edges, "edge", paper, svg);
  add_segments(plan.surface.lines.walls, "wall", paper, svg);
  add_segments(plan.surface.lines.panes, "pane", paper, svg);
  std::string labels;
  add_luminaires(plan.surface.lines, paper, svg, labels);
  add_values(plan, paper, svg);
  add_isolines(plan, paper, svg);
  svg += labels;
  add_eyes(plan.surface.lines, paper, svg);
  svg += "</g>\n";
  add_axes(plan, paper, svg);
  add_scale_bar(plan, paper, scale, svg);
  const double right = paper.width() + 5.0;
  constexpr double below_north = 17.0;
  if (plan.north) add_north(*plan.north, right + 2.0, svg);
  const double scale_top = plan.north ? below_north : 0.0;
  constexpr double least_height = 30.0;
  svg += colour_scale_svg(plan.range, plan.unit, {right, scale_top},
                          std::max(paper.height() - scale_top, least_height), plan.language);
  return svg + "</svg>\n";
}

std::string polar_svg(const LuminaireFile& luminaire, Language language) {
  const double flux = luminaire.flux();
  if (!luminaire.web || !(flux > 0.0)) return {};
  const double per_thousand = 1000.0 / flux;
  const double peak = per_thousand * luminaire.web->peak();
  const double ring = round_step(peak / 3.0);
  const double outer = ring * std::ceil(peak / ring);
  constexpr double radius = 20.0;  // mm
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"polar\" viewBox=\"-23 -23 46 46\" "
      "width=\"46mm\" role=\"img\">\n";
  const auto out = std::back_inserter(svg);
  for (double value = ring; value <= outer * (1.0 + 1e-9); value += ring) {
    fmt::format_to(out,
                   "<circle class=\"ring\" r=\"{:.2f}\"/><text x=\"0.4\" y=\"{:.2f}\" "
                   "class=\"axis right\">{}</text>\n",
                   radius * value / outer, radius * value / outer - 0.4,
                   number_in(language, fmt::format("{:g}", value)));
  }
  svg += "<path class=\"ring\" d=\"M-20 0H20M0 -20V20\"/>\n";
  for (const bool is_along : {true, false}) {
    std::string d;
    for (int degree = -180; degree <= 180; degree += 2) {
      const double gamma = degree * std::numbers::pi / 180.0;
      const double aside = std::sin(gamma), down = -std::cos(gamma);
      const Eigen::Vector3d way(is_along ? aside : 0.0, is_along ? 0.0 : aside, down);
      const double r = radius * per_thousand * luminaire.web->at(way) / outer;
      fmt::format_to(std::back_inserter(d), "{}{:.2f} {:.2f}", d.empty() ? "M" : "L", r * aside,
                     -r * down);
    }
    fmt::format_to(out, "<path class=\"{}\" d=\"{}\"/>\n", is_along ? "curve" : "curve across", d);
  }
  return svg + "</svg>\n";
}

}  // namespace lightwell
