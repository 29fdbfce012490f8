#include "cli/numbers.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <system_error>

namespace lightwell {

std::optional<double> parsed_number(const std::string& text) {
  // std::from_chars takes no plus, which people write before stops and angles.
  const bool has_plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  const char* const last = text.data() + text.size();
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data() + (has_plus ? 1 : 0), last, value);
  if (error != std::errc() || end != last) return std::nullopt;
  return value;
}

CLI::Validator whole_number(int least, int most) {
  return CLI::Validator(
      [least, most](std::string& text) -> std::string {
        const auto value = parsed_number(text);
        return value && *value >= least && *value <= most && *value == std::floor(*value)
                   ? std::string()
                   : fmt::format("a whole number from {} to {} is needed, not '{}'", least, most,
                                 text);
      },
      std::string{});
}

CLI::Validator positive() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        const auto value = parsed_number(text);
        return value && *value > 0.0 && std::isfinite(*value)
                   ? std::string()
                   : fmt::format("a number above 0 is needed, not '{}'", text);
      },
      std::string{});
}

CLI::Validator number_within(double least, double most, std::string what) {
  return CLI::Validator(
      [least, most, what](std::string& text) -> std::string {
        const auto value = parsed_number(text);
        return value && *value >= least && *value <= most
                   ? std::string()
                   : fmt::format("{} from {:g} to {:g} is needed, not '{}'", what, least, most,
                                 text);
      },
      std::string{});
}

CLI::Validator power_of_two() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        constexpr int most = 1 << 20;
        int value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool whole = error == std::errc() && end == text.data() + text.size();
        return whole && value >= 1 && value <= most && (value & (value - 1)) == 0
                   ? std::string()
                   : fmt::format("'{}' is not a power of two from 1 to {}, such as 256, 512, 1024",
                                 text, most);
      },
      std::string{});
}

}  // namespace lightwell
