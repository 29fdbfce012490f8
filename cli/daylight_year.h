#pragma once

#include <span>

#include "cli/daylight_inputs.h"
#include "daylight/sky_year.h"

namespace lightwell {

/// Computes and writes the year; returns an ExitCode.
int daylight_of_year(const DaylightArguments& arguments, const DaylightInputs& inputs,
                     Console& console, Report& report);

/// Computes and writes the instant `arguments.at`; returns an ExitCode.
int daylight_of_instant(const DaylightArguments& arguments, const DaylightInputs& inputs,
                        Console& console, Report& report);

/// Writes the page of `arguments.walk`, of the year's light on all surfaces, windows in their first
/// states.
void write_walk(const DaylightArguments& arguments, const DaylightInputs& inputs,
                const DaylightModel& model, std::span<const SkyHour> hours, Console& console,
                Report& report);

}  // namespace lightwell
