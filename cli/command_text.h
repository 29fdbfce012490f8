#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace lightwell {

/// Kind of value of an option, for shells that complete words.
enum class ValueKind { none, word, file, folder };

/// An option or a positional argument, as manual pages and shells describe it.
struct OptionText {
  std::vector<std::string> names{};  ///< "-o", "--output"; of a positional argument: "scene"
  std::string value{};               ///< "FILE"; empty for a flag
  ValueKind kind = ValueKind::none;
  std::vector<std::string> words{};  ///< all words that the value may be; empty: not a list
  std::string group{};               ///< heading in the help; empty: left out of the help
  std::string description{};         ///< one line
  bool is_positional = false, is_required = false, may_repeat = false;
};

struct CommandText {
  std::string name{}, description{}, footer{};
  std::vector<OptionText> options{};  ///< in the order of their definition

  /// The first sentence of the description, or what stands before its first colon.
  std::string summary() const;
};

/// The texts of the program, first, and of its sub-commands.
std::vector<CommandText> command_texts(CLI::App& program);

}  // namespace lightwell
