#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "scene/scene.h"

namespace lightwell {

/// Light that meets a mirror or a clear surface.
struct SurfaceInteraction {
  const Material& material;   ///< one that is_specular()
  Eigen::Vector3d direction;  ///< of the light, unit, towards the surface
  Eigen::Vector3d normal;     ///< unit, on the side the light comes from
  bool from_back = false;     ///< that side is the back
};

/// A way in which it goes on.
struct ScatteringSample {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit
  Spectrum weight{};                                    ///< of the light that goes on this way
  bool crosses = false;                                 ///< to the other side of the surface
  double density = 0.0;  ///< of the direction, 1/sr, where it was drawn and that is known
};

/// The ways from a smooth surface: a mirror's one; the reflected and, unless all is, the refracted
/// light of a dielectric.
struct SmoothScattering {
  std::array<ScatteringSample, 2> sample{};
  int count = 0;
};
SmoothScattering smooth_scattering(const SurfaceInteraction& interaction);

/// Share of light that goes on by a way that crosses the surface or not, once that way is drawn: a
/// mirror's reflectance, all that is reflected and the tint of what crosses a dielectric.
Spectrum scattering_weight(const SurfaceInteraction& interaction, bool crosses);

/// Whether light that crosses goes straight on: a thin pane without roughness.
bool is_clear_pane(const Material& material);

/// What decides between ways; in [0,1). `key` draws more numbers where the first ones are refused.
struct ScatteringRandom {
  double component = 0.0;   ///< reflected or refracted
  double u = 0.0, v = 0.0;  ///< which microfacet
  std::uint64_t key = 0;
};

/// One way, drawn so that its share, without a factor, is right in the mean. A rough surface is one
/// of GGX microfacets: light meets one of those that are visible from where it comes, goes on as
/// Fresnel's equations say, and is drawn again where Smith's masking (height-correlated for what is
/// reflected, Heitz 2014) or the surface itself is in its way. What single scattering would lose is
/// thereby spread over the same lobe, and at every angle of incidence roughness leaves the share of
/// a mirror, and all light of glass, as it is. A rough thin pane passes the mirrored picture of
/// what it reflects.
ScatteringSample sample_scattering(const SurfaceInteraction& interaction,
                                   const ScatteringRandom& random);

/// How many mirrors and clear surfaces a path is followed by: at most `most` or, once it met a
/// rough one, 64 if that is more. Light in a rough ball is caught beyond the critical angle and
/// gets out by chance: after eight surfaces some percent of it are still within.
int deepest_path(int most, bool met_rough);

/// Density of sample_scattering's directions from one side of a rough surface, 1/sr: of single
/// scattering over the share that is not lost to it, which is tabulated.
class RoughLobe {
 public:
  /// A material with gloss_roughness() > 0.
  RoughLobe(const Material& material, bool from_back);
  /// In a unit direction; 0 where light does not go.
  double density(const SurfaceInteraction& interaction, const Eigen::Vector3d& outgoing) const;

 private:
  static constexpr int steps_ = 64;
  std::array<double, steps_> kept_{};  // at cosines (i + 0.5) / steps
};

/// The clear bodies that light is within, as far as it crossed their surfaces: it enters one by its
/// front and leaves it by its back.
class Media {
 public:
  /// Light goes on from a surface of that material.
  void cross(int material, const Material& what, const ScatteringSample& sample, bool from_back);
  /// What is left of light after `distance` metres on the way to a surface of that material, met
  /// from behind or not: exp(-absorption d) of the body it is in, ones where nothing absorbs.
  /// Behind a clear surface is its body, whatever was crossed before.
  Spectrum passed(const Scene& scene, int material, bool from_back, double distance) const;

 private:
  static constexpr int deepest = 4;  // bodies within bodies; of more, the outer ones are forgotten
  std::array<int, deepest> bodies_{};
  int count_ = 0;
};

}  // namespace lightwell
