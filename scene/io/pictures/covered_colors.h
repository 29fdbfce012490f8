#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scene/texture.h"

namespace lightwell {

/// RGBA bytes of a picture, rows from the top.
struct RgbaView {
  std::span<const unsigned char> bytes{};  ///< 4 x width x height
  std::size_t width = 0, height = 0;
};

/// Texels of a picture that is cut by its alpha channel, 3 x width x height: a pixel's own colour
/// as far as its alpha covers it, else that of the covered pixels around (pull and push,
/// Gortler, Grzeszczuk, Szeliski & Cohen 1996, section 3.4). Filters that reach beyond a cut then
/// find the colour of what is cut out, and not the white or black that clear pixels happen to have.
/// `linear` holds the shares of the 256 codes.
std::vector<Texture::Code> covered_colors(const RgbaView& picture,
                                          std::span<const double, 256> linear);

}  // namespace lightwell
