#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "radiosity/solution/cues.h"
#include "raytrace/shading/drawn_lamps.h"
#include "viewer/export/appearance.h"
#include "viewer/export/baked_model.h"

namespace lightwell {

/// `value`, or 0 where it is infinite or no number: files hold finite numbers only.
inline float finite_or_black(float value) {
  return std::isfinite(value) ? value : 0.0f;
}

/// element_kinds with every channel on at scale 1: an element that a channel lights counts as lit
/// even while the channel is off. Without channels, element_kinds of the solution.
std::vector<ElementKind> kinds_with_all_on(const SolvedScene& solved,
                                           const std::vector<Material>& materials);

/// Bands of the linear RGB that `bands` are shown in: RGB bands themselves, for wavelengths Rec.
/// 709 with the same luminous efficacy.
Bands shown_bands(const Bands& bands);

/// Illuminance as lx of red, green and blue, whose sum is the illuminance: Y of each primary in the
/// linear RGB of irradiance (rows x bands, W/m^2).
RgbArray illuminance_shares(const BandArray& irradiance, const Bands& bands);
/// E at the vertices, W/m^2, vertices x bands, with every channel on at scale 1.
BandArray irradiance_with_all_on(const RadiositySolution& solution);

/// Sky and sun of a scene; empty without a sky.
std::optional<BakedSky> bake_sky(const SolvedScene& solved, const Scene& scene);

/// Faces of luminaires with their light. A face of a body that no light falls on, of any channel,
/// is left out.
std::vector<BakedLampFace> bake_lamps(const SolvedScene& solved,
                                      const std::vector<Material>& materials,
                                      const DrawnLamps& lamps);

/// Cues of a solution for the model that is baked from it. Throws InputError for a cue that needs
/// another spectrum of a channel than the solution has, which weights cannot give.
std::vector<BakedCue> bake_cues(const RadiositySolution& solution, const std::vector<Cue>& cues);

/// Light of each channel at the mesh's vertices in `mesh_vertex`, in their order. Empty without
/// channels.
std::vector<BakedChannel> bake_channels(const SolvedScene& solved,
                                        const std::vector<Material>& materials,
                                        const std::vector<int>& mesh_vertex);

}  // namespace lightwell
