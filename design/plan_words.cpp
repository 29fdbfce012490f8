#include "design/plan_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "design/plan_files.h"

namespace lightwell {
namespace {

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

// The cost of a step of step_name() towards a stricter limit, >= 0.
double cost_of(const LimitOutcome& outcome) {
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
std::string sentence_of(const LightingPlan& plan, const LimitOutcome& outcome) {
  const WordedLimit& limit = outcome.limit;
  const std::string asked = value_text(limit.kind, limit.value);
  const char* const quantity = quantity_name(limit.kind);
  if (outcome.verdict == Verdict::too_close) {
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
  if (plan.is_feasible) {
    return fmt::format("{}: measurement {} of the levels has {} {} where {} is asked for",
                       place_text(limit), plan.measurements, quantity,
                       value_text(limit.kind, outcome.reached), asked);
  }
  return fmt::format("{}: no levels meet this limit and the others; {} is {} where {} is asked for",
                     place_text(limit), quantity, value_text(limit.kind, outcome.reached), asked);
}

// The cost before luminaires were moved.
std::string earlier_sentence(const LightingPlan& plan) {
  const EarlierPlaces& earlier = *plan.earlier;
  const char* const unit = cost_unit(plan);
  if (!earlier.meets_all) {
    return fmt::format(
        "the luminaires where the scene has them would take {:.4g} {} and miss limits",
        earlier.cost, unit);
  }
  if (!(earlier.cost > plan.cost) || !plan.meets_all()) {
    return fmt::format(
        "no places were found that take less than the {:.4g} {} of those in the scene",
        earlier.cost, unit);
  }
  return fmt::format("the luminaires where the scene has them would take {:.4g} {}, {:.3g} % more",
                     earlier.cost, unit, 100.0 * (earlier.cost / plan.cost - 1.0));
}

}  // namespace

const char* cost_unit(const LightingPlan& plan) {
  return plan.is_in_watts ? "W" : "lm";
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

std::string cost_of_step(const LightingPlan& plan, const LimitOutcome& outcome) {
  const double cost = cost_of(outcome);
  if (!(cost > 0.0)) return {};
  return fmt::format("{:.3g} {} {}", cost, cost_unit(plan), step_name(outcome.limit.kind));
}

std::string place_text(const Eigen::Vector3d& place, double metres_per_unit) {
  const Eigen::Vector3d p = place / metres_per_unit;
  return fmt::format("({:.2f}, {:.2f}, {:.2f})", p.x(), p.y(), p.z());
}

double level_of(const LightingPlan& plan, const Luminaire& luminaire) {
  return plan.levels[static_cast<std::size_t>(luminaire.channel)];
}

std::vector<std::string> power_sentences(const LightingPlan& plan) {
  const char* const unit = cost_unit(plan);
  std::vector<std::string> sentences = {fmt::format("{} {:.4g} {} of {:.4g} {}",
                                                    plan.is_in_watts ? "power" : "flux", plan.cost,
                                                    unit, plan.cost_at_full, unit)};
  if (!plan.is_feasible) {
    if (plan.earlier) sentences.push_back(earlier_sentence(plan));
    return sentences;
  }
  if (plan.cost > plan.cost_without_margin) {
    sentences.back() +=
        fmt::format(", of which {:.2g} {} keep the limits by the error of the light",
                    plan.cost - plan.cost_without_margin, unit);
  }
  if (plan.earlier) sentences.push_back(earlier_sentence(plan));
  if (!plan.cost_of_even) {
    sentences.emplace_back("all luminaires at one level would not meet the limits");
  } else if (plan.cost > 0.0) {
    sentences.push_back(
        fmt::format("all luminaires at one level would take {:.4g} {}, {:.3g} % more",
                    *plan.cost_of_even, unit, 100.0 * (*plan.cost_of_even / plan.cost - 1.0)));
  }
  if (const LimitOutcome* const most = most_binding(plan)) {
    sentences.push_back(fmt::format("the limit that binds most: {} of {}",
                                    quantity_name(most->limit.kind), place_text(most->limit)));
  }
  return sentences;
}

std::vector<std::string> unmet_sentences(const LightingPlan& plan) {
  std::vector<std::string> sentences;
  for (const LimitOutcome& outcome : plan.limits) {
    if (outcome.verdict != Verdict::met) sentences.push_back(sentence_of(plan, outcome));
  }
  return sentences;
}

}  // namespace lightwell
