#pragma once

#include <string>

#include "validation/validate.h"

namespace lightwell {

/// SVG of the largest error over tolerance of every computed case, a dot each, on a logarithmic
/// scale from 1e-6 to 10, with a row for each group. Empty without computed cases.
std::string share_plot(const ValidationRun& run);

/// SVG of expected values (lines) and computed ones (dots) of a case with at least five values,
/// over the places in their order, above their errors in units of the tolerance. Values whose
/// places are "name, place" make a line for each name, at most four. Empty for other cases.
std::string values_plot(const CaseResult& result);

}  // namespace lightwell
