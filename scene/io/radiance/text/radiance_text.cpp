#include "scene/io/radiance/text/radiance_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/io/text_file.h"

namespace lightwell {
namespace {

constexpr std::string_view radiance_blanks = " \t\r\n\f\v";
// Files that were joined may have several.
constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

}  // namespace

void RadianceText::advance(std::size_t length) {
  location_.line += static_cast<int>(std::ranges::count(rest_.substr(0, length), '\n'));
  rest_.remove_prefix(length);
}

// Skips blanks and comments; returns false at the end of the text.
bool RadianceText::skip_blanks() {
  while (true) {
    advance(std::min(rest_.find_first_not_of(radiance_blanks), rest_.size()));
    if (rest_.starts_with(byte_order_mark)) {
      advance(byte_order_mark.size());
      continue;
    }
    if (!rest_.starts_with('#')) return !rest_.empty();
    advance(std::min(rest_.find('\n'), rest_.size()));
  }
}

std::string_view RadianceText::next_word() {
  if (!skip_blanks()) return {};
  const char quote = rest_.front();
  if (quote != '"' && quote != '\'') {
    const std::string_view word = rest_.substr(0, rest_.find_first_of(radiance_blanks));
    rest_.remove_prefix(word.size());
    return word;
  }
  const std::size_t end = rest_.find(quote, 1);
  if (end == std::string_view::npos) location_.fail("a quoted word does not end");
  const std::string_view word = rest_.substr(1, end - 1);
  advance(end + 1);
  return word;
}

RadianceText::Item RadianceText::next() {
  if (!skip_blanks()) return std::monostate();
  if (rest_.front() == '!') return command();
  return primitive();
}

RadianceCommand RadianceText::command() {
  RadianceCommand result{.location = location_};
  rest_.remove_prefix(1);
  while (!rest_.empty() && rest_.front() != '\n') {
    const std::size_t escaped = rest_.starts_with("\\\r\n") ? 3 : rest_.starts_with("\\\n") ? 2 : 0;
    // Other escapes are kept for the split of the command into words.
    const std::size_t length = escaped ? escaped : rest_.front() == '\\' ? 2 : 1;
    if (escaped) {
      result.text += ' ';
    } else {
      result.text += rest_.substr(0, length);
    }
    advance(std::min(length, rest_.size()));
  }
  return result;
}

std::string_view RadianceText::word_of(const RadiancePrimitive& of, std::string_view what) {
  if (!skip_blanks()) of.fail(fmt::format("ends with the file, before its {}", what));
  return next_word();
}

std::size_t RadianceText::count(const RadiancePrimitive& of, std::string_view what) {
  const std::string_view word = word_of(of, fmt::format("number of {}", what));
  const auto value = parse_finite(word);
  constexpr double most = 1e9;
  if (!value || !(*value >= 0.0 && *value <= most) ||
      *value != static_cast<double>(static_cast<std::size_t>(*value))) {
    of.fail(fmt::format("has '{}' (line {}) where the number of its {} should stand", excerpt(word),
                        location_.line, what));
  }
  return static_cast<std::size_t>(*value);
}

RadiancePrimitive RadianceText::primitive() {
  RadiancePrimitive result{.location = location_};
  result.modifier = next_word();
  result.type = next_word();
  result.name = next_word();
  const RadianceKind kind = result.kind();
  if (kind == RadianceKind::unknown) {
    result.location.fail(fmt::format(
        "{}: a modifier, a known type and a name are needed",
        is_recognised_ ? fmt::format("'{}' is no type of a primitive", excerpt(result.type))
                       : std::string("this is no primitive")));
  }
  is_recognised_ = true;
  if (kind == RadianceKind::alias) {
    result.strings.emplace_back(word_of(result, "original"));
    return result;
  }
  const std::size_t strings = count(result, "string arguments");
  for (std::size_t i = 0; i < strings; ++i) {
    result.strings.emplace_back(word_of(result, "string arguments"));
  }
  if (count(result, "integer arguments") != 0) {
    result.fail("has integer arguments, of which RADIANCE knows none; write 0");
  }
  const std::size_t reals = count(result, "real arguments");
  for (std::size_t i = 0; i < reals; ++i) {
    const std::string_view word = word_of(result, fmt::format("{} real arguments", reals));
    const auto value = parse_finite(word);
    if (!value) {
      result.fail(fmt::format("has '{}' (line {}) where real argument {} of {} should stand",
                              excerpt(word), location_.line, i + 1, reals));
    }
    result.reals.push_back(*value);
  }
  return result;
}

}  // namespace lightwell
