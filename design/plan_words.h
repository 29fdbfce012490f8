#pragma once

#include <string>
#include <vector>

#include "design/design_lighting.h"

namespace lightwell {

/// "W" or "lm", the unit of the costs of a plan.
const char* cost_unit(const LightingPlan& plan);

/// "E_m", "E_min", "E_max", "U_0" or "UGR".
const char* quantity_name(LimitKind kind);

/// A value with the digits and the unit that its quantity is given with.
std::string value_text(LimitKind kind, double value);

/// The cost of a small step to a stricter limit, such as "2.4 W for 10 lx"; empty: nothing.
std::string cost_of_step(const LightingPlan& plan, const LimitOutcome& outcome);

/// A place such as "(1.20, 3.40, 2.79)", in the unit of the scene's file.
std::string place_text(const Eigen::Vector3d& place, double metres_per_unit);

/// Power at the levels, the margin in it, the power before luminaires were moved, the power of even
/// dimming and the limit that binds most: a sentence each, without full stops.
std::vector<std::string> power_sentences(const LightingPlan& plan);

/// A sentence without full stop for each limit that is not met.
std::vector<std::string> unmet_sentences(const LightingPlan& plan);

/// The level of a luminaire, [0,1].
double level_of(const LightingPlan& plan, const Luminaire& luminaire);

}  // namespace lightwell
