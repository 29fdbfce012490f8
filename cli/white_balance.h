#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "raytrace/light_meter.h"

namespace lightwell {

/// Adds --white-balance WHITE: "as-lit", "auto", "2700K" or "2700".
CLI::Option* add_white_balance(CLI::App& command, WhiteChoice& white);

/// The option that repeats the choice, after a space; empty for as-lit.
std::string white_text(const WhiteChoice& white);

}  // namespace lightwell
