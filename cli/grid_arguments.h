#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "viewer/report/requested_grids.h"

namespace lightwell {

/// Reads NAME@NUMBER or NAME=NUMBER, by the `mark` between name and number. Throws
/// CLI::ValidationError of `option` for a number below `least`.
NamedNumber named_number(const std::string& text, char mark, const char* option, double least);

/// Options that name surfaces, and planes above surfaces, with a grid of points each.
struct GridArguments {
  GridRequest request{};  ///< in the scene file's unit

  /// Adds --surface, --plane, --margin and --spacing. The object must outlive the command.
  void add_to(CLI::App& command);
  /// The request in metres.
  GridRequest in_metres(const Scene& scene) const;
};

/// Adds "--watts NAME=W", the electric power of luminaires, which may be repeated. `watts` must
/// outlive the command.
void add_watts(CLI::App& command, std::vector<NamedNumber>& watts);

}  // namespace lightwell
