#include "viewer/report/standard_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "viewer/report/figures.h"
#include "viewer/report/lighting_tables.h"

namespace lightwell {
namespace {

// Names in the order of Figure.
MarkedText marked_symbol(Figure figure) {
  constexpr std::array names = {"E<sub>m</sub>, lx",
                                "E<sub>min</sub>, lx",
                                "U<sub>0</sub>",
                                "E<sub>max</sub>/E<sub>min</sub>",
                                "E<sub>m,z</sub>, lx",
                                "E<sub>m,z</sub>/E<sub>m</sub>",
                                "R<sub>UG</sub>",
                                "L<sub>m</sub>, cd/m²",
                                "U<sub>o</sub>",
                                "U<sub>o,wet</sub>",
                                "U<sub>l</sub>",
                                "f<sub>TI</sub>, %",
                                "R<sub>EI</sub>",
                                "E<sub>v,min</sub>, lx",
                                "E<sub>sc,min</sub>, lx",
                                "E<sub>v,m</sub>, lx",
                                "E<sub>v,min</sub>/E<sub>v,m</sub>",
                                "E<sub>v,min</sub>/E<sub>v,max</sub>",
                                "gradient, %",
                                "R<sub>G</sub>",
                                "R<sub>a</sub>"};
  return names[static_cast<std::size_t>(figure)];
}

const char* verdict_word(Verdict verdict, Language language) {
  switch (verdict) {
    case Verdict::met:
      return word_in(language, Word::met);
    case Verdict::missed:
      return word_in(language, Word::missed);
    case Verdict::too_close:
      break;
  }
  return word_in(language, Word::too_close);
}

TableRow requirement_row(const Requirement& requirement, Language language) {
  const auto number = [&](double value) {
    return number_in(language, figure_text(requirement.figure, value));
  };
  MarkedText verdict = verdict_word(verdict_of(requirement), language);
  if (requirement.is_recommended) {
    verdict += fmt::format(" ({})", word_in(language, Word::recommended));
  }
  TableCell value{"–"};
  if (requirement.value) {
    if (!std::isnan(*requirement.value)) {
      value = {std::isfinite(*requirement.value) ? number(*requirement.value) : "∞"};
    }
    if (requirement.within > 0.0) {
      value.bound = number_in(language, fmt::format("± {:.2g}", requirement.within));
    }
  }
  return {{{marked_symbol(requirement.figure)},
           {marked(requirement.place)},
           std::move(value),
           {(requirement.is_upper ? "≤ " : "≥ ") + number(requirement.limit)},
           {std::move(verdict)}}};
}

}  // namespace

std::vector<DocumentTable> requirement_tables(std::span<const Requirement> requirements,
                                              Language language) {
  std::vector<DocumentTable> tables;
  for (const auto& of_area : by_area(requirements)) {
    DocumentTable table{.title = fmt::format("{}: {}", marked(of_area.front().area),
                                             verdict_word(verdict_of(of_area), language)),
                        .columns = {{word_in(language, Word::figure), true},
                                    {word_in(language, Word::calculation_surface), true},
                                    {word_in(language, Word::value)},
                                    {word_in(language, Word::limit), true},
                                    {word_in(language, Word::verdict), true}}};
    for (const Requirement& requirement : of_area) {
      table.rows.push_back(requirement_row(requirement, language));
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

DocumentTable eye_table(const LightingReport& report, Language language) {
  DocumentTable table{.columns = {{word_in(language, Word::observer), true},
                                  {"E<sub>v</sub>, lx"},
                                  {word_in(language, Word::melanopic_edi)},
                                  {"DER"},
                                  {"CCT, K"},
                                  {"R<sub>a</sub>"}}};
  const bool has_fidelity = std::ranges::any_of(
      report.observers, [](const Observer& observer) { return observer.fidelity.has_value(); });
  if (has_fidelity) {
    table.columns.insert(table.columns.end(), {{"R<sub>f</sub>"}, {"R<sub>g</sub>"}});
  }
  const auto number = [&](const char* form, double value) {
    return TableCell{number_in(language, fmt::format(fmt::runtime(form), value))};
  };
  for (const Observer& observer : report.observers) {
    TableRow row{{{marked(observer.name)}, {lux_text(observer.lux, language)}}};
    if (std::isfinite(observer.lux_within)) {
      row.cells.back().bound = "± " + lux_text(observer.lux_within, language);
    }
    row.cells.resize(table.columns.size(), {"–"});
    if (observer.light) {
      const EyeLight& light = *observer.light;
      row.cells[2] = {lux_text(light.melanopic_ratio() * light.lux, language)};
      row.cells[3] = number("{:.2f}", light.melanopic_ratio());
      if (light.colour_temperature) row.cells[4] = number("{:.0f}", *light.colour_temperature);
      if (light.colour_rendering) row.cells[5] = number("{:.0f}", *light.colour_rendering);
    }
    if (observer.fidelity) {
      const auto index = [&](double value, double within) {
        TableCell cell = number("{:.0f}", value);
        if (std::isfinite(within))
          cell.bound = number_in(language, fmt::format("± {:.1g}", within));
        return cell;
      };
      row.cells[6] = index(observer.fidelity->fidelity, observer.fidelity->fidelity_within);
      row.cells[7] = index(observer.fidelity->gamut, observer.fidelity->gamut_within);
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

MarkedText energy_text(const LightingReport& report, Language language) {
  if (!report.energy) return {};
  const LightingEnergy& energy = *report.energy;
  return worded(language, Word::energy_of_year,
                {marked(energy.surface), number_in(language, fmt::format("{:.1f}", energy.area)),
                 number_in(language, fmt::format("{:.2f}", energy.indicator))});
}

}  // namespace lightwell
