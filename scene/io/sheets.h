#pragma once

#include <optional>

#include "scene/scene.h"

namespace lightwell {

/// Largest width alpha (GGX, or a Gaussian of slopes) of transmitted light that is read as passing
/// straight on: a lobe that falls to half its height 5 to 7 degrees from its middle. Wider light is
/// read as diffuse.
inline constexpr double straight_alpha = 0.1;

/// Share of clear light from which a thin sheet is read as a pane, which reflects by Fresnel's
/// equations. Sheets of a smaller share keep it.
inline constexpr double nearly_clear = 0.9;

/// Adds a share of light that leaves the other side of a thin sheet diffusely. A sheet has two
/// sides.
void add_diffuse_transmittance(Material& material, const Spectrum& share);

/// Adds a share of light that passes a thin sheet straight on. A sheet has two sides.
void add_regular_transmittance(Material& material, const Spectrum& share);

/// Adds a share of light that passes a thin sheet with a lobe of width `alpha`: straight on up to
/// straight_alpha, diffusely beyond.
void add_transmittance(Material& material, const Spectrum& share, double alpha);

/// Adds `weight` times what `part` passes, of a mixed material.
void add_passed(const Material& part, float weight, Material& sum);

/// Multiplies every share of light that a material other than a dielectric reflects or passes.
void scale_shares(const Spectrum& factor, Material& material);

/// Scales the shares of a material other than a dielectric so that they add up to at most 1 in
/// every band.
void limit_shares(Material& material);

/// Leaves the share `opacity`, [0,1], of a material that is no dielectric: a fabric with fine
/// holes. The rest of the light passes straight on. Emission stays as it is.
void let_through(Material& material, const Spectrum& opacity);

/// The same where a picture gives the share.
void let_through(Material& material, const ShareTexture& opacity);

/// A picture of one texel, for a share that does not vary.
ShareTexture even_share(float share);

/// The mean of a picture of opacity (its first channel) whose texels are, for the most part,
/// neither clear nor opaque: gauze, smoke. Empty for a picture that cuts holes.
std::optional<float> even_opacity(const Texture& opacity);

/// Light passes a lamp nowhere straight on: removes the regular transmittance of a material that
/// shines. True if the material had one.
bool close_lamp(Material& material);

}  // namespace lightwell
