#pragma once

#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/kept_gathers.h"
#include "radiosity/pilot_gathers.h"
#include "radiosity/solve.h"

namespace lightwell {

/// The final gather at the vertices of `pilot`; the caster of `lit` is of their mesh. Fills in the
/// irradiances, gather noise and interpolation error of `solution`.
///
/// - Direct light is the pilot gather's, unless that cast fewer shadow rays than `options` ask for.
/// - Indirect light of a refined mesh is gathered twice. The pilot gather read the light of
///   unrefined elements, in the same few directions all over a surface. A second pilot gather with
///   an eighth of the rays reads the first, and the final gather reads the second.
/// - On unread_patches() there is the final gather alone, on crumbs with a 32nd of the rays.
/// - With channels, the light of each is filled in, and relight() forms the sum.
///
/// Work in `kept` (null: none) is not repeated, and new work is added to it. Throws Interrupted
/// when progress says stop.
void reconstruct(const LitScene& lit, const SolveOptions& options, const PilotGather& pilot,
                 RadiositySolution& solution, KeptGathers* kept = nullptr);

/// Fills in the irradiances of `solution` for want of time, in place of reconstruct(): with the
/// light of the pilot gather, and of the final gathers in `kept` at the vertices that have any
/// (null: none). Vertices that the pilot gather left out share a gather of few rays on each patch.
/// Errors are left to the error estimate: gather noise is 0, and the interpolation error is empty.
/// Throws Interrupted when progress says stop.
void take_pilot_light(const LitScene& lit, const SolveOptions& options, const PilotGather& pilot,
                      KeptGathers* kept, RadiositySolution& solution);

}  // namespace lightwell
