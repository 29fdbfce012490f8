#pragma once

#include <toml++/toml.h>

#include <string>

#include "scene/io/text_file.h"

namespace lightwell {

/// Parses a TOML file. Throws InputError "file:line:column: fault", also for keys of so many parts
/// that the parser would exhaust the stack.
toml::table parse_toml(const TextFile& file);

/// The same for a text in memory. Throws InputError "line:column: fault", or "line: fault" for such
/// a key.
toml::table parse_toml_text(const std::string& text);

}  // namespace lightwell
