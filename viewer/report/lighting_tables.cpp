#include "viewer/report/lighting_tables.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "viewer/report/plan_svg.h"

namespace lightwell {
namespace {

// The bound of the point with the given illuminance.
TableCell point_cell(const LuxField& field, double lux, Language language) {
  const double within = bound_at(field, lux);
  return {lux_text(lux, language),
          std::isfinite(within) ? "± " + lux_text(within, language) : std::string()};
}

// The mean and its bound; no bound without light, where nothing is known.
TableCell mean_cell(const LuxField& field, Language language) {
  TableCell cell{lux_text(field.mean, language)};
  if (field.mean > 0.0) cell.bound = "± " + lux_text(field.mean_within * field.mean, language);
  return cell;
}

std::vector<TableCell> field_cells(const MarkedText& name, const LuxField& field,
                                   Language language) {
  return {{name},
          mean_cell(field, language),
          point_cell(field, field.least, language),
          point_cell(field, field.greatest, language),
          {number_in(language, fmt::format("{:.2f}", field.uniformity))},
          {},
          {}};
}

/// A number, or a dash where it is not known.
std::string known_text(bool is_known, double value, Language language) {
  return is_known ? number_in(language, fmt::format("{:.1f}", value)) : "–";
}

}  // namespace

std::string lux_text(double lux, Language language) {
  return number_in(language, lux_text(lux));
}

std::string percent_text(double share, Language language) {
  return number_in(language, fmt::format("{:.1f}\u202f%", 100.0 * share));
}

const char* light_words(LightContent content, Language language) {
  return word_in(language, content == LightContent::electric   ? Word::electric_light
                           : content == LightContent::daylight ? Word::daylight
                                                               : Word::electric_and_daylight);
}

std::vector<NamedField> fields_of(const LightingReport& report, const CalculationSurface& surface,
                                  Language language) {
  if (report.content == LightContent::apart) {
    return {{word_in(language, Word::electric_light), *surface.electric},
            {word_in(language, Word::daylight), *surface.daylight},
            {word_in(language, Word::both), surface.field}};
  }
  return {{light_words(report.content, language), surface.field}};
}

DocumentTable illuminance_table(const LightingReport& report, Language language) {
  DocumentTable table{.title = word_in(language, Word::illuminance)};
  for (const Word head : {Word::calculation_surface, Word::mean_lux, Word::least_lux,
                          Word::greatest_lux, Word::uniformity, Word::area, Word::points}) {
    table.columns.push_back({word_in(language, head), head == Word::calculation_surface});
  }
  for (const CalculationSurface& surface : report.surfaces) {
    const MarkedText name = marked(surface.grid.name);
    const TableCell area{number_in(language, fmt::format("{:.2f}", surface.grid.area))};
    const TableCell points{fmt::format("{}", surface.grid.points.size())};
    const std::vector<NamedField> fields = fields_of(report, surface, language);
    const bool is_group = fields.size() > 1;
    if (is_group) {
      table.rows.push_back({{{name}, {}, {}, {}, {}, area, points}, RowKind::group});
    }
    for (const auto& [light, field] : fields) {
      TableRow row{field_cells(is_group ? light : name, field, language),
                   is_group ? RowKind::detail : RowKind::plain};
      if (!is_group) {
        row.cells[5] = area;
        row.cells[6] = points;
      }
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

DocumentTable power_table(const LightingReport& report, Language language) {
  DocumentTable table{.title = word_in(language, Word::power_density),
                      .columns = {{word_in(language, Word::calculation_surface), true},
                                  {word_in(language, Word::area)},
                                  {word_in(language, Word::watts_per_area)},
                                  {word_in(language, Word::per_hundred_lux)}}};
  bool is_known = true;
  for (const CalculationSurface& surface : report.surfaces) {
    const auto power = power_density(report, surface);
    if (!power) continue;
    is_known &= power->per_hundred_lux.has_value();
    const auto two_digits = [&](double value) {
      return number_in(language, fmt::format("{:.2f}", value));
    };
    table.rows.push_back({{{marked(surface.grid.name)},
                           {two_digits(surface.grid.area)},
                           {two_digits(power->watts_per_area)},
                           {power->per_hundred_lux ? two_digits(*power->per_hundred_lux) : "–"}}});
  }
  if (!is_known) table.notes.emplace_back(word_in(language, Word::per_hundred_lux_unknown));
  return table;
}

DocumentTable rating_table(const LightingReport& report, Language language) {
  DocumentTable table{.title = word_in(language, Word::unified_glare_rating),
                      .columns = {{word_in(language, Word::observer), true}, {"UGR"}}};
  for (const Observer& observer : report.observers) {
    table.rows.push_back(
        {{{marked(observer.name)},
          {observer.glare.ugr ? number_in(language, fmt::format("{:.1f}", *observer.glare.ugr))
                              : word_in(language, Word::none_in_sight)}}});
  }
  return table;
}

DocumentTable luminaire_table(const LightingReport& report, Language language) {
  DocumentTable table;
  for (const Word head :
       {Word::name, Word::luminaire, Word::number, Word::flux, Word::power, Word::efficacy}) {
    table.columns.push_back(
        {word_in(language, head), head == Word::name || head == Word::luminaire});
  }
  double flux = 0.0, watts = 0.0;
  bool all_known = true;
  for (const LuminaireRow& row : report.luminaires) {
    const bool is_known = row.watts > 0.0;
    flux += row.flux;
    watts += row.watts;
    all_known &= is_known;
    const auto file_name = [](const LuminaireFile& file) {
      return marked(file.name.empty() ? file.file.filename().string() : file.name);
    };
    table.rows.push_back({{{marked(row.name)},
                           {row.file ? file_name(*row.file) : MarkedText()},
                           {fmt::format("{}", row.count)},
                           {fmt::format("{:.0f}", row.flux)},
                           {known_text(is_known, row.watts, language)},
                           {known_text(is_known, row.flux / row.watts, language)}}});
  }
  table.rows.push_back({{{word_in(language, Word::all)},
                         {},
                         {},
                         {fmt::format("{:.0f}", flux)},
                         {known_text(all_known, watts, language)},
                         {known_text(all_known, flux / watts, language)}},
                        RowKind::total});
  return table;
}

DocumentTable observer_table(const LightingReport& report, Language language) {
  DocumentTable table{
      .columns = {{word_in(language, Word::observer), true},
                  {worded(language, Word::eye_at, {marked(report.unit_name)}), true},
                  {"UGR"},
                  {word_in(language, Word::background)}}};
  // A comma would be the decimal sign of other languages.
  const char* const between = language == Language::english ? ", " : "; ";
  int number = 0;
  for (const Observer& observer : report.observers) {
    const Eigen::Vector3d p = observer.eye.position / report.metres_per_unit;
    const std::string at = fmt::format("{1:.4g}{0}{2:.4g}{0}{3:.4g}", between, p.x(), p.y(), p.z());
    table.rows.push_back(
        {{{fmt::format("{} {}", ++number, marked(observer.name))},
          {number_in(language, at)},
          {observer.glare.ugr ? number_in(language, fmt::format("{:.1f}", *observer.glare.ugr))
                              : word_in(language, Word::none_in_sight)},
          {number_in(language, fmt::format("{:.4g}", observer.glare.background))}}});
  }
  return table;
}

DocumentTable source_table(const Observer& observer, Language language) {
  DocumentTable table{.title = worded(language, Word::in_sight_of, {marked(observer.name)}),
                      .columns = {{word_in(language, Word::luminaire), true},
                                  {word_in(language, Word::luminance)},
                                  {word_in(language, Word::solid_angle)},
                                  {"p"},
                                  {word_in(language, Word::share)}}};
  double all = 0.0;
  for (const GlareSource& source : observer.glare.sources) all += source.share;
  for (const GlareSource& source : observer.glare.sources) {
    table.rows.push_back({{{marked(source.name)},
                           {fmt::format("{:.0f}", source.luminance)},
                           {number_in(language, fmt::format("{:.3g}", source.solid_angle))},
                           {number_in(language, fmt::format("{:.2f}", source.position_index))},
                           {percent_text(all > 0.0 ? source.share / all : 0.0, language)}}});
  }
  return table;
}

}  // namespace lightwell
