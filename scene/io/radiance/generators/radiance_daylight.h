#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/io/radiance/text/radiance_primitive.h"
#include "scene/io/remarks.h"

namespace lightwell {

/// True for the programs of RADIANCE that pass_radiance_sky() evaluates: gensky and gendaylit.
bool is_radiance_sky(std::string_view program);

/// Passes the output of gensky or gendaylit to `sink`: a material "solar" and a source "sun" where
/// the sun shines, and the pattern "skyfunc", a brightfunc of skybright.cal or perezlum.cal.
/// Options are those of the reference manual. Throws InputError naming the place for invalid
/// arguments.
void pass_radiance_sky(const std::vector<std::string>& words, const RadianceLocation& location,
                       Remarks& remarks, const RadianceSink& sink);

}  // namespace lightwell
