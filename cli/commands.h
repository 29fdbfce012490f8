#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "cli/console.h"

namespace lightwell {

/// Exit codes of the program.
enum ExitCode {
  exit_done = 0,
  exit_failed = 1,
  exit_wrong_usage = 2,
  exit_bad_input = 3,
  exit_not_accurate = 4,  ///< the results are written, but the solver stopped above the tolerance
                          ///< or the estimated error is above --accuracy or --target-error
  exit_interrupted = 130,
};

/// Runs a sub-command whose arguments are parsed, and returns an ExitCode.
using Action = std::function<int(Console& console)>;

// Each function adds the sub-command's arguments, description and example to `command`, and returns
// the sub-command's action.
Action add_run(CLI::App& command);
Action add_solve(CLI::App& command);
Action add_mesh(CLI::App& command);
Action add_relight(CLI::App& command);
Action add_render(CLI::App& command);
Action add_probe(CLI::App& command);
Action add_view(CLI::App& command);
Action add_export(CLI::App& command);
Action add_report(CLI::App& command);
Action add_compare(CLI::App& command);
Action add_design(CLI::App& command);
Action add_road(CLI::App& command);
Action add_daylight(CLI::App& command);
Action add_form_factors(CLI::App& command);
Action add_radiation(CLI::App& command);
Action add_shortwave(CLI::App& command);
Action add_info(CLI::App& command);
Action add_demo(CLI::App& command);
Action add_completion(CLI::App& command);
Action add_manual(CLI::App& command);
Action add_validate(CLI::App& command);

}  // namespace lightwell
