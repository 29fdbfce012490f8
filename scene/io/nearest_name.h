#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lightwell {

/// Returns " Did you mean 'NAME'?" with the known name closest to `given` in edit distance
/// (insertions, deletions, replacements and swaps of neighbours; Damerau 1964), or an empty string
/// if no name is close.
std::string did_you_mean(std::string_view given, const std::vector<std::string>& known);

}  // namespace lightwell
