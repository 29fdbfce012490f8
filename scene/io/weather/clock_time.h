#pragma once

#include <string>

#include "scene/sun_position.h"

namespace lightwell {

/// Reads an instant in standard time, "2024-11-21 15:30", with a blank or a T before the time of
/// day. Throws InputError for other text, and for an instant outside of 1950 to 2050, the years of
/// sun_position().
ClockTime read_clock_time(const std::string& text);

}  // namespace lightwell
