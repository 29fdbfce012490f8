#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace lightwell {

/// A line of a scene text, for messages.
struct PovPlace {
  const std::filesystem::path* file = nullptr;
  int line = 0;

  /// Throws InputError "file:line: problem".
  [[noreturn]] void fail(std::string_view problem) const;
  /// Throws LimitError "file:line: problem".
  [[noreturn]] void fail_limit(std::string_view problem) const;
};

/// A word, number, string, sign or directive ("#if", without the sign #) of a scene text.
struct PovToken {
  enum class Kind : std::uint8_t { word, number, string, sign, directive, end };
  Kind kind = Kind::end;
  int line = 0;
  std::string_view text{};  ///< of a string: between its quotation marks
  double number = 0.0;

  bool is_sign(std::string_view sign) const { return kind == Kind::sign && text == sign; }
  bool is_word(std::string_view word) const { return kind == Kind::word && text == word; }
};

/// A scene text as tokens, which refer to it.
class PovText {
 public:
  /// Throws InputError with file and line for a comment or a string without an end, a number that
  /// is none, or a character that begins no token.
  PovText(const std::filesystem::path& path, std::string text);
  PovText(const PovText&) = delete;
  PovText& operator=(const PovText&) = delete;

  const std::filesystem::path& path() const { return path_; }
  const std::vector<PovToken>& tokens() const { return tokens_; }

 private:
  void skip_comment();
  void skip_blanks();
  PovToken next_token();
  PovToken number();
  PovToken string();
  char look(std::size_t ahead = 0) const {
    return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
  }
  [[noreturn]] void fail(std::string_view problem) const;

  std::filesystem::path path_;
  std::string text_;
  std::size_t at_ = 0;
  int line_ = 1;
  std::vector<PovToken> tokens_{};
};

}  // namespace lightwell
