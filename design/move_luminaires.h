#pragma once

#include <functional>

#include "design/design_lighting.h"

namespace lightwell {

/// A scene whose luminaires were moved, its light, and its levels.
struct MovedDesign {
  Scene scene{};
  SolvedScene solved{};  ///< relit with the levels
  LightingPlan plan{};   ///< LightingPlan::earlier is set
};

/// Solves a scene with a channel for each luminaire or group (see dimming_channels()).
using SolveWithChannels = std::function<SolvedScene(const Scene& scene)>;

/// Finds places of the luminaires of task.places that take less power, or come nearer to limits
/// that are out of reach:
///
/// 1. solves the scene, and finds the levels by design_lighting();
/// 2. descends from the places to better ones by PlacedLight, see descend();
/// 3. solves the scene with the luminaires there, and finds the levels by design_lighting();
/// 4. goes back to 2 from there if the levels are better. If they are not, takes half of the way,
/// and
///    the design of before after two attempts.
///
/// The answer is thus a design whose light was solved and measured with the luminaires where they
/// are, and no worse than with the luminaires where they were. Coordinates are whole micrometres of
/// the unit of the scene's file where that is a metre, six decimals of any other unit. Throws what
/// design_lighting() and `solve` throw.
MovedDesign move_luminaires(const DesignTask& task, const ReportedScene& of,
                            const SolveWithChannels& solve, const Progress& progress);

}  // namespace lightwell
