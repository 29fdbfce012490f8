#pragma once

#include "scene/bands.h"

namespace lightwell {

/// Complex index of refraction of a metal, eta + i k per band, over that of the air before.
struct Conductor {
  Spectrum eta{};  ///< >= 0, at most highest_metal_index
  Spectrum k{};    ///< >= 0, at most highest_metal_index
};
inline constexpr float highest_metal_index = 1e3f;

/// Fresnel's reflectance, [0,1], of unpolarised light at `cosine`, [0,1], to the normal (Born &
/// Wolf, 14.2). 1 where eta and k are 0.
Spectrum reflectance_at(const Conductor& metal, double cosine);

/// Reflectance of even light from the whole hemisphere, 2 int R(cos) cos dcos.
Spectrum mean_reflectance(const Conductor& metal);

}  // namespace lightwell
