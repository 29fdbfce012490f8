#include "scene/io/toml/toml_document.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/errors.h"

namespace lightwell {
namespace {

// The parser calls itself for each part of a dotted key, and has no limit. Keys of a scene have few
// parts.
void refuse_deep_keys(const TextFile& file) {
  constexpr std::ptrdiff_t most_parts = 100;
  file.for_each_line([&](int line, std::string_view text) {
    constexpr std::string_view in_keys =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.\"'[] \t";
    const std::string_view key = text.substr(0, text.find_first_not_of(in_keys));
    if (std::ranges::count(key, '.') < most_parts) return;
    throw InputError(fmt::format("{}:{}: the key has more than {} parts", file.path().string(),
                                 line, most_parts));
  });
}

}  // namespace

toml::table parse_toml(const TextFile& file) {
  refuse_deep_keys(file);
  try {
    return toml::parse(file.text(), file.path().string());
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}:{}: {}", file.path().string(), error.source().begin.line,
                                 error.source().begin.column, error.description()));
  }
}

toml::table parse_toml_text(const std::string& text) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}: {}", error.source().begin.line,
                                 error.source().begin.column, error.description()));
  }
}

}  // namespace lightwell
