#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "cli/console.h"

namespace lightwell {

/// How the program ends.
enum ExitCode {
  exit_done = 0,
  exit_failed = 1,
  exit_wrong_usage = 2,
  exit_bad_input = 3,
  exit_not_accurate = 4,  ///< the solver stopped before the asked accuracy; what it has is written
  exit_interrupted = 130,
};

/// What a sub-command does once its arguments are parsed; returns an ExitCode.
using Action = std::function<int(Console& console)>;

// Each adds the sub-command's arguments, description and example to `command`, and returns what it
// does.
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
Action add_form_factors(CLI::App& command);
Action add_info(CLI::App& command);

}  // namespace lightwell
