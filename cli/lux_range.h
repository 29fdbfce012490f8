#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "viewer/export/appearance.h"

namespace lightwell {

/// Adds --range LOW:HIGH, the ends of a false-colour scale in lux.
CLI::Option* add_lux_range(CLI::App& command, std::optional<LuxRange>& range);

}  // namespace lightwell
