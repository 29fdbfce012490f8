#pragma once

#include <optional>

#include "viewer/document/document.h"
#include "viewer/export/false_color.h"
#include "viewer/report/lighting_report.h"
#include "viewer/report/words.h"

namespace lightwell {

/// The report as a document: cover, results, luminaires, plans, glare, assumptions, and the basis
/// of the calculation. `range` is the scale of the false colours of every plan; unset, each plan
/// has a scale of its own.
Document lighting_document(const LightingReport& report, const std::optional<LuxRange>& range,
                           Language language);

}  // namespace lightwell
