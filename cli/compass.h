#pragma once

#include <CLI/CLI.hpp>

namespace lightwell {

/// Adds --north DEGREES.
void add_north(CLI::App& command, double& north_degrees);

}  // namespace lightwell
