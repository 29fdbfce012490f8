#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lightwell {

/// The fields of a line between commas, without blanks around them; an empty line has one. A field
/// in quotation marks, which may hold commas, is without them.
std::vector<std::string_view> comma_fields(std::string_view line);

/// A name as one field, in quotation marks. A name that begins like a formula, which a spreadsheet
/// would compute, begins with an apostrophe.
std::string quoted_field(std::string name);

}  // namespace lightwell
