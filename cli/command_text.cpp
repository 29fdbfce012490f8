#include "cli/command_text.h"

#include <algorithm>
#include <array>
#include <functional>
#include <string_view>

#include "cli/arguments.h"

namespace lightwell {
namespace {

std::string in_one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

// The kind of value that a name in capitals, such as FILE, stands for.
ValueKind value_kind(std::string_view name) {
  constexpr std::array<std::string_view, 3> files{"FILE", "SCENE", "SOLUTION"};
  if (name.empty()) return ValueKind::none;
  if (name == "DIR" || name == "FOLDER") return ValueKind::folder;
  const bool is_file = name.ends_with(".exr") || std::ranges::count(files, name) > 0;
  return is_file ? ValueKind::file : ValueKind::word;
}

OptionText option_text(CLI::Option& option) {
  OptionText text{.group = option.get_group(),
                  .description = in_one_line(option.get_description())};
  text.is_positional = option.get_positional();
  text.is_required = option.get_required();
  text.may_repeat = option.get_items_expected_max() > 1;
  for (const std::string& name : option.get_snames()) text.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) text.names.push_back("--" + name);
  if (text.is_positional) text.names = {option.get_name()};
  if (option.get_items_expected_max() > 0) {
    text.value = option.get_type_name().empty() ? "VALUE" : option.get_type_name();
  }
  text.kind = value_kind(text.value);
  text.words = accepted_names(option);
  return text;
}

CommandText command_text(CLI::App& command) {
  CommandText text{.name = command.get_name(),
                   .description = in_one_line(command.get_description()),
                   .footer = command.get_footer()};
  for (CLI::Option* each : command.get_options()) text.options.push_back(option_text(*each));
  return text;
}

}  // namespace

std::string CommandText::summary() const {
  std::size_t end = description.find_last_not_of('.') + 1;
  for (const char* const mark : {". ", ": "}) end = std::min(end, description.find(mark));
  return description.substr(0, end);
}

std::vector<CommandText> command_texts(CLI::App& program) {
  std::vector<CommandText> texts{command_text(program)};
  const std::function<bool(CLI::App*)> all = [](CLI::App*) { return true; };
  for (CLI::App* command : program.get_subcommands(all)) texts.push_back(command_text(*command));
  return texts;
}

}  // namespace lightwell
