#include "cli/lighting_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace lightwell {
namespace {

constexpr const char* page_head = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<meta name="generator" content="Lightwell"><title>{0}</title>
<style>
body {{ font: 15px/1.45 system-ui, sans-serif; color: #1b1b1b; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }}
h1 {{ font-size: 1.7rem; margin-bottom: 0; }} h2 {{ font-size: 1.2rem; margin-top: 2rem; }}
p, figcaption {{ color: #444; max-width: 50rem; }}
table {{ border-collapse: collapse; font-variant-numeric: tabular-nums; }}
th, td {{ padding: .25rem .9rem .25rem 0; text-align: right; border-bottom: 1px solid #ddd; }}
th:first-child, td:first-child {{ text-align: left; }} th {{ font-weight: 600; }}
small {{ color: #666; }} figure {{ margin: 1rem 0 2rem; break-inside: avoid; }} svg {{ max-width: 100%; height: auto; }}
@media print {{ body {{ margin: 0; max-width: none; font-size: 11px; }} * {{ print-color-adjust: exact; -webkit-print-color-adjust: exact; }} }}
</style></head><body>
<h1>{0}</h1>
)";

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    result += c == '<' ? "&lt;" : c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
  }
  return result;
}

std::string lux_text(double lux) {
  return lux >= 99.95   ? fmt::format("{:.0f}", lux)
         : lux >= 9.995 ? fmt::format("{:.1f}", lux)
                        : fmt::format("{:.2f}", lux);
}

std::string percent(double share) {
  return fmt::format("{:.1f}\u202f%", 100.0 * share);
}

// " ± 4.2" for a point whose bound is known.
std::string within_text(const LuxField& field, Eigen::Index point) {
  const double within = field.lux_within[point];
  return std::isfinite(within) ? " ± " + lux_text(within) : "";
}

// The bound of the point with the given illuminance, for a table.
std::string small_within(const LuxField& field, double lux) {
  Eigen::Index at = 0;
  (field.lux - lux).abs().minCoeff(&at);
  const std::string text = within_text(field, at);
  return text.empty() ? text : " <small>" + text + "</small>";
}

double place_of(double lux, const LuxRange& range) {
  if (range.is_even()) return lux / range.high;
  return lux > 0.0 ? std::log(lux / range.low) / std::log(range.high / range.low) : 0.0;
}

std::string hex_colour(double place) {
  const Eigen::Array3f c = 255.0f * false_color(static_cast<float>(place)) + 0.5f;
  return fmt::format("#{:02x}{:02x}{:02x}", static_cast<int>(c[0]), static_cast<int>(c[1]),
                     static_cast<int>(c[2]));
}

/// Scale of a plan's false colours: linear from 0 if the greatest illuminance is at most 20 times
/// the least, since a linear scale is easier to read; lux_range() otherwise.
LuxRange range_of(const LuxField& field) {
  constexpr double few_times = 20.0;
  if (field.greatest > few_times * std::max(field.least, 1e-30)) {
    return lux_range({field.lux.begin(), field.lux.end()});
  }
  const double power = std::pow(10.0, std::floor(std::log10(field.greatest)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * power >= field.greatest) return {.low = 0.0, .high = step * power};
  }
  return {.low = 0.0, .high = 10.0 * power};
}

/// Plan of the grid as SVG, v upwards, in false colours; illuminances are printed in cells that are
/// large enough.
std::string plan(const CalculationSurface& surface, const std::optional<LuxRange>& given) {
  constexpr double width = 760.0, tallest = 760.0, bar = 16.0, gap = 24.0, labels = 60.0;
  constexpr double room_for_text = 30.0;
  const LuxGrid& grid = surface.grid;
  const double across = grid.columns * grid.step_u, upwards = grid.rows * grid.step_v;
  const double scale = std::min(width / across, tallest / upwards);
  const double w = scale * grid.step_u, h = scale * grid.step_v;
  const double plan_width = scale * across, height = std::max(scale * upwards, 140.0);
  const LuxRange range = given.value_or(range_of(surface.field));
  std::string svg;
  const auto out = std::back_inserter(svg);
  fmt::format_to(out,
                 "<svg viewBox=\"-2 -12 {:.0f} {:.0f}\" width=\"{:.0f}\" role=\"img\" "
                 "font-family=\"system-ui, sans-serif\">\n",
                 plan_width + gap + bar + labels, height + 24.0, plan_width + gap + bar + labels);
  for (std::size_t i = 0; i < grid.cell.size(); ++i) {
    const int column = grid.cell[i] % grid.columns, row = grid.cell[i] / grid.columns;
    const double lux = surface.field.lux[static_cast<Eigen::Index>(i)];
    const double place = place_of(lux, range);
    const double x = w * column, y = h * (grid.rows - 1 - row);
    fmt::format_to(out,
                   "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" "
                   "fill=\"{}\"><title>{} lx{}</title></rect>\n",
                   x, y, w + 0.3, h + 0.3, hex_colour(place), lux_text(lux),
                   within_text(surface.field, static_cast<Eigen::Index>(i)));
    if (w < room_for_text || h < 0.5 * room_for_text) continue;
    fmt::format_to(out,
                   "<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"11\" text-anchor=\"middle\" "
                   "fill=\"{}\">{}</text>\n",
                   x + 0.5 * w, y + 0.5 * h + 4.0, place < 0.55 ? "#fff" : "#000", lux_text(lux));
  }
  const double left = plan_width + gap;
  constexpr int steps = 64;
  for (int i = 0; i < steps; ++i) {
    fmt::format_to(out,
                   "<rect x=\"{:.1f}\" y=\"{:.2f}\" width=\"{:.0f}\" height=\"{:.2f}\" "
                   "fill=\"{}\"/>\n",
                   left, height * (steps - 1 - i) / steps, bar, height / steps + 0.3,
                   hex_colour((i + 0.5) / steps));
  }
  for (const double value : scale_steps(range)) {
    fmt::format_to(out, "<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"12\">{:.6g} lx</text>\n",
                   left + bar + 5.0, height * (1.0 - place_of(value, range)) + 4.0, value);
  }
  return svg + "</svg>\n";
}

void add_luminaires(const LightingReport& report, std::string& page) {
  const auto out = std::back_inserter(page);
  page += "<h2>Luminaires</h2>\n";
  if (report.luminaires.empty()) {
    page += "<p>No luminaires; the light is that of sky and sun.</p>\n";
    return;
  }
  page +=
      "<table><tr><th>name</th><th>number</th><th>flux, lm</th><th>power, "
      "W</th><th>lm/W</th></tr>\n";
  double flux = 0.0, watts = 0.0;
  bool all_known = true;
  for (const LuminaireRow& row : report.luminaires) {
    flux += row.flux;
    watts += row.watts;
    all_known &= row.watts > 0.0;
    fmt::format_to(out, "<tr><td>{}</td><td>{}</td><td>{:.0f}</td><td>{}</td><td>{}</td></tr>\n",
                   escaped(row.name), row.count, row.flux,
                   row.watts > 0.0 ? fmt::format("{:.1f}", row.watts) : "–",
                   row.watts > 0.0 ? fmt::format("{:.1f}", row.flux / row.watts) : "–");
  }
  fmt::format_to(out,
                 "<tr><td>all</td><td></td><td>{:.0f}</td><td>{}</td><td>{}</td></tr></table>\n",
                 flux, all_known ? fmt::format("{:.1f}", watts) : "–",
                 all_known ? fmt::format("{:.1f}", flux / watts) : "–");
}

void add_surfaces(const LightingReport& report, const std::optional<LuxRange>& range,
                  std::string& page) {
  if (report.surfaces.empty()) return;
  const auto out = std::back_inserter(page);
  fmt::format_to(
      out,
      "<h2>Illuminance</h2>\n<p>Maintained values: initial ones times a maintenance "
      "factor of {:g}. E<sub>m</sub> is the mean over the points of a grid, U<sub>0</sub> = "
      "E<sub>min</sub>/E<sub>m</sub>.</p>\n",
      report.maintenance_factor);
  page +=
      "<table><tr><th>calculation surface</th><th>E<sub>m</sub>, lx</th><th>E<sub>min</sub>, "
      "lx</th><th>E<sub>max</sub>, lx</th><th>U<sub>0</sub></th><th>points</th></tr>\n";
  for (const auto& [grid, field] : report.surfaces) {
    fmt::format_to(
        out,
        "<tr><td>{}</td><td>{} <small>± {}</small></td><td>{}{}</td><td>{}{}</td><td>{:.2f}</td>"
        "<td>{}</td></tr>\n",
        escaped(grid.name), lux_text(field.mean), lux_text(field.mean_within * field.mean),
        lux_text(field.least), small_within(field, field.least), lux_text(field.greatest),
        small_within(field, field.greatest), field.uniformity, grid.points.size());
  }
  page += "</table>\n";
  for (const CalculationSurface& surface : report.surfaces) {
    if (const auto power = power_density(report, surface)) {
      fmt::format_to(out,
                     "<p>Installed power over {} ({:.1f} m²): {:.2f} W/m², {:.2f} W/m² per 100 "
                     "lx.</p>\n",
                     escaped(surface.grid.name), surface.grid.area, power->watts_per_area,
                     power->per_hundred_lux);
    }
  }
  for (const CalculationSurface& surface : report.surfaces) {
    const LuxGrid& grid = surface.grid;
    fmt::format_to(out, "<figure><figcaption><b>{}</b>", escaped(grid.name));
    if (grid.options.height > 0.0) {
      fmt::format_to(out, ", {:g} m above the surface", grid.options.height);
    }
    if (grid.options.margin > 0.0) {
      fmt::format_to(out, ", without a margin of {:g} m", grid.options.margin);
    }
    fmt::format_to(out, ": {:.2f} m × {:.2f} m, a point every {:.2f} m × {:.2f} m</figcaption>\n",
                   grid.columns * grid.step_u, grid.rows * grid.step_v, grid.step_u, grid.step_v);
    page += plan(surface, range) + "</figure>\n";
  }
}

void add_observers(const LightingReport& report, std::string& page) {
  if (report.observers.empty()) return;
  const auto out = std::back_inserter(page);
  page +=
      "<h2>Glare</h2>\n<p>Unified glare rating by CIE 117, with new lamps. L<sub>b</sub> is the "
      "background luminance; p the position index.</p>\n<table><tr><th>observer</th><th>UGR</th>"
      "<th>L<sub>b</sub>, cd/m²</th></tr>\n";
  for (const auto& [name, glare] : report.observers) {
    fmt::format_to(out, "<tr><td>{}</td><td>{}</td><td>{:.4g}</td></tr>\n", escaped(name),
                   glare.ugr ? fmt::format("{:.1f}", *glare.ugr) : "none in sight",
                   glare.background);
  }
  page += "</table>\n";
  for (const auto& [name, glare] : report.observers) {
    if (glare.sources.empty()) continue;
    fmt::format_to(
        out,
        "<h3>Luminaires in sight of {}</h3>\n<table><tr><th>luminaire</th><th>luminance, cd/m²</th>"
        "<th>solid angle, sr</th><th>p</th><th>share</th></tr>\n",
        escaped(name));
    double all = 0.0;
    for (const GlareSource& source : glare.sources) all += source.share;
    for (const GlareSource& source : glare.sources) {
      fmt::format_to(
          out, "<tr><td>{}</td><td>{:.0f}</td><td>{:.3g}</td><td>{:.2f}</td><td>{}</td></tr>\n",
          escaped(source.name), source.luminance, source.solid_angle, source.position_index,
          percent(source.share / all));
    }
    page += "</table>\n";
  }
  for (const std::string& lamp : report.observers.front().glare.left_out) {
    fmt::format_to(out,
                   "<p>'{}' is a point without luminous area, for which there is no UGR.</p>\n",
                   escaped(lamp));
  }
}

}  // namespace

std::optional<PowerDensity> power_density(const LightingReport& report,
                                          const CalculationSurface& surface) {
  double watts = 0.0;
  for (const LuminaireRow& row : report.luminaires) {
    if (!(row.watts > 0.0)) return {};
    watts += row.watts;
  }
  const bool is_working_plane = surface.grid.options.height > 0.0;
  if (!(is_working_plane && watts > 0.0 && surface.field.mean > 0.0)) return {};
  const double density = watts / surface.grid.area;
  return PowerDensity{density, density / (surface.field.mean / 100.0)};
}

std::string lighting_page(const LightingReport& report, const std::optional<LuxRange>& range) {
  const Provenance& made = report.provenance;
  std::string page = fmt::format(fmt::runtime(page_head), escaped(report.title));
  const auto out = std::back_inserter(page);
  fmt::format_to(out, "<p>Computed with Lightwell {} from {} ({:016x}).</p>\n",
                 escaped(made.version), escaped(made.scene_file), made.scene_hash);
  add_luminaires(report, page);
  add_surfaces(report, range, page);
  add_observers(report, page);
  page += "<h2>Uncertainty</h2>\n";
  if (!report.surfaces.empty()) {
    fmt::format_to(
        out,
        "<p>The light of each point was gathered by {} rays over the hemisphere, and by "
        "shadow rays to each lamp. The ± beside a value is a bound in lx with odds of "
        "about 19 to 1: the noise of this sampling, found from eight independent sets of "
        "rays, and the error of the reflected light that the rays read.</p>\n",
        report.rays);
  }
  if (report.error_estimate > 0.0) {
    fmt::format_to(out,
                   "<p>Reflected light is read from a solution whose estimated error at a single "
                   "point is {} of the mean irradiance (root mean square); each gather averages "
                   "over the errors of all points that its rays reach.</p>\n",
                   percent(report.error_estimate));
  }
  return page + "</body></html>\n";
}

}  // namespace lightwell
