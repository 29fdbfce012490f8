#pragma once

#include <string_view>

namespace lightwell {

/// True for words by which programs write a number that is not finite, or too large for a double:
/// nan, -inf, -nan(ind), 1.#QNAN, 1e999.
bool names_non_finite(std::string_view word);

}  // namespace lightwell
