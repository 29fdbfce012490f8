#include "scene/io/non_finite.h"

#include <charconv>
#include <cmath>

#include "scene/io/text_file.h"

namespace lightwell {

bool names_non_finite(std::string_view word) {
  if (word.starts_with('+') || word.starts_with('-')) word.remove_prefix(1);
  if (word.starts_with("1.#")) return true;  // of Microsoft's C library before 2015
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return false;
  return error == std::errc::result_out_of_range || (error == std::errc() && !std::isfinite(value));
}

}  // namespace lightwell
