#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/io/radiance/text/radiance_primitive.h"

namespace lightwell {

/// Splits a command into the programs of a pipe, each with its arguments. Quotes and backslashes
/// protect characters as in a shell. Other shell syntax (variables, redirection, several commands,
/// file name patterns) throws. No program is run. Throws InputError naming the place.
std::vector<std::vector<std::string>> split_radiance_pipe(std::string_view text,
                                                          const RadianceLocation& location);

}  // namespace lightwell
