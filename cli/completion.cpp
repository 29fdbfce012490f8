#include "cli/completion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>

namespace lightwell {
namespace {

using Commands = std::span<const CommandText>;

std::vector<std::string> names_of(Commands commands) {
  std::vector<std::string> names;
  for (const CommandText& command : commands) names.push_back(command.name);
  return names;
}

// `text` without the characters in `special`, which a shell would read as its own.
std::string without(std::string text, std::string_view special) {
  std::erase_if(text, [&](char c) { return special.find(c) != std::string_view::npos; });
  return text;
}

// --- bash

// A branch of `case` that completes the value of an option.
std::string bash_value(const OptionText& option) {
  const std::string head = fmt::format("        {}) ", fmt::join(option.names, "|"));
  if (!option.words.empty()) {
    return fmt::format("{}words='{}' ;;\n", head, fmt::join(option.words, " "));
  }
  switch (option.kind) {
    case ValueKind::file:
      return head + "kind=file ;;\n";
    case ValueKind::folder:
      return head + "kind=directory ;;\n";
    case ValueKind::word:
      return head + "return ;;\n";
    case ValueKind::none:
      return {};
  }
  return {};
}

std::string bash_command(const CommandText& command) {
  std::string values, arguments;
  std::vector<std::string> options;
  for (const OptionText& option : command.options) {
    if (option.is_positional) {
      if (!option.words.empty()) arguments += fmt::format("{} ", fmt::join(option.words, " "));
      continue;
    }
    options.insert(options.end(), option.names.begin(), option.names.end());
    values += bash_value(option);
  }
  return fmt::format(
      "    {})\n      options='{}' arguments='{}'\n      case $before in\n{}      esac ;;\n",
      command.name, fmt::join(options, " "), arguments, values);
}

std::string bash_script(Commands all) {
  std::string branches;
  for (const CommandText& command : all.subspan(1)) branches += bash_command(command);
  return fmt::format(
      R"(# Completion of lightwell in bash: source this file, or put it into the folder of completions.
_lightwell() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} command=${{COMP_WORDS[1]}}
  local commands='{}' options='' arguments='' words='' kind=''
  COMPREPLY=()
  # Bash parts a word at '='.
  if [ "$word" = = ]; then
    word=''
  elif [ "$before" = = ]; then
    before=${{COMP_WORDS[COMP_CWORD-2]}}
  fi
  if [ "$COMP_CWORD" = 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W "help $commands --help --version" -- "$word")
    return
  fi
  case $command in
    help) words=$commands ;;
{}  esac
  if [ -z "$words$kind" ]; then
    case $word in
      -*) words=$options ;;
      *) words=$arguments kind=file ;;
    esac
  fi
  if [ -n "$words" ]; then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  else
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -A "$kind" -- "$word")
  fi
}}
complete -F _lightwell lightwell
)",
      fmt::join(names_of(all.subspan(1)), " "), branches);
}

// --- zsh

// The part of a specification of _arguments that completes a value.
std::string zsh_value(const OptionText& option) {
  if (!option.words.empty()) {
    return fmt::format(":{}:({})", option.value, fmt::join(option.words, " "));
  }
  switch (option.kind) {
    case ValueKind::file:
      return ":file:_files";
    case ValueKind::folder:
      return ":folder:_files -/";
    case ValueKind::word:
      return fmt::format(":{}: ", without(option.value, ":[]'\""));
    case ValueKind::none:
      return {};
  }
  return {};
}

std::string zsh_option(const OptionText& option) {
  const std::string text = without(option.description, "'[]:");
  std::string lines;
  for (const std::string& name : option.names) {
    lines += fmt::format("        '*{}[{}]{}' \\\n", name, text, zsh_value(option));
  }
  return lines;
}

std::string zsh_script(Commands all) {
  std::string list, branches;
  for (const CommandText& command : all.subspan(1)) {
    list += fmt::format("    '{}:{}'\n", command.name, without(command.summary(), "'"));
    std::string options, arguments = ":file:_files";
    for (const OptionText& option : command.options) {
      if (!option.is_positional) options += zsh_option(option);
      if (option.is_positional && !option.words.empty()) arguments = zsh_value(option);
    }
    branches += fmt::format("    {})\n      _arguments -s \\\n{}        '*{}' ;;\n", command.name,
                            options, arguments);
  }
  return fmt::format(
      R"(#compdef lightwell
# Completion of lightwell in zsh: put this file, named _lightwell, into a folder of $fpath.
_lightwell() {{
  local -a commands
  commands=(
    'help:Explains a command'
{})
  if (( CURRENT == 2 )); then
    _describe command commands
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
    help) _describe command commands ;;
{}  esac
}}
_lightwell "$@"
)",
      list, branches);
}

// --- fish

// A text in single quotes, in which fish reads backslashes and quotes only.
std::string fish_quoted(const std::string& text) {
  return fmt::format("'{}'", without(text, "'\\"));
}

std::string fish_option(const CommandText& command, const OptionText& option) {
  std::string line =
      fmt::format("complete -c lightwell -n '__fish_seen_subcommand_from {}'", command.name);
  for (const std::string& name : option.names) {
    if (option.is_positional) break;
    const bool is_long = name.starts_with("--");
    line += fmt::format(" -{} {}", is_long ? "l" : "s", name.substr(is_long ? 2 : 1));
  }
  if (!option.words.empty()) {
    line += fmt::format(" -x -a '{}'", fmt::join(option.words, " "));
  } else if (option.kind == ValueKind::folder) {
    line += " -x -a '(__fish_complete_directories)'";
  } else if (option.kind == ValueKind::file) {
    line += " -r -F";
  } else if (option.kind == ValueKind::word) {
    line += " -x";
  }
  return fmt::format("{} -d {}\n", line, fish_quoted(option.description));
}

std::string fish_script(Commands all) {
  std::string lines =
      "# Completion of lightwell in fish: put this file, named lightwell.fish, into a folder of\n"
      "# completions.\n";
  lines += fmt::format(
      "complete -c lightwell -f -n __fish_use_subcommand -a help -d 'Explains a command'\n"
      "complete -c lightwell -f -n '__fish_seen_subcommand_from help' -a '{}'\n",
      fmt::join(names_of(all.subspan(1)), " "));
  for (const CommandText& command : all.subspan(1)) {
    lines += fmt::format("complete -c lightwell -f -n __fish_use_subcommand -a {} -d {}\n",
                         command.name, fish_quoted(command.summary()));
    for (const OptionText& option : command.options) {
      if (!option.is_positional || !option.words.empty()) lines += fish_option(command, option);
    }
  }
  return lines;
}

}  // namespace

std::vector<std::string> completing_shells() {
  return {"bash", "zsh", "fish"};
}

std::string completion_script(const std::string& shell, Commands program_and_commands) {
  if (shell == "bash") return bash_script(program_and_commands);
  if (shell == "zsh") return zsh_script(program_and_commands);
  if (shell == "fish") return fish_script(program_and_commands);
  throw std::invalid_argument(
      fmt::format("there is no completion for the shell '{}'; choose from: {}", shell,
                  fmt::join(completing_shells(), ", ")));
}

}  // namespace lightwell
