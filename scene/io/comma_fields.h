#pragma once

#include <string_view>
#include <vector>

namespace lightwell {

/// The fields of a line between commas, without blanks around them; an empty line has one.
std::vector<std::string_view> comma_fields(std::string_view line);

}  // namespace lightwell
