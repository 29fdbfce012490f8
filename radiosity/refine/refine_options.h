#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "radiosity/solution/scene_parts.h"

namespace lightwell {

/// Requirements of each part of a scene (see SceneParts::judged_with).
struct PartEffort {
  double tolerance = 0.0;  ///< RefineOptions::tolerance within the part
  /// Most noise of the final gather, and of the light of the sky's dome, relative to the part's
  /// mean; 0: any.
  double noise = 0.0, sky_noise = 0.0;
  int rays = 0;             ///< of the final gather in the part
  double irradiance = 0.0;  ///< by which errors in the part are judged, mean of bands, W/m^2
};

/// Options of refinement.
struct RefineOptions {
  /// RMS error of interpolated irradiance at which refinement stops, over all area that reflects,
  /// relative to the mean irradiance of the part or a quarter of the place's own, whichever is
  /// more. 0: nothing is refined.
  double tolerance = 0.007;
  /// Most elements, both sides counted. 0: about as many as an even mesh of a quarter of the
  /// start's edges has, if small elements of the start are not split.
  std::int64_t max_elements = 0;
  /// Most elements that there is memory for, both sides counted; below 0: any number. The elements
  /// of the start are kept even if they are more.
  std::int64_t room = -1;
  /// Most levels of splits: edges of 2^-max_level of the start's.
  int max_level = 4;
  /// The parts of the scene. If there are several, the tolerance is to be reached in each.
  SceneParts parts{};
  /// One entry for each part; empty: `tolerance`, and the rays of the gather, for all.
  std::vector<PartEffort> efforts{};

  double tolerance_of(int part) const {
    return efforts.empty() ? tolerance : efforts[static_cast<std::size_t>(part)].tolerance;
  }
};

/// The reason why refinement ended.
enum class RefineOutcome {
  off,
  tolerance_reached,
  max_elements_reached,
  memory_limit_reached,  ///< as many elements as RefineOptions::room
  time_limit_reached,
  smallest_size_reached
};

/// The error that refinement leaves in a part, see RefineReport::estimate.
struct PartRefinement {
  double estimate = 0.0;
  bool is_reached = false;  ///< the part's tolerance
};

/// The course of refinement, in numbers.
struct RefineReport {
  RefineOutcome outcome = RefineOutcome::off;
  double tolerance = 0.0;
  /// RMS error that is left, by the elements' own estimates; relative. With several parts, this and
  /// the tolerance are of the part whose error is the largest share of its tolerance.
  double estimate = 0.0;
  std::vector<PartRefinement> parts{};  ///< of each part; empty: nothing was refined
  int rounds = 0;
  std::int64_t elements_at_first = 0, elements = 0;
  std::int64_t gathers = 0;  ///< points at which direct light was gathered
};

/// The report as text, such as "the tolerance of 0.7 % is reached (0.68 % estimated; 1780 elements
/// became 6990 in 2 rounds)".
std::string sentence(const RefineReport& report);

}  // namespace lightwell
