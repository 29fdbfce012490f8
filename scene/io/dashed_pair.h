#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

namespace lightwell {

/// Two whole numbers with a dash between, such as 05-31 and 8-18; empty for any other text.
inline std::optional<std::pair<int, int>> dashed_pair(std::string_view text) {
  std::pair<int, int> pair;
  const char* const last = text.data() + text.size();
  const auto [dash, bad_first] = std::from_chars(text.data(), last, pair.first);
  if (bad_first != std::errc() || dash == last || *dash != '-') return std::nullopt;
  const auto [end, bad_second] = std::from_chars(dash + 1, last, pair.second);
  if (bad_second != std::errc() || end != last) return std::nullopt;
  return pair;
}

}  // namespace lightwell
