#pragma once

#include <span>
#include <vector>

#include "viewer/document/document.h"
#include "viewer/report/lighting_report.h"
#include "viewer/report/words.h"

namespace lightwell {

/// Limits of standards with figures and verdicts: a table for each area.
std::vector<DocumentTable> requirement_tables(std::span<const Requirement> requirements,
                                              Language language);

/// Light at the eyes of observers; without rows if there are none.
DocumentTable eye_table(const LightingReport& report, Language language);

/// The energy of a year; empty without one.
MarkedText energy_text(const LightingReport& report, Language language);

}  // namespace lightwell
