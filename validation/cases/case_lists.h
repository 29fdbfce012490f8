#pragma once

#include <vector>

#include "validation/cases/case.h"

namespace lightwell {

// The cases of each group, in the order in which they are run.

std::vector<ValidationCase> form_factor_cases();
std::vector<ValidationCase> enclosure_cases();
std::vector<ValidationCase> optics_cases();
std::vector<ValidationCase> shadow_cases();
std::vector<ValidationCase> photometry_cases();
std::vector<ValidationCase> glare_cases();
std::vector<ValidationCase> ugr_table_cases();
std::vector<ValidationCase> sky_cases();
std::vector<ValidationCase> cie171_electric_cases();
std::vector<ValidationCase> cie171_daylight_cases();
std::vector<ValidationCase> cornell_cases();

}  // namespace lightwell
