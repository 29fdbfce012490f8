#include "viewer/report/page.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <set>
#include <utility>

#include "viewer/export/page_data.h"
#include "viewer/report/page_frame.h"
#include "viewer/report/plan_svg.h"

namespace lightwell {
namespace {

std::string percent(double share) {
  return fmt::format("{:.1f}\u202f%", 100.0 * share);
}

// The bound of the point with the given illuminance, for a table.
std::string small_within(const LuxField& field, double lux) {
  const double within = bound_at(field, lux);
  return std::isfinite(within) ? fmt::format(" <small>± {}</small>", lux_text(within)) : "";
}

// The bound of the mean; none without light, where nothing is known.
std::string mean_within(const LuxField& field) {
  if (!(field.mean > 0.0)) return {};
  return fmt::format(" <small>± {}</small>", lux_text(field.mean_within * field.mean));
}

const char* light_words(LightContent content) {
  return content == LightContent::electric   ? "electric light"
         : content == LightContent::daylight ? "daylight"
                                             : "electric light and daylight";
}

void add_heading(const LightingReport& report, std::string& page) {
  const auto out = std::back_inserter(page);
  const ReportHeading& heading = report.heading;
  fmt::format_to(out, "<h1>{}</h1>\n<dl class=\"heading\">", html_text(report.title));
  for (const auto& [name, text] :
       {std::pair("Project", &heading.project), std::pair("Client", &heading.client),
        std::pair("Author", &heading.author), std::pair("Date", &heading.date),
        std::pair("Remarks", &heading.remarks)}) {
    if (!text->empty()) fmt::format_to(out, "<dt>{}</dt><dd>{}</dd>", name, html_text(*text));
  }
  const Provenance& made = report.provenance;
  fmt::format_to(out, "<dt>Computed with</dt><dd>Lightwell {} from {} ({:016x})</dd></dl>\n",
                 html_text(made.version),
                 html_text(std::filesystem::path(made.scene_file).filename().string()),
                 made.scene_hash);
  if (!report.picture) return;
  const ReportPicture& picture = *report.picture;
  fmt::format_to(out,
                 "<figure><img width=\"{}\" height=\"{}\" alt=\"\" "
                 "src=\"data:image/png;base64,{}\"><figcaption>View '{}', by {}.</figcaption>"
                 "</figure>\n",
                 picture.width, picture.height, base64(picture.png), html_text(picture.camera),
                 light_words(report.content));
}

std::string content_text(const LightingReport& report) {
  switch (report.content) {
    case LightContent::electric:
      return "All figures are of electric light: the scene has no daylight, or it is switched off.";
    case LightContent::daylight:
      return fmt::format("All figures are of daylight ({}): there is no electric light.",
                         html_text(report.sky));
    case LightContent::apart:
      return fmt::format(
          "Electric light and daylight ({}) were measured each by itself; 'both' is their sum.",
          html_text(report.sky));
    case LightContent::together:
      break;
  }
  return fmt::format(
      "<b>All figures contain electric light and daylight ({}) together</b>, since the solution "
      "does not keep them apart; the maintenance factor multiplies both. A solution by 'lightwell "
      "solve' without '--channels off' tells them apart.",
      html_text(report.sky));
}

struct NamedField {
  const char* name;
  const LuxField& field;
};

std::vector<NamedField> fields_of(const LightingReport& report, const CalculationSurface& surface) {
  if (report.content == LightContent::apart) {
    return {{"electric light", *surface.electric},
            {"daylight", *surface.daylight},
            {"both", surface.field}};
  }
  return {{light_words(report.content), surface.field}};
}

void add_table(const LightingReport& report, std::string& page) {
  const auto out = std::back_inserter(page);
  page +=
      "<table><thead><tr><th>calculation surface</th><th>E<sub>m</sub>, "
      "lx</th><th>E<sub>min</sub>, lx</th><th>E<sub>max</sub>, "
      "lx</th><th>U<sub>0</sub></th><th>points</th></tr></thead>\n";
  for (const CalculationSurface& surface : report.surfaces) {
    fmt::format_to(
        out,
        "<tbody><tr class=\"total\"><td>{}</td><td></td><td></td><td></td><td></td><td>{}"
        "</td></tr>\n",
        html_text(surface.grid.name), surface.grid.points.size());
    for (const auto& [name, field] : fields_of(report, surface)) {
      fmt::format_to(out,
                     "<tr class=\"kind\"><td>{}</td><td>{}{}</td><td>{}{}</td>"
                     "<td>{}{}</td><td>{:.2f}</td><td></td></tr>\n",
                     name, lux_text(field.mean), mean_within(field), lux_text(field.least),
                     small_within(field, field.least), lux_text(field.greatest),
                     small_within(field, field.greatest), field.uniformity);
    }
    page += "</tbody>";
  }
  page += "</table>\n";
}

std::string factor_text(const LightingReport& report) {
  if (report.content == LightContent::daylight) return {};
  return fmt::format(
      " Electric light is maintained: initial values times a maintenance factor of {:g}.{}",
      report.maintenance_factor,
      report.maintenance_factor == 1.0 ? " (New lamps; '--maintenance' sets another factor.)" : "");
}

void add_results(const LightingReport& report, std::string& page) {
  if (report.surfaces.empty()) return;
  const auto out = std::back_inserter(page);
  fmt::format_to(out,
                 "<h2>Illuminance</h2>\n<p>{}{} E<sub>m</sub> is the mean over the points of a "
                 "grid, U<sub>0</sub> = E<sub>min</sub>/E<sub>m</sub>. The ± beside a value is the "
                 "whole error, with odds of about 19 to 1.</p>\n",
                 content_text(report), factor_text(report));
  add_table(report, page);
  for (const CalculationSurface& surface : report.surfaces) {
    const auto power = power_density(report, surface);
    if (!power) continue;
    fmt::format_to(
        out, "<p>Installed power over {} ({:.1f} m²): {:.2f} W/m²{}.</p>\n",
        html_text(surface.grid.name), surface.grid.area, power->watts_per_area,
        power->per_hundred_lux
            ? fmt::format(", {:.2f} W/m² per 100 lx of electric light", *power->per_hundred_lux)
            : "; W/m² per 100 lx is not known, since electric light is not");
  }
}

void add_luminaires(const LightingReport& report, std::string& page) {
  const auto out = std::back_inserter(page);
  page += "<h2>Luminaires</h2>\n";
  if (report.luminaires.empty()) {
    page += "<p>No luminaires; the light is that of sky and sun.</p>\n";
    return;
  }
  page +=
      "<table><thead><tr><th>name</th><th class=\"text\">luminaire</th><th>number</th><th>flux, "
      "lm</th><th>power, W</th><th>lm/W</th></tr></thead>\n";
  double flux = 0.0, watts = 0.0;
  bool all_known = true;
  for (const LuminaireRow& row : report.luminaires) {
    flux += row.flux;
    watts += row.watts;
    all_known &= row.watts > 0.0;
    fmt::format_to(out,
                   "<tr><td>{}</td><td class=\"text\">{}</td><td>{}</td><td>{:.0f}</td><td>{}</td>"
                   "<td>{}</td></tr>\n",
                   html_text(row.name),
                   row.file ? html_text(row.file->name.empty() ? row.file->file.filename().string()
                                                               : row.file->name)
                            : "",
                   row.count, row.flux, row.watts > 0.0 ? fmt::format("{:.1f}", row.watts) : "–",
                   row.watts > 0.0 ? fmt::format("{:.1f}", row.flux / row.watts) : "–");
  }
  fmt::format_to(out,
                 "<tr class=\"total\"><td>all</td><td></td><td></td><td>{:.0f}</td><td>{}</td><td>"
                 "{}</td></tr></table>\n",
                 flux, all_known ? fmt::format("{:.1f}", watts) : "–",
                 all_known ? fmt::format("{:.1f}", flux / watts) : "–");
}

// Data of each photometric file, with its curve.
void add_schedule(const LightingReport& report, std::string& page) {
  const auto out = std::back_inserter(page);
  for (const LuminaireRow& row : report.luminaires) {
    if (!row.file) continue;
    const LuminaireFile& file = *row.file;
    fmt::format_to(out, "<div class=\"luminaire-card\">{}<div><h3>{}</h3><p>",
                   file.is_radiometric ? "" : polar_svg(file),
                   html_text(file.name.empty() ? row.name : file.name));
    if (!file.maker.empty()) fmt::format_to(out, "{}<br>", html_text(file.maker));
    fmt::format_to(out, "{} of '{}', {}<br>", row.count, html_text(row.name),
                   html_text(file.file.filename().string()));
    if (!file.is_radiometric) {
      fmt::format_to(out, "Flux of the table {:.0f} lm", file.flux());
      if (file.lamp_lumens > 0.0) {
        fmt::format_to(out, ", of its lamps by the label {:.0f} lm", file.lamp_lumens);
      }
      fmt::format_to(out, "; in this scene {:.0f} lm each<br>", row.flux / row.count);
    }
    if (row.watts > 0.0) fmt::format_to(out, "{:.1f} W each<br>", row.watts / row.count);
    const LampOpening& opening = file.opening;
    if (!opening.is_point()) {
      fmt::format_to(out, "Luminous opening {:.0f} mm × {:.0f} mm{}<br>", 1000.0 * opening.along_c0,
                     1000.0 * opening.along_c90, opening.is_round ? ", round" : "");
    }
    page +=
        "<small>Curve: cd per 1000 lm, C0–C180 solid, C90–C270 dashed</small></p></div></div>\n";
  }
}

void add_plans(const LightingReport& report, const std::optional<LuxRange>& range,
               std::string& page) {
  const auto out = std::back_inserter(page);
  int number = 0;
  for (const CalculationSurface& surface : report.surfaces) {
    const LuxGrid& grid = surface.grid;
    fmt::format_to(out, "<section class=\"surface\"><h2>{}</h2>\n<p>", html_text(grid.name));
    if (grid.options.height > 0.0) {
      fmt::format_to(out, "{:g} m above the surface. ", grid.options.height);
    }
    if (grid.options.margin > 0.0) {
      fmt::format_to(out, "Without a margin of {:g} m. ", grid.options.margin);
    }
    fmt::format_to(
        out,
        "{:.2f} m × {:.2f} m, a point every {:.2f} m × {:.2f} m. Walls are cut {:.2f} m off "
        "the {}; lines of equal illuminance in lx.</p>\n",
        grid.columns * grid.step_u, grid.rows * grid.step_v, grid.step_u, grid.step_v,
        surface.lines.cut_height + grid.options.height,
        grid.options.height > 0.0 ? "surface below" : "surface");
    for (const auto& [name, field] : fields_of(report, surface)) {
      const bool is_sum = report.content == LightContent::apart && &field == &surface.field;
      if (is_sum) continue;
      fmt::format_to(out,
                     "<figure><figcaption><b>{}</b>: E<sub>m</sub> {} lx, E<sub>min</sub> {} lx, "
                     "U<sub>0</sub> "
                     "{:.2f}</figcaption>\n{}</figure>\n",
                     name, lux_text(field.mean), lux_text(field.least), field.uniformity,
                     plan_svg({.surface = surface,
                               .field = field,
                               .range = range.value_or(plan_range(field)),
                               .number = ++number,
                               .north = north_in(report.north, grid),
                               .metres_per_unit = report.metres_per_unit,
                               .unit_name = report.unit_name}));
    }
    page += "</section>\n";
  }
}

void add_sources(const Observer& observer, std::string& page) {
  const auto out = std::back_inserter(page);
  if (observer.glare.sources.empty()) return;
  fmt::format_to(
      out,
      "<h3>Luminaires in sight of {}</h3>\n<table><tr><th>luminaire</th><th>luminance, cd/m²</th>"
      "<th>solid angle, sr</th><th>p</th><th>share</th></tr>\n",
      html_text(observer.name));
  double all = 0.0;
  for (const GlareSource& source : observer.glare.sources) all += source.share;
  for (const GlareSource& source : observer.glare.sources) {
    fmt::format_to(out,
                   "<tr><td>{}</td><td>{:.0f}</td><td>{:.3g}</td><td>{:.2f}</td><td>{}</td></tr>\n",
                   html_text(source.name), source.luminance, source.solid_angle,
                   source.position_index, percent(source.share / all));
  }
  page += "</table>\n";
}

void add_observers(const LightingReport& report, std::string& page) {
  if (report.observers.empty()) return;
  const auto out = std::back_inserter(page);
  fmt::format_to(
      out,
      "<h2>Glare</h2>\n<p>Unified glare rating by CIE 117, with new lamps{}. L<sub>b</sub> is the "
      "background luminance; p the position index. Numbers are those in the "
      "plans.</p>\n<table><tr><th>observer</th><th>eye at, {}</th><th>UGR</th><th>L<sub>b</sub>, "
      "cd/m²</th></tr>\n",
      report.content == LightContent::together ? " and daylight in the background"
      : report.content == LightContent::apart  ? " and without daylight"
                                               : "",
      report.unit_name);
  int number = 0;
  for (const Observer& observer : report.observers) {
    const Eigen::Vector3d p = observer.eye.position / report.metres_per_unit;
    fmt::format_to(
        out,
        "<tr><td>{} {}</td><td>{:.4g}, {:.4g}, {:.4g}</td><td>{}</td><td>{:.4g}</td>"
        "</tr>\n",
        ++number, html_text(observer.name), p.x(), p.y(), p.z(),
        observer.glare.ugr ? fmt::format("{:.1f}", *observer.glare.ugr) : "none in sight",
        observer.glare.background);
  }
  page += "</table>\n";
  for (const Observer& observer : report.observers) add_sources(observer, page);
  const std::vector<std::string>& lamps = report.observers.front().glare.left_out;
  for (const std::string& lamp : std::set<std::string>(lamps.begin(), lamps.end())) {
    fmt::format_to(out,
                   "<p>'{}' is a point without luminous area, for which there is no UGR.</p>\n",
                   html_text(lamp));
  }
}

void add_uncertainty(const LightingReport& report, std::string& page) {
  const auto out = std::back_inserter(page);
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
}

}  // namespace

const LuxField* electric_field(const LightingReport& report, const CalculationSurface& surface) {
  if (report.content == LightContent::apart) return &*surface.electric;
  return report.content == LightContent::electric ? &surface.field : nullptr;
}

std::optional<PowerDensity> power_density(const LightingReport& report,
                                          const CalculationSurface& surface) {
  double watts = 0.0;
  for (const LuminaireRow& row : report.luminaires) {
    if (!(row.watts > 0.0)) return {};
    watts += row.watts;
  }
  const bool is_working_plane = surface.grid.options.height > 0.0 && !surface.grid.is_of_area &&
                                !surface.grid.options.part &&
                                surface.grid.quantity == GridQuantity::planar;
  if (!(is_working_plane && watts > 0.0)) return {};
  PowerDensity density{.watts_per_area = watts / surface.grid.area};
  const LuxField* const electric = electric_field(report, surface);
  if (electric && electric->mean > 0.0) {
    density.per_hundred_lux = density.watts_per_area / (electric->mean / 100.0);
  }
  return density;
}

std::string lighting_page(const LightingReport& report, const std::optional<LuxRange>& range) {
  std::string page = page_begin(report.title);
  add_heading(report, page);
  add_results(report, page);
  add_luminaires(report, page);
  add_schedule(report, page);
  add_plans(report, range, page);
  add_observers(report, page);
  add_uncertainty(report, page);
  return page + page_end;
}

}  // namespace lightwell
