#include "python/binding/checked.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "radiosity/solve_words.h"
#include "scene/errors.h"

namespace lightwell::python {

double positive(const char* option, double value) {
  if (std::isfinite(value) && value > 0.0) return value;
  throw InputError(fmt::format("{} is {:g}; a number above 0 is needed", option, value));
}

std::int64_t bytes_of_memory(double value) {
  constexpr double least = 0x1p20, most = 0x1p62;
  if (value >= least && value <= most) return static_cast<std::int64_t>(value);
  throw InputError(
      fmt::format("memory is {:g}; a number of bytes from 2^20 (1 MiB) to 2^62 is needed", value));
}

int whole_number(const char* option, int value, int least, int most) {
  if (value >= least && value <= most) return value;
  throw InputError(
      fmt::format("{} is {}; a whole number from {} to {} is needed", option, value, least, most));
}

int even_number(const char* option, int value) {
  constexpr int most = 4096;
  if (value >= 2 && value <= most && value % 2 == 0) return value;
  throw InputError(
      fmt::format("{} is {}; an even number from 2 to {} is needed", option, value, most));
}

int power_of_two(const char* option, int value) {
  constexpr int most = 1 << 20;
  if (value >= 1 && value <= most && std::has_single_bit(static_cast<unsigned>(value))) {
    return value;
  }
  throw InputError(
      fmt::format("{} is {}; a power of two from 1 to {} is needed, such as 256, 512, 1024", option,
                  value, most));
}

double share(const char* option, const std::string& text) {
  if (const auto value = parse_share(text)) return *value;
  throw InputError(
      fmt::format("{} is '{}'; a share from 0.001% to 100% is needed, such as 0.5%", option, text));
}

}  // namespace lightwell::python
