#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "design/design_lighting.h"

namespace lightwell {

/// A table of the luminaires: name, position in the unit of the scene's file, level, electric power
/// (empty where unknown) and group.
std::string levels_csv(const LightingPlan& plan, double metres_per_unit);

/// A table of the luminaires of a plan with EarlierPlaces: name, place before and after, and the
/// distance between the two, in the unit of the scene's file.
std::string places_csv(const LightingPlan& plan, double metres_per_unit);

/// All figures of a plan; places are in the unit of the scene's file.
nlohmann::ordered_json plan_json(const LightingPlan& plan, double metres_per_unit);

/// A page to print: power, limits, levels, places where luminaires were moved, and a plan of each
/// grid with the levels beside the luminaires. `scene` gives title, unit and north.
std::string plan_page(const LightingPlan& plan, const Scene& scene);

/// Levels, places where luminaires were moved, power and limits as lines for people, and a sentence
/// for each limit that is not met.
std::string plan_text(const LightingPlan& plan, double metres_per_unit);

}  // namespace lightwell
