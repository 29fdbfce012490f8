#include "cli/white_balance.h"

#include <fmt/format.h>

#include <string_view>

#include "scene/io/text_file.h"

namespace lightwell {
namespace {

// The white point named by `words`: "as-lit", "auto", "2700K" or "2700".
WhitePoint parse_white(const std::string& words) {
  using Kind = WhitePoint::Kind;
  if (words == "as-lit") return {};
  if (words == "auto") return {.kind = Kind::automatic};
  std::string_view number = words;
  if (number.ends_with('K') || number.ends_with('k')) number.remove_suffix(1);
  const auto kelvin = parse_finite(number);
  if (!kelvin || !(*kelvin >= coldest_white && *kelvin <= hottest_white)) {
    throw CLI::ValidationError(
        "--white-balance",
        fmt::format("'as-lit', 'auto' or a temperature from {:g}K to {:g}K is needed, not '{}'",
                    coldest_white, hottest_white, words));
  }
  return {.kind = Kind::black_body, .kelvin = *kelvin};
}

}  // namespace

CLI::Option* add_white_balance(CLI::App& command, WhitePoint& white, const std::string& meaning) {
  return command
      .add_option_function<std::string>(
          "--white-balance", [&white](const std::string& words) { white = parse_white(words); },
          meaning)
      ->type_name("WHITE");
}

std::string white_balance_text(const WhitePoint& white) {
  switch (white.kind) {
    case WhitePoint::Kind::automatic:
      return " --white-balance auto";
    case WhitePoint::Kind::black_body:
      return fmt::format(" --white-balance {:g}K", white.kelvin);
    case WhitePoint::Kind::as_lit:
      break;
  }
  return "";
}

}  // namespace lightwell
