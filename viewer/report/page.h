#pragma once

#include <optional>
#include <string>

#include "viewer/report/lighting_report.h"

namespace lightwell {

/// The report as one HTML page without external files, for screens and for A4 paper. `range` is the
/// scale of the false colours of every plan; unset, each plan has a scale of its own.
std::string lighting_page(const LightingReport& report, const std::optional<LuxRange>& range);

}  // namespace lightwell
