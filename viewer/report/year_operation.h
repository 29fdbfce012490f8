#pragma once

#include <string>

#include "viewer/report/year_report.h"

namespace lightwell {

/// Sections of the page on operated windows, glare and exposure to sunlight, as far as there are
/// such.
std::string operation_sections(const YearReport& report);

}  // namespace lightwell
