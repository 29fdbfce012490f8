#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "validation/validate.h"

namespace lightwell {

/// A page for screens and paper: verdict, plots, and a table for each group with the sources and
/// the reasons of the tolerances. `version` is that of the program.
std::string validation_html(const ValidationRun& run, std::string_view version);

/// Writes a file under a temporary name and renames it. Throws std::runtime_error that names the
/// file.
void write_validation(const std::filesystem::path& file, std::string_view text);

}  // namespace lightwell
