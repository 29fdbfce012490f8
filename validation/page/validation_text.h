#pragma once

#include <string>
#include <string_view>

#include "validation/validate.h"

namespace lightwell {

/// "pass", "FAIL", "not run", "stopped".
std::string_view verdict_word(Verdict verdict);

/// A number with six digits for people.
std::string shown_number(double value);

/// The head of the table for terminals, and a line for each case.
std::string table_head();
std::string table_line(const CaseResult& result);

/// One JSON object: `cases` with id, group, expected, computed, error, tolerance, pass (null if the
/// case was not computed) and more; `passed`, `failed`, `not_run`, `stopped`, `seconds`. Expected
/// and computed are those of the value with the largest error over tolerance. Ends in a newline.
std::string validation_json(const ValidationRun& run);

/// The documentation's page, without seconds.
std::string validation_markdown(const ValidationRun& run);

}  // namespace lightwell
