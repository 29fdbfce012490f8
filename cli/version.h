#pragma once

#include <string>

#include "cli/report.h"

namespace lightwell {

/// "lightwell VERSION", followed by a line "NAME VERSION" for each library that the program was
/// compiled with.
std::string version_text();

/// An object with "version", the program's, and "libraries", an object of versions by name.
Json version_json();

}  // namespace lightwell
