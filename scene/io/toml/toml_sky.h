#pragma once

#include "scene/io/toml/toml_spectra.h"
#include "scene/io/toml/toml_value.h"
#include "scene/sky.h"

namespace lightwell {

/// Reads the [sky] table of a native file (docs/daylight.md). Throws InputError naming place and
/// value.
Sky read_toml_sky(const TomlValue& value, const TomlBands& bands);

}  // namespace lightwell
