#include "viewer/report/road_report.h"

#include <fmt/format.h>

#include <cctype>
#include <utility>

#include "scene/io/text_file.h"
#include "viewer/document/html_document.h"
#include "viewer/document/pdf_document.h"
#include "viewer/export/write_whole.h"
#include "viewer/report/figures.h"
#include "viewer/report/plan_svg.h"
#include "viewer/report/road_drawings.h"
#include "viewer/report/standard_tables.h"

namespace lightwell {
namespace {

using RoadJson = nlohmann::ordered_json;

std::string classes_text(const std::vector<RoadClass>& classes) {
  std::string text;
  for (const RoadClass& one : classes) text += (text.empty() ? "" : ", ") + one.key;
  return text.empty() ? "none" : text;
}

std::string ranges_text(const std::vector<SpacingRange>& ranges) {
  std::string text;
  for (const SpacingRange& range : ranges) {
    text +=
        fmt::format("{}{:.1f} to {:.1f} m", text.empty() ? "" : ", ", range.least, range.greatest);
  }
  return text;
}

std::string search_text(const RoadReport& report) {
  if (report.spacings.empty()) return "no spacing meets all classes";
  return fmt::format("greatest spacing that meets all classes: {:.1f} m (met from {})",
                     report.spacings.back().greatest, ranges_text(report.spacings));
}

std::string sentence_of(std::string text) {
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text + ".";
}

DocumentFacts road_facts(const Road& road) {
  const RoadLuminaires& luminaires = road.luminaires;
  DocumentFacts facts;
  const auto add = [&](const char* name, std::string text) {
    facts.facts.push_back({name, marked(text)});
  };
  add("Carriageway",
      fmt::format("{:g} m, {} lane{}{}, traffic keeps {}; classes: {}", road.width, road.lanes,
                  road.lanes == 1 ? "" : "s",
                  road.oncoming > 0 ? fmt::format(", {} oncoming", road.oncoming) : std::string(),
                  road.drives_on_left ? "left" : "right", classes_text(road.classes)));
  add("Road surface", fmt::format("{}, Q0 {:.3f} per sr, S1 {:.2f}", road.surface.name,
                                  road.surface.q0, specular_factor(road.surface)));
  if (road.median > 0.0) add("Median", fmt::format("{:g} m", road.median));
  for (const RoadStrip& strip : road.strips) {
    add("Strip", fmt::format("{}: {} side, {:g} m from the carriageway, {:g} m wide; classes: {}",
                             strip.name, strip.is_left ? "left" : "right", strip.gap, strip.width,
                             classes_text(strip.classes)));
  }
  const LuminaireFile& file = *luminaires.file;
  add("Luminaire", fmt::format("{}{}, {:.0f} lm{}", file.maker.empty() ? "" : file.maker + ", ",
                               file.name.empty() ? file.file.filename().string() : file.name,
                               luminaires.flux_factor * file.flux(),
                               luminaires.watts > 0.0 ? fmt::format(", {:g} W", luminaires.watts)
                                                      : std::string()));
  add("Arrangement",
      fmt::format(
          "{}, {:g} m apart in a row, {:g} m high, overhang {:g} m, tilt {:g}°, plane C{:g} "
          "to the road",
          arrangement_name(luminaires.arrangement), luminaires.spacing, luminaires.height,
          luminaires.overhang, luminaires.tilt, luminaires.street_side));
  add("Maintenance factor", fmt::format("{:g}", luminaires.maintenance));
  return facts;
}

DocumentTable road_observer_table(const RoadReport& report) {
  DocumentTable table{.title = "Drivers",
                      .columns = {{"Lane from the right", true},
                                  {"Eye x; y; z, m", true},
                                  {"L<sub>m</sub>, cd/m²"},
                                  {"U<sub>o</sub>"},
                                  {"U<sub>l</sub>"},
                                  {"f<sub>TI</sub>, %"},
                                  {"its eye x, m"}}};
  for (const RoadObserver& seen : report.figures.observers) {
    table.rows.push_back(
        {{{fmt::format("{}{}", seen.lane, seen.is_oncoming ? ", oncoming" : "")},
          {fmt::format("{:.1f}; {:.2f}; {:.1f}", seen.eye.x(), seen.eye.y(), seen.eye.z())},
          {fmt::format("{:.2f}", seen.luminance)},
          {fmt::format("{:.2f}", seen.uniformity)},
          {fmt::format("{:.2f}", seen.longitudinal_uniformity)},
          {fmt::format("{:.1f}", seen.threshold_increment)},
          {fmt::format("{:.1f}", seen.glare_eye_x)}}});
  }
  table.notes = {
      "x runs along the road from a luminaire of the first row, y to the left from the "
      "right edge of the carriageway, z upwards."};
  return table;
}

DocumentTable road_lux_table(const RoadReport& report) {
  DocumentTable table{.title = "Illuminance",
                      .columns = {{"Strip", true},
                                  {"E<sub>m</sub>, lx"},
                                  {"E<sub>min</sub>, lx"},
                                  {"E<sub>max</sub>, lx"},
                                  {"U<sub>0</sub>"},
                                  {"Points", true}}};
  for (const RoadField& strip : report.figures.illuminance) {
    table.rows.push_back({{{marked(strip.name)},
                           {lux_text(strip.field.mean)},
                           {lux_text(strip.field.least)},
                           {lux_text(strip.field.greatest)},
                           {fmt::format("{:.2f}", strip.field.uniformity)},
                           {fmt::format("{} × {}", strip.grid.columns, strip.grid.rows)}}});
  }
  for (const EdgeRatio& edge : report.figures.edges) {
    table.notes.push_back(fmt::format("Edge illuminance ratio R<sub>EI</sub>, {}: {:.2f}{}.",
                                      edge.is_left ? "left" : "right", edge.value,
                                      edge.is_required ? "" : ", not required there"));
  }
  return table;
}

DocumentSection road_results(const RoadReport& report) {
  DocumentSection section{.title = "Results", .begins_page = false};
  if (report.has_search) {
    section.blocks.emplace_back(DocumentParagraph{marked(sentence_of(search_text(report)))});
  }
  for (DocumentTable& table : requirement_tables(report.figures.requirements, Language::english)) {
    section.blocks.emplace_back(std::move(table));
  }
  section.blocks.emplace_back(road_observer_table(report));
  section.blocks.emplace_back(road_lux_table(report));
  const RoadFigures& figures = report.figures;
  if (figures.power_density) {
    MarkedText text = fmt::format("Power density D<sub>P</sub> = {:.4f} W/(lx·m²), {:.2f} kW/km",
                                  *figures.power_density, figures.watts_per_km / 1000.0);
    if (figures.energy) {
      text += fmt::format("; energy of a year D<sub>E</sub> = {:.2f} kWh/m²", *figures.energy);
    }
    section.blocks.emplace_back(DocumentParagraph{text + " (EN 13201-5)."});
  }
  return section;
}

DocumentSection road_plans(const RoadReport& report) {
  const RoadObserver& worst = report.figures.observers[report.figures.worst];
  return {.title = "Plans",
          .blocks = {
              DocumentDrawing{"Cross-section, looking along x.", road_section_svg(report.road)},
              DocumentDrawing{fmt::format("Maintained luminance of the carriageway in cd/m² "
                                          "for the driver of lane {}, who sees the least.",
                                          worst.lane),
                              road_plan_svg(report.road, report.figures.luminance, "cd/m²", 1)},
              DocumentDrawing{"Maintained horizontal illuminance of the ground in lx.",
                              road_plan_svg(report.road, illuminance_map(report.road), "lx", 2)}}};
}

DocumentSection road_basis(const RoadReport& report) {
  return {
      .title = "Basis",
      .blocks =
          {DocumentList{
               {"Classes: EN 13201-2:2015. Calculation: EN 13201-3:2015, of a straight, level road "
                "with rows of luminaires without end.",
                "Only light that comes straight from the luminaires counts, as the standard says; "
                "nothing shades and nothing reflects but the road.",
                "Reduced luminance coefficients are linear in tan(γ) and β between the entries of "
                "the table of the surface (CIE 144:2001), intensities in C and γ between those of "
                "the photometric file. Whether EN 13201-3 asks for another interpolation was not "
                "checked.",
                "Luminance: luminaires from 5 heights before a point to 12 beyond it. Illuminance: "
                "luminaires within 5 heights.",
                "f<sub>TI</sub> and the luminance in it are those of new luminaires, for drivers "
                "of "
                "23 years; luminaires up to 500 m ahead and below 20° count."}},
           DocumentFacts{{{"Program", "Lightwell " + marked(report.version)},
                          {"Road", marked(report.road.file.filename().string())},
                          {"Photometric file",
                           marked(report.road.luminaires.file->file.filename().string())}}}},
      .begins_page = false};
}

}  // namespace

Document road_document(const RoadReport& report) {
  return {.title = report.road.title,
          .footer = report.road.title,
          .head = road_facts(report.road),
          .sections = {road_results(report), road_plans(report), road_basis(report)}};
}

nlohmann::ordered_json road_json(const RoadReport& report) {
  const RoadFigures& figures = report.figures;
  RoadJson observers = RoadJson::array(), strips = RoadJson::array(), edges = RoadJson::array();
  for (const RoadObserver& seen : figures.observers) {
    observers.push_back({{"lane", seen.lane},
                         {"oncoming", seen.is_oncoming},
                         {"eye", {seen.eye.x(), seen.eye.y(), seen.eye.z()}},
                         {"luminance", seen.luminance},
                         {"uniformity", seen.uniformity},
                         {"longitudinal_uniformity", seen.longitudinal_uniformity},
                         {"threshold_increment", seen.threshold_increment},
                         {"glare_eye_x", seen.glare_eye_x}});
    if (seen.wet_uniformity) observers.back()["wet_uniformity"] = *seen.wet_uniformity;
  }
  for (const RoadField& strip : figures.illuminance) {
    strips.push_back({{"name", strip.name},
                      {"mean_lux", strip.field.mean},
                      {"least_lux", strip.field.least},
                      {"greatest_lux", strip.field.greatest},
                      {"uniformity", strip.field.uniformity}});
  }
  for (const EdgeRatio& edge : figures.edges) {
    edges.push_back({{"side", edge.is_left ? "left" : "right"},
                     {"ratio", edge.value},
                     {"required", edge.is_required}});
  }
  RoadJson json = {{"spacing", report.road.luminaires.spacing},
                   {"observers", std::move(observers)},
                   {"strips", std::move(strips)},
                   {"edges", std::move(edges)},
                   {"requirements", requirements_json(figures.requirements)},
                   {"verdict", verdict_name(verdict_of(figures.requirements))}};
  if (figures.watts_per_km > 0.0) json["watts_per_km"] = figures.watts_per_km;
  if (figures.power_density) json["power_density"] = *figures.power_density;
  if (figures.energy) json["energy_kWh_per_m2"] = *figures.energy;
  if (!report.has_search) return json;
  json["spacings"] = RoadJson::array();
  for (const SpacingRange& range : report.spacings) {
    json["spacings"].push_back({range.least, range.greatest});
  }
  return json;
}

std::string road_text(const RoadReport& report) {
  std::string text;
  if (report.has_search) text += search_text(report) + "\n";
  for (const RoadObserver& seen : report.figures.observers) {
    text += fmt::format("lane {}{}: L_m {:.2f} cd/m2, U_o {:.2f}, U_l {:.2f}, f_TI {:.1f} %\n",
                        seen.lane, seen.is_oncoming ? ", oncoming" : "", seen.luminance,
                        seen.uniformity, seen.longitudinal_uniformity, seen.threshold_increment);
  }
  for (const RoadField& strip : report.figures.illuminance) {
    text += fmt::format("{}: E_m {} lx, E_min {} lx, U_0 {:.2f}\n", strip.name,
                        lux_text(strip.field.mean), lux_text(strip.field.least),
                        strip.field.uniformity);
  }
  for (const EdgeRatio& edge : report.figures.edges) {
    text += fmt::format("{} edge: R_EI {:.2f}{}\n", edge.is_left ? "left" : "right", edge.value,
                        edge.is_required ? "" : " (not required)");
  }
  return text + verdicts_text(report.figures.requirements);
}

void write_road_report(const std::filesystem::path& path, const RoadReport& report) {
  const std::string kind = lower_extension(path);
  if (kind == ".html") {
    write_whole(path, {html_document(road_document(report))});
  } else if (kind == ".pdf") {
    write_whole(path, {pdf_document(road_document(report))});
  } else {
    write_whole(path, {json_text(road_json(report))});
  }
}

}  // namespace lightwell
