#pragma once

#include <string>
#include <vector>

#include "viewer/document/document.h"
#include "viewer/report/lighting_report.h"
#include "viewer/report/words.h"

namespace lightwell {

/// A kind of light that was measured on a surface.
struct NamedField {
  const char* name;
  const LuxField& field;
};

/// All kinds of light that were measured on a surface; where they are apart, their sum is the last.
std::vector<NamedField> fields_of(const LightingReport& report, const CalculationSurface& surface,
                                  Language language);

/// Words for all light of a report.
const char* light_words(LightContent content, Language language);

/// Illuminance with digits that suit its size, and a share in percent.
std::string lux_text(double lux, Language language);
std::string percent_text(double share, Language language);

/// Tables of a report; without rows where it has nothing for them.
DocumentTable illuminance_table(const LightingReport& report, Language language);
DocumentTable power_table(const LightingReport& report, Language language);
DocumentTable rating_table(const LightingReport& report, Language language);
DocumentTable luminaire_table(const LightingReport& report, Language language);
DocumentTable observer_table(const LightingReport& report, Language language);
/// The luminaires in sight of an observer.
DocumentTable source_table(const Observer& observer, Language language);

}  // namespace lightwell
