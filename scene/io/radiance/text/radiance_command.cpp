#include "scene/io/radiance/text/radiance_command.h"

#include <fmt/format.h>

namespace lightwell {
namespace {

class PipeSplitter {
 public:
  PipeSplitter(std::string_view text, const RadianceLocation& location)
      : rest_(text), location_(location) {}

  std::vector<std::vector<std::string>> split() {
    while (!rest_.empty()) step(take());
    end_program();
    return std::move(programs_);
  }

 private:
  char take() {
    const char c = rest_.front();
    rest_.remove_prefix(1);
    return c;
  }

  void step(char c) {
    constexpr std::string_view blanks = " \t\r\n\f\v", of_a_shell = ";&<>()$`*?[{~";
    if (blanks.find(c) != std::string_view::npos) {
      end_word();
    } else if (c == '|') {
      end_program();
    } else if (c == '#' && !in_word_) {
      rest_ = {};
    } else if (c == '\'' || c == '"') {
      quoted(c);
    } else if (c == '\\') {
      if (rest_.empty()) location_.fail("the command ends with a backslash");
      add(take());
    } else if (of_a_shell.find(c) != std::string_view::npos) {
      refuse(c);
    } else {
      add(c);
    }
  }

  void quoted(char quote) {
    in_word_ = true;
    while (!rest_.empty()) {
      char c = take();
      if (c == quote) return;
      if (quote == '"' && (c == '$' || c == '`')) refuse(c);
      if (quote == '"' && c == '\\' && !rest_.empty()) c = take();
      add(c);
    }
    location_.fail("the command ends within a quoted word");
  }

  [[noreturn]] void refuse(char c) const {
    location_.fail(fmt::format(
        "the line uses '{}', which only a shell understands, and lines are never given to "
        "one; quote it if it is part of an argument",
        c));
  }

  void add(char c) {
    in_word_ = true;
    word_ += c;
  }

  void end_word() {
    if (in_word_) program_.push_back(std::move(word_));
    word_.clear();
    in_word_ = false;
  }

  void end_program() {
    end_word();
    if (program_.empty()) location_.fail("a command is missing after '!' or beside '|'");
    programs_.push_back(std::move(program_));
    program_.clear();
  }

  std::string_view rest_;
  const RadianceLocation& location_;
  bool in_word_ = false;
  std::string word_;
  std::vector<std::string> program_;
  std::vector<std::vector<std::string>> programs_;
};

}  // namespace

std::vector<std::vector<std::string>> split_radiance_pipe(std::string_view text,
                                                          const RadianceLocation& location) {
  return PipeSplitter(text, location).split();
}

}  // namespace lightwell
