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

Json plan_json(const LightingPlan& plan) {
  Json luminaires = Json::array(), limits = Json::array();
  for (const Luminaire& luminaire : plan.luminaires) {
    Json json = {{"name", luminaire.name},
                 {"group", plan.groups[static_cast<std::size_t>(luminaire.channel)]},
                 {"level", level_of(plan, luminaire)},
                 {"lumens_full", luminaire.lumens}};
    if (luminaire.watts > 0.0) json["watts_full"] = luminaire.watts;
    luminaires.push_back(std::move(json));
  }
  for (const LimitOutcome& outcome : plan.limits) limits.push_back(limit_json(outcome));
  Json even;
  if (plan.cost_of_even) even = *plan.cost_of_even;
  return {{"feasible", plan.is_feasible},
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
}

std::string plan_text(const LightingPlan& plan) {
  std::string text = "luminaires\n" + luminaire_lines(plan) + "limits\n" + limit_lines(plan);
  for (const std::string& sentence : power_sentences(plan)) text += sentence + "\n";
  for (const std::string& sentence : unmet_sentences(plan)) text += sentence + "\n";
  return text;
}

}  // namespace lightwell
