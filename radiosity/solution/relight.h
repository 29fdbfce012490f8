#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "radiosity/solution/solution.h"

namespace lightwell {

/// What becomes of a channel, against the scene as it was solved.
struct ChannelSetting {
  double factor = 1.0;                     ///< of its luminous flux, >= 0
  std::optional<Eigen::Array3f> colour{};  ///< linear sRGB, >= 0, of any brightness; unset: its own
};

/// "0.3", "off", "on", "#ffd9b0" (sRGB, linearised) or "0.3,#ffd9b0". Throws std::invalid_argument
/// that says what is wrong with anything else.
ChannelSetting channel_setting(std::string_view text);

/// Factor of a channel's emission in each band, s_k = factor * a * colour_k: a filter of that
/// colour before its emitters, with the power raised by the `a` that keeps the luminous flux, so
/// that Y(a colour Phi) = Y(Phi) for its flux Phi. White light takes on the colour itself.
///
/// Throws InputError for a colour where bands are not RGB, and where none of the channel's light
/// passes such a filter.
Spectrum channel_scale(const LightChannel& channel, const Bands& bands,
                       const ChannelSetting& setting);

/// The channel of that name, an index. Throws InputError that lists the names there are, or says
/// that the solution has no channels.
int find_channel(const RadiositySolution& solution, std::string_view name);

/// Puts scales into force, one for each channel: radiosities, irradiances, emission and energy
/// balance become sum_c s_c of the channels' own. No light is computed; the same scales give the
/// same bits whatever was in force before. Error estimate, residual and interpolation_error stay
/// those of the light as it was solved. Throws std::invalid_argument unless there is a finite scale
/// >= 0 for every channel and band.
void relight(SolvedScene& solved, std::span<const Spectrum> scales);

/// Only the part of relight() that tells DirectLight how bright free sources are: what makes a mesh
/// read from a file whole again.
void scale_sources(SolvedScene& solved);

/// The scales in force.
std::vector<Spectrum> effective_scales(const RadiositySolution& solution);

/// Flux that a channel's emitters give with its scale in force, W per band.
Spectrum emitted_flux(const LightChannel& channel);

}  // namespace lightwell
