#pragma once

#include <cstdint>
#include <string>

namespace lightwell {

/// Options of refinement.
struct RefineOptions {
  /// RMS error of interpolated irradiance at which refinement stops, over all area that reflects,
  /// relative to error_reference(). 0: nothing is refined.
  double tolerance = 0.007;
  /// Most elements, both sides counted. 0: about as many as an even mesh of a quarter of the
  /// start's edges has, if small elements of the start are not split.
  std::int64_t max_elements = 0;
  /// Most elements that there is memory for, both sides counted; below 0: any number. The elements
  /// of the start are kept even if they are more.
  std::int64_t room = -1;
  /// Most levels of splits: edges of 2^-max_level of the start's.
  int max_level = 4;
};

/// The reason why refinement ended.
enum class RefineOutcome {
  off,
  tolerance_reached,
  max_elements_reached,
  memory_limit_reached,  ///< as many elements as RefineOptions::room
  smallest_size_reached
};

/// The course of refinement, in numbers.
struct RefineReport {
  RefineOutcome outcome = RefineOutcome::off;
  double tolerance = 0.0;
  double estimate = 0.0;  ///< RMS error that is left, by the elements' own estimates; relative
  int rounds = 0;
  std::int64_t elements_at_first = 0, elements = 0;
  std::int64_t gathers = 0;  ///< points at which direct light was gathered
};

/// The report as text, such as "the tolerance of 0.7 % is reached (0.68 % estimated; 1780 elements
/// became 6990 in 2 rounds)".
std::string sentence(const RefineReport& report);

}  // namespace lightwell
