#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/report.h"
#include "radiosity/refine_solution.h"

namespace lightwell {

/// Adds --refine PERCENT|off and --max-elements N.
void add_refinement(CLI::App& command, RefineOptions& options, const std::string& group);

/// The command line that repeats it, with a space before it.
std::string refinement_text(const RefineOptions& options);

/// For the key "refinement" of JSON.
Json refinement_json(const RefineReport& report);

}  // namespace lightwell
