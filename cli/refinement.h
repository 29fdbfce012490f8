#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "cli/report.h"
#include "radiosity/accuracy.h"
#include "radiosity/refine/refine_solution.h"

namespace lightwell {

/// "0.5%", or the same as a share, "0.005"; nothing for what is none or not from 0.001 % to 100 %.
std::optional<double> parse_share(const std::string& text);

/// Adds --refine PERCENT|off and --max-elements N.
void add_refinement(CLI::App& command, RefineOptions& options, const std::string& group);

/// Adds --accuracy PERCENT|LUX, which chooses what --refine and --gather-rays else say: they
/// exclude it, and must be there already.
void add_accuracy(CLI::App& command, std::optional<Accuracy>& accuracy, const std::string& group);

/// The command line that repeats it, with a space before it; empty if there is none.
std::string accuracy_text(const std::optional<Accuracy>& accuracy);

/// The command line that repeats it, with a space before it.
std::string refinement_text(const RefineOptions& options);

/// For the key "refinement" of JSON.
Json refinement_json(const RefineReport& report);

}  // namespace lightwell
