#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/bands.h"

namespace lightwell {

/// Refractive index in the visible of a material by its Mitsuba name ("bk7", "water"); empty for an
/// unknown name.
std::optional<double> index_preset(std::string_view name);
std::vector<std::string> index_preset_names();

/// Reflectance at normal incidence (r, g, b) of a metal by its Mitsuba name ("Au"); "none" is the
/// perfect mirror. Empty for an unknown name.
std::optional<Spectrum> metal_preset(std::string_view name);

}  // namespace lightwell
