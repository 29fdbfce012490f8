#include "scene/io/toml/toml_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "scene/errors.h"

namespace lightwell {
namespace {

// The parser calls itself for each part of a dotted key, and has no limit. Keys of a scene have few
// parts.
void refuse_deep_keys(std::string_view text, const std::string& file) {
  constexpr std::ptrdiff_t most_parts = 100;
  constexpr std::string_view in_keys =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.\"'[] \t";
  for (int line = 1; !text.empty(); ++line) {
    const std::string_view key = text.substr(0, text.find_first_not_of(in_keys));
    if (std::ranges::count(key, '.') >= most_parts) {
      throw InputError(fmt::format("{}{}: the key has more than {} parts",
                                   file.empty() ? "" : file + ":", line, most_parts));
    }
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  }
}

}  // namespace

toml::table parse_toml(const TextFile& file) {
  refuse_deep_keys(file.text(), file.path().string());
  try {
    return toml::parse(file.text(), file.path().string());
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}:{}: {}", file.path().string(), error.source().begin.line,
                                 error.source().begin.column, error.description()));
  }
}

toml::table parse_toml_text(const std::string& text) {
  refuse_deep_keys(text, {});
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}: {}", error.source().begin.line,
                                 error.source().begin.column, error.description()));
  }
}

}  // namespace lightwell
