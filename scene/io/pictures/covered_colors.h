#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scene/texture.h"

namespace lightwell {

/// Texels of a picture that is cut by its alpha channel, 3 x width x height: a pixel's own colour
/// as far as its alpha covers it, else that of the covered pixels around (pull and push,
/// Gortler, Grzeszczuk, Szeliski & Cohen 1996, section 3.4). Filters that reach beyond a cut then
/// find the colour of what is cut out, and not the white or black that clear pixels happen to have.
/// `rgba` holds 4 x width x height bytes, rows from the top, and `linear` the shares of their 256
/// codes. Black if nothing is covered.
std::vector<Texture::Code> covered_colors(std::span<const unsigned char> rgba, std::size_t width,
                                          std::span<const double, 256> linear);

}  // namespace lightwell
