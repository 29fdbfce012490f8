#pragma once

#include "cli/daylight_inputs.h"

namespace lightwell {

/// Computes and writes the year; returns an ExitCode.
int daylight_of_year(const DaylightArguments& arguments, const DaylightStudy& study,
                     Console& console, Report& report);

/// Computes and writes the instant `arguments.at`; returns an ExitCode.
int daylight_of_instant(const DaylightArguments& arguments, const DaylightStudy& study,
                        Console& console, Report& report);

}  // namespace lightwell
