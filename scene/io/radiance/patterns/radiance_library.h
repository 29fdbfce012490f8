#pragma once

#include <string_view>

namespace lightwell {

/// Definitions that a function file of RADIANCE's library makes, for patterns that depend on
/// direction: "rayinit.cal", which every formula may use, "skybright.cal", "perezlum.cal",
/// "source.cal" and "illum.cal". Empty for other names.
std::string_view radiance_library(std::string_view file);

}  // namespace lightwell
