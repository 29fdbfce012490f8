#include "viewer/report/figures.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "scene/io/comma_fields.h"
#include "viewer/report/plan_svg.h"

namespace lightwell {
namespace {

using Json = nlohmann::ordered_json;

// Bound of the first point that has the given illuminance; null where nothing is known.
Json within_of(const LuxField& field, double lux) {
  const double within = bound_at(field, lux);
  return std::isfinite(within) ? Json(within) : Json();
}

Json field_json(const LuxField& field) {
  return {{"E_m", field.mean},
          {"E_min", field.least},
          {"E_max", field.greatest},
          {"E_min_within", within_of(field, field.least)},
          {"E_max_within", within_of(field, field.greatest)},
          {"U_0", field.uniformity},
          {"mean_within", field.mean_within * field.mean},
          {"point_within_relative", field.point_within}};
}

const char* quantity_name(GridQuantity quantity) {
  switch (quantity) {
    case GridQuantity::vertical:
      return "vertical";
    case GridQuantity::cylindrical:
      return "cylindrical";
    case GridQuantity::semicylindrical:
      return "semicylindrical";
    case GridQuantity::planar:
      break;
  }
  return "planar";
}

Json surface_json(const LightingReport& report, const CalculationSurface& surface) {
  const LuxGrid& grid = surface.grid;
  Json json = {{"name", grid.name}};
  json.update(field_json(surface.field));
  if (grid.quantity != GridQuantity::planar) json["quantity"] = quantity_name(grid.quantity);
  if (grid.is_direct_only) json["light"] = "direct";
  json["points"] = grid.points.size();
  json["spacing_m"] = {grid.step_u, grid.step_v};
  json["height_m"] = grid.options.height;
  json["margin_m"] = grid.options.margin;
  json["area_m2"] = grid.area;
  if (surface.electric) json["electric"] = field_json(*surface.electric);
  if (surface.daylight) json["daylight"] = field_json(*surface.daylight);
  if (const auto power = power_density(report, surface)) {
    json["W_per_m2"] = power->watts_per_area;
    if (power->per_hundred_lux) json["W_per_m2_per_100_lx"] = *power->per_hundred_lux;
  }
  return json;
}

// Light by what eyes and bodies make of it.
Json eye_json(const EyeLight& light) {
  Json receptors = Json::object();
  for (int r = 0; r < receptor_count; ++r) {
    const auto receptor = static_cast<std::size_t>(r);
    receptors[receptor_name(static_cast<Receptor>(r))] = {
        {"W_per_m2", light.alpha_opic[receptor]}, {"EDI", light.equivalent_daylight[receptor]}};
  }
  Json json = {{"alpha_opic", std::move(receptors)},
               {"melanopic_DER", light.melanopic_ratio()},
               {"x", light.x},
               {"y", light.y},
               {"CCT", nullptr},
               {"Duv", light.duv},
               {"R_a", nullptr}};
  if (light.colour_temperature) json["CCT"] = *light.colour_temperature;
  if (light.colour_rendering) json["R_a"] = *light.colour_rendering;
  return json;
}

// The bound of an index behind its value, where it is known.
std::string index_bound(double within) {
  return std::isfinite(within) ? fmt::format(" ± {:.1g}", within) : "";
}

// Illuminance of an eye, and where wavelengths are known its melanopic EDI, CCT and R_a.
std::string eye_text(const Observer& observer) {
  std::string text = fmt::format("{}: {} lx at the eye", observer.name, lux_text(observer.lux));
  if (std::isfinite(observer.lux_within)) {
    text += fmt::format(" (± {})", lux_text(observer.lux_within));
  }
  if (observer.light) {
    const EyeLight& light = *observer.light;
    text += fmt::format(", melanopic EDI {} lx (DER {:.2f})",
                        lux_text(light.melanopic_ratio() * light.lux), light.melanopic_ratio());
    if (light.colour_temperature) text += fmt::format(", {:.0f} K", *light.colour_temperature);
    if (light.colour_rendering) text += fmt::format(", R_a {:.0f}", *light.colour_rendering);
  }
  if (observer.fidelity) {
    const ColourFidelity& colours = *observer.fidelity;
    text += fmt::format(", R_f {:.0f}{}, R_g {:.0f}{}", colours.fidelity,
                        index_bound(colours.fidelity_within), colours.gamut,
                        index_bound(colours.gamut_within));
  }
  return text + "\n";
}

Json observer_json(const Observer& observer) {
  Json sources = Json::array();
  for (const GlareSource& source : observer.glare.sources) {
    sources.push_back({{"name", source.name},
                       {"luminance", source.luminance},
                       {"solid_angle", source.solid_angle},
                       {"position_index", source.position_index}});
  }
  Json ugr;  // null: no luminaire in sight
  if (observer.glare.ugr) ugr = *observer.glare.ugr;
  Json json = {{"name", observer.name},
               {"UGR", std::move(ugr)},
               {"background_luminance", observer.glare.background},
               {"sources", std::move(sources)},
               {"left_out", observer.glare.left_out},
               {"E_v", observer.lux},
               {"E_v_within", nullptr}};
  if (std::isfinite(observer.lux_within)) json["E_v_within"] = observer.lux_within;
  if (observer.light) json.update(eye_json(*observer.light));
  if (observer.fidelity) {
    json["R_f"] = observer.fidelity->fidelity;
    json["R_g"] = observer.fidelity->gamut;
    json["R_f_within"] = observer.fidelity->fidelity_within;  // null: unknown
    json["R_g_within"] = observer.fidelity->gamut_within;
  }
  return json;
}

Json luminaire_json(const LuminaireRow& row) {
  Json json = {{"name", row.name}, {"number", row.count}, {"lumens", row.flux}};
  if (row.watts > 0.0) json["watts"] = row.watts;
  if (row.colour) json["R_a"] = row.colour->rendering;  // null: not defined
  if (row.file) {
    json["file"] = row.file->file.filename().string();
    json["luminaire"] = row.file->name;
    json["maker"] = row.file->maker;
    if (!row.file->is_radiometric) json["table_lumens"] = row.file->flux();
    if (row.file->lamp_lumens > 0.0) json["label_lumens"] = row.file->lamp_lumens;
  }
  return json;
}

Json requirement_json(const Requirement& requirement) {
  Json json = {{"area", requirement.area},
               {"place", requirement.place},
               {"figure", figure_symbol(requirement.figure)},
               {requirement.is_upper ? "at_most" : "at_least", requirement.limit},
               {"value", nullptr},
               {"within", requirement.within},
               {"recommended", requirement.is_recommended},
               {"verdict", verdict_name(verdict_of(requirement))}};
  if (requirement.value && std::isfinite(*requirement.value)) json["value"] = *requirement.value;
  return json;
}

// An area's verdict, and a line for each limit that is not surely kept.
std::string area_text(std::span<const Requirement> of_area) {
  std::string text =
      fmt::format("{}: {}\n", of_area.front().area, verdict_name(verdict_of(of_area)));
  for (const Requirement& requirement : of_area) {
    const Verdict verdict = verdict_of(requirement);
    if (verdict == Verdict::met) continue;
    const std::string within =
        requirement.within > 0.0 ? fmt::format(" ± {:.2g}", requirement.within) : "";
    text += fmt::format("  {}{}: {} {} of {}{}, {} {}\n",
                        requirement.is_recommended ? "recommended, " : "", verdict_name(verdict),
                        figure_symbol(requirement.figure),
                        figure_text(requirement.figure, *requirement.value), requirement.place,
                        within, requirement.is_upper ? "at most" : "at least",
                        figure_text(requirement.figure, requirement.limit));
  }
  return text;
}

const char* content_name(LightContent content) {
  switch (content) {
    case LightContent::electric:
      return "electric";
    case LightContent::daylight:
      return "daylight";
    case LightContent::apart:
      return "electric and daylight, apart";
    case LightContent::together:
      break;
  }
  return "electric and daylight, together";
}

std::string line_of(const std::string& name, const LuxField& field) {
  return fmt::format("{}: E_m {:.4g} lx (± {:.2g} %), E_min {:.4g}, E_max {:.4g}, U_0 {:.2f}\n",
                     name, field.mean, 100.0 * field.mean_within, field.least, field.greatest,
                     field.uniformity);
}

}  // namespace

nlohmann::ordered_json figures_json(const LightingReport& report) {
  Json surfaces = Json::array(), observers = Json::array(), lamps = Json::array();
  for (const CalculationSurface& surface : report.surfaces) {
    surfaces.push_back(surface_json(report, surface));
  }
  for (const Observer& observer : report.observers) observers.push_back(observer_json(observer));
  for (const LuminaireRow& row : report.luminaires) lamps.push_back(luminaire_json(row));
  Json figures = {{"contains", content_name(report.content)},
                  {"maintenance_factor", report.maintenance_factor},
                  {"luminaires", std::move(lamps)},
                  {"surfaces", std::move(surfaces)},
                  {"observers", std::move(observers)}};
  if (report.energy) {
    figures["energy"] = {{"surface", report.energy->surface},
                         {"area_m2", report.energy->area},
                         {"LENI_kWh_per_m2", report.energy->indicator}};
  }
  if (report.requirements.empty()) return figures;
  figures["requirements"] = requirements_json(report.requirements);
  figures["verdict"] = verdict_name(verdict_of(report.requirements));
  return figures;
}

nlohmann::ordered_json requirements_json(std::span<const Requirement> requirements) {
  Json list = Json::array();
  for (const Requirement& requirement : requirements) {
    list.push_back(requirement_json(requirement));
  }
  return list;
}

std::string verdicts_text(std::span<const Requirement> requirements) {
  std::string text;
  for (const auto& of_area : by_area(requirements)) text += area_text(of_area);
  return text;
}

std::string figure_text(Figure figure, double value) {
  if (std::isnan(value)) return "not defined";
  switch (figure) {
    case Figure::uniformity:
    case Figure::modelling:
    case Figure::luminance:
    case Figure::overall_uniformity:
    case Figure::wet_uniformity:
    case Figure::longitudinal_uniformity:
    case Figure::edge_ratio:
    case Figure::vertical_uniformity:
    case Figure::vertical_contrast:
      return fmt::format("{:.2f}", value);
    case Figure::glare:
    case Figure::diversity:
    case Figure::threshold_increment:
    case Figure::gradient:
    case Figure::glare_rating:
      return fmt::format("{:.1f}", value);
    case Figure::colour_rendering:
      return fmt::format("{:.0f}", value);
    case Figure::mean:
    case Figure::least:
    case Figure::cylindrical:
    case Figure::least_vertical:
    case Figure::least_semicylindrical:
    case Figure::vertical_mean:
      break;
  }
  return lux_text(value);
}

std::string points_csv(const LightingReport& report) {
  const bool is_apart = report.content == LightContent::apart;
  std::string csv = "surface,x,y,z,lux,lux_within";
  csv += is_apart ? ",electric_lux,daylight_lux\n" : "\n";
  for (const CalculationSurface& surface : report.surfaces) {
    const std::string name = quoted_field(surface.grid.name);
    for (std::size_t i = 0; i < surface.grid.points.size(); ++i) {
      const auto point = static_cast<Eigen::Index>(i);
      const Eigen::Vector3d p = surface.grid.points[i].position / report.metres_per_unit;
      const double within = surface.field.lux_within[point];
      const auto out = std::back_inserter(csv);
      fmt::format_to(out, "{},{:.6g},{:.6g},{:.6g},{:.6g},", name, p.x(), p.y(), p.z(),
                     surface.field.lux[point]);
      if (!std::isnan(within)) fmt::format_to(out, "{:.3g}", within);
      if (is_apart) {
        fmt::format_to(out, ",{:.6g},{:.6g}", surface.electric->lux[point],
                       surface.daylight->lux[point]);
      }
      csv += '\n';
    }
  }
  return csv;
}

std::string figures_text(const LightingReport& report) {
  std::string text;
  if (report.content == LightContent::together) {
    text =
        "electric light and daylight together, since the solution does not keep them apart; the "
        "maintenance factor multiplies both\n";
  }
  for (const CalculationSurface& surface : report.surfaces) {
    const std::string& name = surface.grid.name;
    if (surface.electric) text += line_of(name + ", electric light", *surface.electric);
    if (surface.daylight) text += line_of(name + ", daylight", *surface.daylight);
    text += line_of(surface.electric ? name + ", both" : name, surface.field);
    const auto power = power_density(report, surface);
    if (!power) continue;
    text += fmt::format("{}: {:.2f} W/m2", name, power->watts_per_area);
    if (power->per_hundred_lux) {
      text += fmt::format(", {:.2f} W/m2 per 100 lx{}", *power->per_hundred_lux,
                          surface.electric ? " of electric light" : "");
    }
    text += '\n';
  }
  for (const Observer& observer : report.observers) {
    text += observer.glare.ugr
                ? fmt::format("{}: UGR {:.1f}\n", observer.name, *observer.glare.ugr)
                : fmt::format("{}: no luminaire in sight, so no UGR\n", observer.name);
    text += eye_text(observer);
  }
  if (report.energy) {
    text += fmt::format("{}: LENI {:.2f} kWh/m2 in a year\n", report.energy->surface,
                        report.energy->indicator);
  }
  for (const auto& of_area : by_area(report.requirements)) text += area_text(of_area);
  return text;
}

}  // namespace lightwell
