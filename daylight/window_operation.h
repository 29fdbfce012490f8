#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "daylight/daylight_model.h"
#include "daylight/sky_year.h"
#include "scene/io/window_states.h"

namespace lightwell {

/// Sensors that are judged together.
struct SensorRange {
  Eigen::Index first = 0, count = 0;
};

/// IES LM-83-12, 2.2.6: a group closes while more than this share of a room's sensors get direct
/// sunlight of lm_83_sunlight through it.
inline constexpr double lm_83_share = 0.02;
inline constexpr float lm_83_sunlight = 1000.0f;  ///< lx

/// A weather file's hours and what is judged in them.
struct OperationTask {
  std::span<const SkyHour> hours{};
  bool is_leap_year = false;
  double ground_reflectance = 0.2;
  std::span<const SensorRange> rooms{};
};

/// The state of each group in each hour, groups x hours.
///
/// - `lm_83`: direct sunlight of a group is that of the sensors with all groups in their first
///   state, less what is left when the group is opaque, by the same random numbers. One room of
///   several is enough to close a group.
/// - `illuminance`: closed above `close_above`, until the illuminance falls below `open_below` or
///   night comes. It is that of the brightest of the group's facets, on the brighter of its sides,
///   by sun, sky and ground alone, with all groups in their first state.
///
/// `open` is the model of the scene with all groups in their first state, and has the sensors.
/// Throws InputError for a schedule that is not of the year's length, or a group without area;
/// Interrupted when the model's progress says stop.
Eigen::ArrayXXi operate_windows(const DaylightModel& open, const OperatedWindows& windows,
                                const OperationTask& task);

/// The rule of a group as a sentence without full stop.
std::string operation_text(const WindowGroup& group);

}  // namespace lightwell
