#include "design/plan_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "scene/io/comma_fields.h"

namespace lightwell {
namespace {

using Json = nlohmann::ordered_json;

const char* verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::met:
      return "met";
    case Verdict::missed:
      return "missed";
    case Verdict::undecided:
      break;
  }
  return "too close to tell";
}

const char* quantity_name(LimitKind kind) {
  switch (kind) {
    case LimitKind::mean_at_least:
    case LimitKind::mean_at_most:
      return "E_m";
    case LimitKind::least_at_least:
      return "E_min";
    case LimitKind::greatest_at_most:
      return "E_max";
    case LimitKind::uniformity_at_least:
      return "U_0";
    case LimitKind::ugr_at_most:
      break;
  }
  return "UGR";
}

// A value with the digits that its quantity is given with.
std::string value_text(LimitKind kind, double value) {
  switch (kind) {
    case LimitKind::uniformity_at_least:
      return fmt::format("{:.3f}", value);
    case LimitKind::ugr_at_most:
      return fmt::format("{:.1f}", value);
    default:
      return fmt::format("{:.4g} lx", value);
  }
}

const char* step_name(LimitKind kind) {
  switch (kind) {
    case LimitKind::uniformity_at_least:
      return "for 0.01 of U_0";
    case LimitKind::ugr_at_most:
      return "for 1 of UGR";
    default:
      return "for 10 lx";
  }
}

// What a step of step_name() towards a stricter limit costs, >= 0.
double cost_of_step(const LimitOutcome& outcome) {
  const LimitKind kind = outcome.limit.kind;
  const double step = kind == LimitKind::uniformity_at_least ? 0.01
                      : kind == LimitKind::ugr_at_most       ? 1.0
                                                             : 10.0;
  return std::max(0.0, outcome.price * (is_lower_limit(kind) ? step : -step));
}

// The limit whose share of change costs most: that of the largest price times value.
const LimitOutcome* most_binding(const LightingPlan& plan) {
  const LimitOutcome* most = nullptr;
  double largest = 0.0;
  for (const LimitOutcome& outcome : plan.limits) {
    const double weight = std::abs(outcome.price) * outcome.limit.value;
    if (weight <= largest) continue;
    largest = weight;
    most = &outcome;
  }
  return most;
}

std::string place_text(const WordedLimit& limit) {
  const bool is_glare = limit.kind == LimitKind::ugr_at_most;
  return fmt::format("{} '{}'", is_glare ? "observer" : "grid", limit.place);
}

// Why a limit is not met.
std::string sentence_of(const LimitOutcome& outcome) {
  const WordedLimit& limit = outcome.limit;
  const std::string asked = value_text(limit.kind, limit.value);
  const char* const quantity = quantity_name(limit.kind);
  if (outcome.verdict == Verdict::undecided) {
    return fmt::format(
        "{}: {} is {} for a limit of {}, too close to tell within {}; more --grid-rays or a better "
        "--accuracy tell",
        place_text(limit), quantity, value_text(limit.kind, outcome.reached), asked,
        value_text(limit.kind, outcome.within));
  }
  const bool is_of_lux =
      limit.kind == LimitKind::mean_at_least || limit.kind == LimitKind::least_at_least;
  if (is_of_lux && outcome.at_full < limit.value) {
    return fmt::format("even with every luminaire at full power, {} reaches {} of {} of {}",
                       place_text(limit), value_text(limit.kind, outcome.at_full), asked, quantity);
  }
  return fmt::format("{}: no levels meet this limit and the others; {} is {} where {} is asked for",
                     place_text(limit), quantity, value_text(limit.kind, outcome.reached), asked);
}

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

double level_of(const LightingPlan& plan, const Luminaire& luminaire) {
  return plan.levels[static_cast<std::size_t>(luminaire.channel)];
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
    if (const double cost = cost_of_step(outcome); cost > 0.0) {
      text += fmt::format(", {:.3g} {} {}", cost, cost_unit(plan), step_name(limit.kind));
    }
    text += '\n';
  }
  return text;
}

std::string power_lines(const LightingPlan& plan) {
  const char* const unit = cost_unit(plan);
  std::string text = fmt::format("{} {:.4g} {} of {:.4g} {}", plan.is_in_watts ? "power" : "flux",
                                 plan.cost, unit, plan.cost_at_full, unit);
  if (plan.cost > plan.cost_without_margin && plan.is_feasible) {
    text += fmt::format(", of which {:.2g} {} keep the limits by the error of the light",
                        plan.cost - plan.cost_without_margin, unit);
  }
  text += '\n';
  if (!plan.is_feasible) return text;
  if (plan.cost_of_even) {
    text += fmt::format("all luminaires at one level would take {:.4g} {}, {:.3g} % more\n",
                        *plan.cost_of_even, unit,
                        100.0 * (*plan.cost_of_even / std::max(plan.cost, 1e-300) - 1.0));
  } else {
    text += "all luminaires at one level would not meet the limits\n";
  }
  if (const LimitOutcome* const most = most_binding(plan)) {
    text += fmt::format("the limit that binds most: {} of {}\n", quantity_name(most->limit.kind),
                        place_text(most->limit));
  }
  return text;
}

}  // namespace

const char* cost_unit(const LightingPlan& plan) {
  return plan.is_in_watts ? "W" : "lm";
}

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
  std::string text =
      "luminaires\n" + luminaire_lines(plan) + "limits\n" + limit_lines(plan) + power_lines(plan);
  for (const LimitOutcome& outcome : plan.limits) {
    if (outcome.verdict != Verdict::met) text += sentence_of(outcome) + "\n";
  }
  return text;
}

}  // namespace lightwell
