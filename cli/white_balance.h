#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "raytrace/display/light_meter.h"

namespace lightwell {

/// Adds --white-balance, which sets `white`.
CLI::Option* add_white_balance(CLI::App& command, WhitePoint& white, const std::string& meaning);

/// The option that repeats `white` on a command line, after a space; empty for as lit.
std::string white_balance_text(const WhitePoint& white);

}  // namespace lightwell
