#include "scene/io/pov/pov_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "scene/errors.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool begins_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

}  // namespace

void PovPlace::fail(std::string_view problem) const {
  throw InputError(fmt::format("{}:{}: {}", file->string(), line, problem));
}

void PovPlace::fail_limit(std::string_view problem) const {
  throw LimitError(fmt::format("{}:{}: {}", file->string(), line, problem));
}

PovText::PovText(const std::filesystem::path& path, std::string text)
    : path_(path), text_(std::move(text)) {
  if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;  // byte order mark
  for (skip_blanks(); at_ < text_.size(); skip_blanks()) tokens_.push_back(next_token());
}

void PovText::fail(std::string_view problem) const {
  PovPlace{.file = &path_, .line = line_}.fail(problem);
}

// Comments between /* and */ are nested.
void PovText::skip_comment() {
  const int first = line_;
  int depth = 0;
  do {
    if (at_ >= text_.size()) {
      line_ = first;
      fail("a comment begins with '/*' and has no end; write '*/' behind it");
    }
    const bool opens = look() == '/' && look(1) == '*', closes = look() == '*' && look(1) == '/';
    depth += opens ? 1 : closes ? -1 : 0;
    if (look() == '\n') ++line_;
    at_ += opens || closes ? 2 : 1;
  } while (depth > 0);
}

void PovText::skip_blanks() {
  while (at_ < text_.size()) {
    const char c = look();
    if (c == '/' && look(1) == '*') {
      skip_comment();
    } else if (c == '/' && look(1) == '/') {
      while (at_ < text_.size() && look() != '\n') ++at_;
    } else if (c == ' ' || (c >= '\t' && c <= '\r') || c == '\x1a') {  // 1a ends files of DOS
      if (c == '\n') ++line_;
      ++at_;
    } else {
      return;
    }
  }
}

PovToken PovText::next_token() {
  const char c = look();
  if (is_digit(c) || (c == '.' && is_digit(look(1)))) return number();
  if (c == '"') return string();
  const std::string_view text = text_;
  const auto word_at = [&](std::size_t first) {
    std::size_t end = first;
    while (end < text.size() && (begins_word(text[end]) || is_digit(text[end]))) ++end;
    return text.substr(first, end - first);
  };
  PovToken token{.kind = PovToken::Kind::word, .line = line_};
  if (begins_word(c)) {
    token.text = word_at(at_);
    at_ += token.text.size();
    return token;
  }
  if (c == '#') {
    for (++at_; look() == ' ' || look() == '\t';) ++at_;
    token.kind = PovToken::Kind::directive;
    token.text = word_at(at_);
    if (token.text.empty()) fail("'#' is followed by no word");
    at_ += token.text.size();
    return token;
  }
  constexpr std::string_view signs = "{}[]()<>,;=+-*/^.!?:&|";
  if (signs.find(c) == std::string_view::npos) {
    const bool is_printable = c > ' ' && c <= '~';
    fail(fmt::format("{} begins nothing that is known here",
                     is_printable
                         ? fmt::format("the character '{}'", c)
                         : fmt::format("the byte {:#04x}", static_cast<unsigned char>(c))));
  }
  constexpr std::array<std::string_view, 3> pairs = {"<=", ">=", "!="};
  const bool is_pair = std::ranges::find(pairs, text.substr(at_, 2)) != pairs.end();
  token.kind = PovToken::Kind::sign;
  token.text = text.substr(at_, is_pair ? 2 : 1);
  at_ += token.text.size();
  return token;
}

PovToken PovText::number() {
  std::size_t end = at_;
  const auto digits = [&] {
    while (end < text_.size() && is_digit(text_[end])) ++end;
  };
  digits();
  if (end < text_.size() && text_[end] == '.') {
    ++end;
    digits();
  }
  if (end < text_.size() && (text_[end] == 'e' || text_[end] == 'E')) {
    std::size_t power = end + 1;
    if (power < text_.size() && (text_[power] == '+' || text_[power] == '-')) ++power;
    if (power < text_.size() && is_digit(text_[power])) {
      end = power;
      digits();
    }
  }
  const std::string_view text = std::string_view(text_).substr(at_, end - at_);
  const auto value = parse_finite(text);
  if (!value) fail(fmt::format("'{}' is no finite number", excerpt(text)));
  at_ = end;
  return {.kind = PovToken::Kind::number, .line = line_, .text = text, .number = *value};
}

PovToken PovText::string() {
  std::size_t end = at_ + 1;
  while (end < text_.size() && text_[end] != '"' && text_[end] != '\n') {
    end += text_[end] == '\\' && end + 1 < text_.size() && text_[end + 1] != '\n' ? 2 : 1;
  }
  if (end >= text_.size() || text_[end] != '"') fail("a string has no end; write '\"' behind it");
  const std::string_view text = std::string_view(text_).substr(at_ + 1, end - at_ - 1);
  at_ = end + 1;
  return {.kind = PovToken::Kind::string, .line = line_, .text = text};
}

}  // namespace lightwell
