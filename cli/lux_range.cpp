#include "cli/lux_range.h"

#include <fmt/format.h>

#include <charconv>

namespace lightwell {
namespace {

LuxRange parse_range(const std::string& text) {
  double low = 0.0, high = 0.0;
  const char* const last = text.data() + text.size();
  const auto [colon, bad_low] = std::from_chars(text.data(), last, low);
  if (bad_low == std::errc() && colon != last && *colon == ':') {
    const auto [end, bad_high] = std::from_chars(colon + 1, last, high);
    constexpr double most = 1e30;
    const bool rises = low >= 0.0 && low < high && high < most;
    if (bad_high == std::errc() && end == last && rises) return {.low = low, .high = high};
  }
  throw CLI::ValidationError(
      "--range", fmt::format("'{}' is no range; write LOW:HIGH, such as 0:1000, rising from 0 or "
                             "more",
                             text));
}

}  // namespace

CLI::Option* add_lux_range(CLI::App& command, std::optional<LuxRange>& range) {
  return command
      .add_option_function<std::string>(
          "--range", [&range](const std::string& text) { range = parse_range(text); },
          "ends of the false-colour scale: linear from 0, otherwise logarithmic (default: "
          "automatic)")
      ->type_name("LOW:HIGH");
}

}  // namespace lightwell
