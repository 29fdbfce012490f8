#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "scene/polarisation.h"
#include "scene/scene.h"

namespace lightwell {

/// Light that meets a mirror, a clear surface or a sheet that passes light straight on.
struct SurfaceInteraction {
  const Material& material;     ///< with is_specular()
  Eigen::Vector3d direction;    ///< of the light, unit, towards the surface
  Eigen::Vector3d normal;       ///< unit, on the side the light comes from
  bool from_back = false;       ///< the light comes from behind the surface
  Polarisation polarisation{};  ///< of the light; rough surfaces take it as unpolarised
};

/// A direction in which light continues from a surface interaction.
struct ScatteringSample {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit
  Spectrum weight{};            ///< share of the light that continues, per band
  bool crosses = false;         ///< the light passes to the other side of the surface
  double density = 0.0;         ///< of the direction, 1/sr; 0: not known
  Polarisation polarisation{};  ///< of the light that continues, for the mean of all bands
};

/// Scattering at a smooth surface: one sample for a mirror; the reflected and, except under total
/// internal reflection, the refracted light for a dielectric; the mirrored light and that which
/// passes straight on for a sheet of regular transmittance. A dielectric polarises the light, so
/// the shares of several parallel faces are those of each polarisation, summed. A mirror and a
/// sheet keep the polarisation.
struct SmoothScattering {
  std::array<ScatteringSample, 2> sample{};
  int count = 0;
};
SmoothScattering smooth_scattering(const SurfaceInteraction& interaction);

/// Share of light, per band, that continues once a sample's direction and side have been chosen:
/// the reflectance of a mirror; that of a coat by Fresnel's equations at the microfacet, as that
/// of a metal; the regular transmittance of a sheet; for a dielectric, 1 if reflected and the tint
/// if crossing. The body of a thin pane that absorbs leaves less of both, by the angle to the
/// microfacet. The weight that the sample carries does not count.
Spectrum scattering_weight(const SurfaceInteraction& interaction, const ScatteringSample& sample);

/// Share, per band, of the light not reflected that crosses a clear surface along its normal: the
/// tint, times what the body of a thin pane leaves.
Spectrum crossing_share(const Dielectric& glass);

/// Factor of the radiance that a ray reads behind a surface, (n_1 / n_2)^2: n_1 is the index of
/// refraction on the side that the ray comes from, n_2 on the side where the ray goes on.
/// Refraction leaves L / n^2 as it is, while shares of power need no such factor (Veach 1997,
/// section 5.2). 1 where the ray does not cross, at a thin pane and at a sheet.
double radiance_scale(const Material& material, bool crosses, bool from_back);

/// True if light that crosses continues straight on: a thin pane without roughness, or a sheet of
/// regular transmittance.
bool is_clear_pane(const Material& material);

/// Share of even light, per band, that a material sends on along single directions: what it mirrors
/// (see mean_mirrored) and its regular transmittance. A dielectric sends on all light; the result
/// is that of the rest of the material.
Spectrum mean_specular(const Material& material);

/// Share of even light, per band, that a material sends on in all: reflectance, transmittance and
/// mean_specular(). At most 1; the rest is absorbed. A picture of reflectance counts by its mean.
Spectrum mean_sent_on(const Material& material);

/// Random numbers in [0,1) that choose a sample. `key` gives further numbers where the first ones
/// are rejected.
struct ScatteringRandom {
  double component = 0.0;   ///< chooses reflection or refraction
  double u = 0.0, v = 0.0;  ///< choose the microfacet
  std::uint64_t key = 0;
};

/// Draws one sample whose weight, without a further factor, has the right mean.
///
/// A rough surface consists of GGX microfacets. Light meets a visible microfacet, continues by
/// Fresnel's equations, and is drawn again where Smith's masking (height-correlated for reflected
/// light, Heitz 2014) or the surface itself blocks the sample. The loss of single scattering is
/// thus spread over the same lobe. At every angle of incidence, roughness keeps the share of a
/// mirror and all light of glass. A rough thin pane passes the mirrored picture of the light that
/// it reflects. Light that passes a sheet straight on is one of its samples.
ScatteringSample sample_scattering(const SurfaceInteraction& interaction,
                                   const ScatteringRandom& random);

/// sample_scattering() without the light that passes a sheet straight on: the lobe of its mirror.
ScatteringSample sample_lobe(const SurfaceInteraction& interaction, const ScatteringRandom& random);

/// Light that passes a sheet of regular transmittance straight on. Under a coat less of grazing
/// light passes, by CoatedBase::factor(); holes (1 - specular) pass light of all angles.
ScatteringSample straight_sample(const SurfaceInteraction& interaction);

/// Most mirrors and clear surfaces along a path: `most`, but at least 128 (0 if `most` is 0). Light
/// in a rough ball is trapped beyond the critical angle and escapes by chance: after eight surfaces
/// some percent of the light is still inside. Light through a stack of four slabs meets eight faces
/// without any reflection. A low sun meets the sides of a light pipe ten times as long as wide more
/// than ten times.
int deepest_path(int most);

/// Density of sample_scattering's directions from one side of a rough surface, 1/sr: the density of
/// single scattering over the share that single scattering keeps, which is tabulated.
class RoughLobe {
 public:
  /// `material` has gloss_roughness() > 0. If its roughness varies by place, interactions of any
  /// roughness are right.
  RoughLobe(const Material& material, bool from_back);
  /// Density of the unit direction `outgoing`; 0 in directions without light.
  double density(const SurfaceInteraction& interaction, const Eigen::Vector3d& outgoing) const;

 private:
  static constexpr int steps_ = 64;
  using Shares = std::array<double, steps_>;  // at cosines (i + 0.5) / steps_
  static Shares kept_shares(const Material& material, bool from_back);
  double kept(double cosine, double alpha) const;

  static constexpr int level_steps_ = 16;
  std::vector<Shares> kept_{};  // one, or one at each alpha (i / level_steps_)^2
};

/// Clear bodies that the light of a path is within, by the surfaces crossed. Light enters a body by
/// its front and leaves the body by its back.
class Media {
 public:
  /// Records a scattering at a surface; `material` is the index of `what`.
  void cross(int material, const Material& what, const ScatteringSample& sample, bool from_back);
  /// True if the light has crossed into no body, or out of all of them again. The light may still
  /// be in a body that the path began in.
  bool is_empty() const { return count_ == 0; }
  /// Transmittance per band over `distance` metres up to a surface of `material`, met from behind
  /// or not: exp(-absorption d) of the body around the light, ones where nothing absorbs. A clear
  /// surface met from behind bounds its own body, whatever was crossed before.
  Spectrum passed(const Scene& scene, int material, bool from_back, double distance) const;

 private:
  static constexpr int deepest = 4;  // bodies within bodies; beyond, the outermost is forgotten
  std::array<int, deepest> bodies_{};
  int count_ = 0;
};

}  // namespace lightwell
