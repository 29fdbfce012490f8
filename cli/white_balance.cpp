#include "cli/white_balance.h"

#include <fmt/format.h>

#include <string_view>

#include "scene/io/text_file.h"

namespace lightwell {
namespace {

WhiteChoice parse_white(const std::string& words) {
  using Kind = WhiteChoice::Kind;
  if (words == "as-lit") return {.kind = Kind::as_lit};
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

CLI::Option* add_white_balance(CLI::App& command, WhiteChoice& white) {
  return command
      .add_option_function<std::string>(
          "--white-balance", [&white](const std::string& words) { white = parse_white(words); },
          "light that shows white in the picture: as-lit (default), auto, or a temperature such as "
          "2700K")
      ->type_name("WHITE");
}

std::string white_text(const WhiteChoice& white) {
  switch (white.kind) {
    case WhiteChoice::Kind::automatic:
      return " --white-balance auto";
    case WhiteChoice::Kind::black_body:
      return fmt::format(" --white-balance {:g}K", white.kelvin);
    case WhiteChoice::Kind::as_lit:
      break;
  }
  return "";
}

}  // namespace lightwell
