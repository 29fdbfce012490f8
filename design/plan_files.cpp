#include "design/plan_files.h"

#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "design/plan_words.h"
#include "scene/io/comma_fields.h"

namespace lightwell {
namespace {

using Json = nlohmann::ordered_json;

Json limit_json(const LimitOutcome& outcome) {
  const WordedLimit& limit = outcome.limit;
  const bool is_glare = limit.kind == LimitKind::ugr_at_most;
  return {{is_glare ? "observer" : "grid", limit.place},
          {"limit", limit_key(limit.kind)},
          {"value", limit.value},
          {"reached", outcome.reached},
          {"within", outcome.within},
          {"verdict", verdict_name(outcome.verdict)},
          {"at_full_power", outcome.at_full},
          {"price", outcome.price}};
}

std::string luminaire_lines(const LightingPlan& plan) {
  std::string text;
  for (const Luminaire& luminaire : plan.luminaires) {
    const double level = level_of(plan, luminaire);
    text += fmt::format("  {:<24} {:>5.1f} %", luminaire.name, 100.0 * level);
    if (luminaire.watts > 0.0) {
      text += fmt::format("  {:>6.1f} of {:.4g} W", level * luminaire.watts, luminaire.watts);
    }
    text += '\n';
  }
  return text;
}

// A place as an array of three numbers in the unit of the scene's file.
Json place_json(const Eigen::Vector3d& place, double metres_per_unit) {
  const Eigen::Vector3d p = place / metres_per_unit;
  return {p.x(), p.y(), p.z()};
}

std::string place_lines(const LightingPlan& plan, double metres_per_unit) {
  std::string text;
  for (std::size_t i = 0; i < plan.luminaires.size(); ++i) {
    const Luminaire& luminaire = plan.luminaires[i];
    const Eigen::Vector3d& before = plan.earlier->positions[i];
    if (before == luminaire.position) continue;
    text += fmt::format("  {:<24} {} -> {}\n", luminaire.name, place_text(before, metres_per_unit),
                        place_text(luminaire.position, metres_per_unit));
  }
  return text.empty() ? "  no luminaire was moved\n" : text;
}

std::string limit_lines(const LightingPlan& plan) {
  std::string text;
  for (const LimitOutcome& outcome : plan.limits) {
    const WordedLimit& limit = outcome.limit;
    text += fmt::format(
        "  {:<24} {:<5} {} {:<9} reached {} ± {:.2g}: {}", limit.place, quantity_name(limit.kind),
        is_lower_limit(limit.kind) ? ">=" : "<=", value_text(limit.kind, limit.value),
        value_text(limit.kind, outcome.reached), outcome.within, verdict_name(outcome.verdict));
    const std::string cost = cost_of_step(plan, outcome);
    text += (cost.empty() ? "" : ", " + cost) + "\n";
  }
  return text;
}

}  // namespace

std::string levels_csv(const LightingPlan& plan, double metres_per_unit) {
  std::string csv = "luminaire,x,y,z,level,watts_full,watts,group\n";
  for (const Luminaire& luminaire : plan.luminaires) {
    const Eigen::Vector3d p = luminaire.position / metres_per_unit;
    const double level = level_of(plan, luminaire);
    const auto out = std::back_inserter(csv);
    fmt::format_to(out, "{},{:.6g},{:.6g},{:.6g},{:.6g},", quoted_field(luminaire.name), p.x(),
                   p.y(), p.z(), level);
    if (luminaire.watts > 0.0) {
      fmt::format_to(out, "{:.6g},{:.6g},", luminaire.watts, level * luminaire.watts);
    } else {
      csv += ",,";
    }
    csv += quoted_field(plan.groups[static_cast<std::size_t>(luminaire.channel)]) + "\n";
  }
  return csv;
}

std::string places_csv(const LightingPlan& plan, double metres_per_unit) {
  std::string csv = "luminaire,x_before,y_before,z_before,x,y,z,moved\n";
  for (std::size_t i = 0; i < plan.luminaires.size(); ++i) {
    const Eigen::Vector3d a = plan.earlier->positions[i] / metres_per_unit;
    const Eigen::Vector3d b = plan.luminaires[i].position / metres_per_unit;
    fmt::format_to(std::back_inserter(csv), "{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f}\n",
                   quoted_field(plan.luminaires[i].name), a.x(), a.y(), a.z(), b.x(), b.y(), b.z(),
                   (b - a).norm());
  }
  return csv;
}

Json plan_json(const LightingPlan& plan, double metres_per_unit) {
  Json luminaires = Json::array(), limits = Json::array();
  for (std::size_t i = 0; i < plan.luminaires.size(); ++i) {
    const Luminaire& luminaire = plan.luminaires[i];
    Json json = {{"name", luminaire.name},
                 {"group", plan.groups[static_cast<std::size_t>(luminaire.channel)]},
                 {"level", level_of(plan, luminaire)},
                 {"lumens_full", luminaire.lumens}};
    if (luminaire.watts > 0.0) json["watts_full"] = luminaire.watts;
    if (plan.earlier) {
      json["place_before"] = place_json(plan.earlier->positions[i], metres_per_unit);
      json["place"] = place_json(luminaire.position, metres_per_unit);
    }
    luminaires.push_back(std::move(json));
  }
  for (const LimitOutcome& outcome : plan.limits) limits.push_back(limit_json(outcome));
  Json even;
  if (plan.cost_of_even) even = *plan.cost_of_even;
  Json figures = {{"feasible", plan.is_feasible},
                  {"meets_all", plan.meets_all()},
                  {"minimised", plan.is_in_watts ? "watts" : "lumens"},
                  {"at_full_power", plan.cost_at_full},
                  {"optimum", plan.cost},
                  {"optimum_without_margin", plan.cost_without_margin},
                  {"all_at_one_level", std::move(even)},
                  {"maintenance_factor", plan.maintenance_factor},
                  {"rays", plan.rays},
                  {"measurements", plan.measurements},
                  {"limits", std::move(limits)},
                  {"luminaires", std::move(luminaires)},
                  {"design_notes", plan.notes}};
  if (plan.earlier) {
    figures["moved"] = {{"optimum_before", plan.earlier->cost},
                        {"met_all_before", plan.earlier->meets_all},
                        {"solves", plan.earlier->solves}};
  }
  return figures;
}

std::string plan_text(const LightingPlan& plan, double metres_per_unit) {
  std::string text = "luminaires\n" + luminaire_lines(plan);
  if (plan.earlier) text += "places\n" + place_lines(plan, metres_per_unit);
  text += "limits\n" + limit_lines(plan);
  for (const std::string& sentence : power_sentences(plan)) text += sentence + "\n";
  for (const std::string& sentence : unmet_sentences(plan)) text += sentence + "\n";
  return text;
}

}  // namespace lightwell
