#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radiosity/solve.h"

namespace lightwell {

// Options of a solve as words, the same on the command line and in other languages.

/// The share in `text`: 0.005 for "0.5%" and for "0.005". Empty if `text` is not a share from
/// 0.001 % to 100 %.
std::optional<double> parse_share(const std::string& text);

/// The accuracy in `text`: a share of the mean irradiance, "1%", or an illuminance, "5lx". Throws
/// std::invalid_argument with a sentence for any other text, and for a number without unit that
/// means per cent more probably than a share: "1".
Accuracy parse_accuracy(const std::string& text);

/// Names of the solvers: those of solver_methods, and "progressive" for progressive refinement.
std::vector<std::string> solver_names();

/// Sets the solver of that name; progressive refinement takes the tolerance of `options.solver`.
/// Throws std::invalid_argument that lists the names of solver_methods for any other name.
void choose_solver(std::string_view name, SolveOptions& options);

}  // namespace lightwell
