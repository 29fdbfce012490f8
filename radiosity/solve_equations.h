#pragma once

#include <string>
#include <vector>

#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/openings/find_openings.h"
#include "radiosity/solve.h"

namespace lightwell {

/// A scene's light, and the openings that rows aim rays at.
struct EquationTask {
  const LitScene& lit;
  const DirectLight& kept_apart;  ///< by channel
  const std::vector<Opening>& openings;
};

/// The light of patches, with the rows that it was found from.
struct SolvedEquations {
  RadiositySolution solution{};
  FormFactorReport rows{};
  std::vector<std::string> notes{};
};

/// Computes form factors and solves the equations of all patches; once the time is up, with rows of
/// few rays. If the time is limited from the start, these are solved first, and tell how many rays
/// there is time for. Throws Interrupted when progress says stop.
SolvedEquations solve_in_time(const EquationTask& task, const SolveOptions& options);

}  // namespace lightwell
