#pragma once

#include <span>
#include <string>

#include "cli/command_text.h"

namespace lightwell {

/// The manual page (section 1, macros of man(7)) of a sub-command. Options that its --help leaves
/// out, so that the help fits a screen, are on the page too.
std::string man_page(const CommandText& command);

/// The manual page of the program: a line for each of its sub-commands, and exit codes.
std::string man_page_of_program(std::span<const CommandText> program_and_commands);

}  // namespace lightwell
