#pragma once

#include <toml++/toml.h>

#include "scene/io/text_file.h"

namespace lightwell {

/// Parses a TOML file. Throws InputError "file:line:column: fault", also for keys of so many parts
/// that the parser would exhaust the stack.
toml::table parse_toml(const TextFile& file);

}  // namespace lightwell
