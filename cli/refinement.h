#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "cli/report.h"
#include "radiosity/refine/refine_solution.h"
#include "radiosity/solve.h"

namespace lightwell {

/// Adds --refine PERCENT|off and --max-elements N.
void add_refinement(CLI::App& command, RefineOptions& options, const std::string& group);

/// Adds --accuracy PERCENT|LUX, which chooses the refinement tolerance and the gather rays. To be
/// called after --refine and --gather-rays are added: --accuracy is refused beside --gather-rays
/// and beside every --refine but "off".
void add_accuracy(CLI::App& command, std::optional<Accuracy>& accuracy, const std::string& group);

/// Command-line option that repeats the accuracy, after a space; "" if `accuracy` is empty.
std::string accuracy_text(const std::optional<Accuracy>& accuracy);

/// Command-line options that repeat the refinement, after a space.
std::string refinement_text(const RefineOptions& options);

/// Value of the JSON key "refinement".
Json refinement_json(const RefineReport& report);

}  // namespace lightwell
