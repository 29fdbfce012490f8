#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "radiosity/solution/solution.h"

namespace lightwell {

/// Setting of a channel relative to the scene as solved.
struct ChannelSetting {
  double factor = 1.0;  ///< factor of the channel's luminous flux, >= 0
  /// Linear sRGB, >= 0, of any brightness; unset: the channel's own.
  std::optional<Eigen::Array3f> colour{};
};

/// Parses "0.3", "off", "on", "#ffd9b0" (sRGB, linearised) or "0.3,#ffd9b0". Throws
/// std::invalid_argument with a description for any other text.
ChannelSetting channel_setting(std::string_view text);

/// Factor of a channel's emission per band, s_k = factor * a * colour_k. The model is a filter of
/// that colour before the emitters, with the power raised by a so that the luminous flux stays the
/// same: Y(a colour Phi) = Y(Phi) for flux Phi. White light takes on the colour itself.
///
/// Throws InputError for a colour if the bands are not RGB, and if no light of the channel passes
/// the filter.
Spectrum channel_scale(const LightChannel& channel, const Bands& bands,
                       const ChannelSetting& setting);

/// Throws InputError for a solution without channels.
void require_channels(const RadiositySolution& solution);

/// Index of the channel named `name`. Throws InputError that lists all names, or that states that
/// the solution has no channels.
int find_channel(const RadiositySolution& solution, std::string_view name);

/// Applies one scale per channel: radiosities, irradiances, emission and energy balance become
/// sum_c s_c of the channels' own. No light is computed. Equal scales give equal bits, whatever
/// scales were applied before. Error estimate, residual and interpolation_error remain those of the
/// solve. Throws std::invalid_argument unless every channel and band has a finite scale >= 0.
void relight(SolvedScene& solved, std::span<const Spectrum> scales);

/// Sets the brightness of free sources for DirectLight, the part of relight() that a mesh read from
/// a file needs.
void scale_sources(SolvedScene& solved);

/// The scales applied last, one per channel.
std::vector<Spectrum> effective_scales(const RadiositySolution& solution);

/// Emitted flux of a channel at its present scale, W per band.
Spectrum emitted_flux(const LightChannel& channel);

}  // namespace lightwell
