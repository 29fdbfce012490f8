#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/io/radiance/radiance_primitive.h"

namespace lightwell {

/// The programs of a pipe, each with its arguments. Quotes and backslashes protect characters as in
/// a shell; whatever else only a shell could do (variables, redirection, several commands, patterns
/// of file names) is refused. Nothing is run. Throws InputError naming the place.
std::vector<std::vector<std::string>> split_radiance_pipe(std::string_view text,
                                                          const RadianceLocation& location);

}  // namespace lightwell
