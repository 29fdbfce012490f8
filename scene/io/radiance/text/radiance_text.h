#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "scene/io/radiance/text/radiance_primitive.h"

namespace lightwell {

/// A command line without its leading exclamation mark, continuation lines joined.
struct RadianceCommand {
  std::string text{};
  RadianceLocation location{};
};

/// Splits the text of a RADIANCE file into primitives and commands. Words are separated by blanks
/// of any kind and may be quoted; # begins a comment where a word could begin.
class RadianceText {
 public:
  using Item = std::variant<std::monostate, RadiancePrimitive, RadianceCommand>;

  /// `text` and `file` must outlive everything read from them.
  RadianceText(std::string_view text, const std::filesystem::path& file)
      : rest_(text), location_{&file, 1} {}

  /// The next item; std::monostate at the end. Throws InputError naming file and line.
  Item next();
  /// The next word, or an empty one at the end of the text.
  std::string_view next_word();
  /// Position of the last word.
  const RadianceLocation& location() const { return location_; }

 private:
  bool skip_blanks();
  RadianceCommand command();
  RadiancePrimitive primitive();
  std::string_view word_of(const RadiancePrimitive& of, std::string_view what);
  std::size_t count(const RadiancePrimitive& of, std::string_view what);
  void advance(std::size_t length);

  std::string_view rest_;
  bool is_recognised_ = false;  // a primitive was read: messages may quote words of the file
  RadianceLocation location_;
};

}  // namespace lightwell
