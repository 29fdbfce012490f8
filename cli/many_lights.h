#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "radiosity/solve.h"

namespace lightwell {

/// Adds --many-lights METHOD, which sets ShadowOptions::many_lights of the gather and the clusters
/// of form factors.
void add_many_lights(CLI::App& command, SolveOptions& options, const std::string& group);

/// " --many-lights METHOD", "" for lightcuts.
std::string many_lights_text(const SolveOptions& options);

}  // namespace lightwell
