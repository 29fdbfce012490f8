#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "scene/io/window_states.h"

namespace lightwell {

/// The state of each group of windows, as an index into WindowGroup::states.
using WindowStates = std::vector<int>;

/// The scene with each group's surfaces of the material of its state.
Scene scene_in_states(const Scene& scene, const OperatedWindows& windows,
                      const WindowStates& states);

/// "south blind, west open": the states in words; empty without windows.
std::string states_text(const OperatedWindows& windows, const WindowStates& states);

/// Most combinations of states that are each computed by themselves.
inline constexpr int most_combinations = 8;
/// Most computations of one year.
inline constexpr int most_computations = 32;

/// The computations from which the light of any hour is put together.
///
/// A state changes the exchange of light between all patches, so that each combination of states
/// is a room of its own. Where a year has more than most_combinations of them, light is superposed
/// by groups, as in the three-phase method (McNeil & Lee 2013):
///
///     E(s_1, s_2, ...) = E(0) + sum_g (E(s_g) - E(0))
///
/// E(s_g) has group g in its state and all others in their first. Light that comes in through g
/// and ends in the room is exact. Left out is light that two changed groups have met, such as light
/// through one group that the other reflects: of the order of the share of the room's surfaces
/// that windows are. One behind the other, two groups would be wrong altogether. So a further
/// computation, the last, has all groups changed: it measures the error, and is the light of the
/// hours with these states.
struct WindowPlan {
  std::vector<WindowStates> computations{};  ///< the first has all groups in their first state
  bool is_superposed = false;

  /// Factor of a computation's light in an hour with these states. Factors sum to 1.
  double weight(std::size_t computation, const WindowStates& states) const;
  /// The same by superposition, whether or not the states are computed by themselves.
  double superposed_weight(std::size_t computation, const WindowStates& states) const;
};

/// The plan for hours with these states, groups x hours. Throws InputError if more than
/// most_computations would be needed.
WindowPlan plan_computations(const OperatedWindows& windows, const Eigen::ArrayXXi& states);

/// Column `hour` of states, groups x hours.
WindowStates states_of_hour(const Eigen::ArrayXXi& states, Eigen::Index hour);

}  // namespace lightwell
