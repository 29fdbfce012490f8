#pragma once

#include <span>
#include <string>
#include <vector>

#include "cli/command_text.h"

namespace lightwell {

/// "bash", "zsh" and "fish".
std::vector<std::string> completing_shells();

/// A script that lets the shell complete commands, options, and those values that are files,
/// folders or words of a list. The first entry is the program. Throws std::invalid_argument for
/// another shell.
std::string completion_script(const std::string& shell,
                              std::span<const CommandText> program_and_commands);

}  // namespace lightwell
