#pragma once

#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/journal/run_control.h"

namespace lightwell {

/// Irradiance at every vertex (vertices x columns, W/m^2) from the lights of DirectLight through
/// mirrors and glass. The rays of each light leave their power on the elements that they meet
/// behind the first one (after Heckbert 1990), and a vertex takes the power of the elements around
/// it over their area. Mirrors and glass get it, too: no ray reads it there, but it is their
/// irradiance. A light casts `rays` times the root of its share of its channel's power, at least
/// 4096 if `rays` are more. Light straight through ClearPanes is left out, since it is direct
/// light, and so is that of the sky's dome. Empty if the scene has no mirrors or glass. Throws
/// Interrupted when progress says stop.
BandArray caustic_irradiance(const LitScene& lit, int rays, int max_specular_depth,
                             const RunControl& run = {});

}  // namespace lightwell
