#include "cli/memory_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lightwell {
namespace {

// Bytes; empty if `text` is no amount of memory or less than 2^20 bytes.
std::optional<std::int64_t> parse_memory(const std::string& text) {
  double value = 0.0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (error != std::errc()) return std::nullopt;
  std::string unit;
  for (const char* c = end; c != last; ++c) {
    if (*c != ' ') unit += static_cast<char>(std::tolower(static_cast<unsigned char>(*c)));
  }
  static const std::vector<std::pair<std::vector<std::string>, double>> units = {
      {{"", "b"}, 1.0},
      {{"k", "kb", "kib"}, 0x1p10},
      {{"m", "mb", "mib"}, 0x1p20},
      {{"g", "gb", "gib"}, 0x1p30},
      {{"t", "tb", "tib"}, 0x1p40}};
  constexpr double least = 0x1p20, most = 0x1p60;
  for (const auto& [names, bytes] : units) {
    if (std::find(names.begin(), names.end(), unit) == names.end()) continue;
    const double asked = value * bytes;
    if (!(asked >= least && asked <= most)) return std::nullopt;
    return static_cast<std::int64_t>(asked);
  }
  return std::nullopt;
}

}  // namespace

CLI::Option* add_memory(CLI::App& command, std::int64_t& bytes) {
  return command
      .add_option_function<std::string>(
          "--memory",
          [&bytes](const std::string& text) {
            const auto asked = parse_memory(text);
            if (!asked) {
              throw CLI::ValidationError(
                  "--memory",
                  fmt::format("'{}' is no amount of memory from 1 MB up; write a number "
                              "and K, M, G or T, such as 500M or 2G",
                              text));
            }
            bytes = *asked;
          },
          "most memory of the process, such as 500M or 2G; form factors that do not fit go to disk "
          "beside the output (default: three quarters of the machine's)")
      ->type_name("SIZE");
}

}  // namespace lightwell
