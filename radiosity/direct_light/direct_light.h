#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/many_lights/light_choice.h"
#include "radiosity/sky/noise_goal.h"
#include "radiosity/solution/emitter_channels.h"
#include "radiosity/visibility/clear_panes.h"
#include "scene/coat.h"
#include "scene/sampling.h"
#include "scene/scene.h"
#include "scene/surface_point.h"

namespace lightwell {

class AbsorbingBodies;
class ExactShadows;
class LightSampler;
class SkyLight;
struct Emitter;
struct FreeSource;
struct LightList;
struct LightPilot;
struct ReceiverGain;
struct SkyGlow;

constexpr int most_shadow_rays = 256;  ///< that pictures and solves choose
/// The limit for single points, which can afford more.
constexpr int most_probe_shadow_rays = 1 << 14;

/// Shadow rays from a point to an emitter that gives all of the point's direct light: `min_rays`
/// rays first, in two independent halves; `max_rays` if in both halves some are blocked and some
/// not, half of the further rays if in one. The mean over keys is the visible share. Emitters that
/// give less light get fewer. No rays are cast where ExactShadows finds the visible share in less
/// time.
struct ShadowOptions {
  int min_rays = 16;
  int max_rays = 64;  ///< 1 to most_probe_shadow_rays
  /// Rays to the dome of the sky, of which an eighth come first; 0: as to an emitter. 1 to 65536.
  int sky_rays = 0;
  /// The greatest share of a point's light that a cluster of lights may give; 0: each light is
  /// asked. A channel of fewer than fewest_clustered lights has no clusters.
  double cluster_share = 0.01;
  /// The lights that are asked where there are clusters; `sorted` leaves a rest of cluster_share of
  /// the light, `importance` draws among lights that may give less than that each.
  ManyLights many_lights = ManyLights::lightcuts;

  /// True if each light and the sky get one ray at most, without an estimate of the noise.
  bool is_one_ray() const { return max_rays == 1 && sky_rays == 0; }
};

/// Visibility of the lights from a point.
struct EmitterVisibility {
  /// Unobstructed irradiance, sum M F, mean of the bands, W/m^2, of the lights whose shadow rays
  /// were partly blocked; their noise is a share of this sum.
  double noisy = 0.0;
  /// Standard error of the light of the dome and of clusters of lights, mean of the bands, W/m^2.
  double drawn_noise = 0.0;
  std::uint64_t whole = 0;   ///< bit i: light i is fully visible; the first 64 lights
  std::uint64_t hidden = 0;  ///< bit i: light i is fully hidden
};

/// A point that direct light is computed at, and with which effort.
struct LightQuery {
  SurfacePoint at{};
  std::uint64_t key = 0;  ///< of the shadow rays' random numbers
  ShadowOptions shadows{};
  /// Noise that the dome's light may have. If set, the rays that it takes are cast, from 3/16 of
  /// ShadowOptions::sky_rays to NoiseGoal::most_times as many; otherwise `shadows` decides alone.
  NoiseGoal sky_noise{};
  Lights lights = Lights::all;
  /// True for one of many points whose light is averaged: one light of each channel stands for all
  /// of them, drawn in proportion to about what each would give, besides the sky's dome. The mean
  /// over keys is the same; a point costs one closed form and one set of shadow rays.
  bool one_stands_for_all = false;
  /// Base under a coat, by whose CoatedBase::factor() at its angle light counts: irradiance as the
  /// base gets it. That of an emitter or a lamp counts by the mean over some of its points, as if
  /// all of it were visible; the dome's by what its rays find. Null: no coat.
  const CoatedBase* base = nullptr;
  /// Relief by whose ReliefSlope::gain() of its direction light counts, in the same way. Null: no
  /// relief.
  const ReliefSlope* relief = nullptr;
  /// Lights that are asked in place of a choice, each over its chance. Null: lights are chosen.
  const std::vector<LightSample>* asked = nullptr;
};

/// Direct light: closed form times visibility, for small bright emitters, a single large one and
/// free sources.
///
/// Emitting facets are taken in order of falling exitance (all of one exitance together) while
/// their areas add up to at most a quarter of the scene's area: a hemisphere of rays would meet
/// these facets only by chance. A single larger facet, such as a luminous ceiling, is taken, too,
/// since its closed form costs less than the rays that would find its light; not in a scene with
/// mirrors or glass, in which such rays find its image with less noise. Other large emitters are
/// left to hemispheres of rays. The exitance of
/// the scene decides this order; the light itself is PatchMesh::emission, which relight() may have
/// scaled.
///
/// An emitter that shines by a picture is a sum of closed forms of its parts, and its shadow rays
/// weigh what they see by the picture.
///
/// Free sources (lamps without surface, sky and sun) are always direct light.
///
/// Points ask not all of many lights: of a channel with fewest_clustered emitters or lamps, a point
/// asks those that give it much, and two drawn members of each cluster of others (see
/// ShadowOptions::cluster_share). The mean over keys of random numbers is the sum over all lights.
///
/// Irradiance includes light that passes straight through ClearPanes; form factors take panes as
/// opaque. At points within an absorbing body, each shadow ray counts with what the body leaves of
/// the light over the ray's length; form factors do not.
///
/// Light of channel c lies in the columns from c * bands on; without channels there is one.
class DirectLight {
 public:
  /// `like`: direct light of the same scene and mesh, whose tables of the sky and of occluders are
  /// shared instead of made again.
  DirectLight(const Scene& scene, const PatchMesh& mesh, const EmitterChannels& channels = {},
              const DirectLight* like = nullptr);

  /// Light at a mesh that outlives it, that of the caster: what a place sees of the sky is found
  /// when light is first asked for there, which serves pictures and probes. Light is the same, bit
  /// for bit, as by the mesh alone.
  DirectLight(const Scene& scene, const ElementCaster& caster);

  /// The light of `sources` alone, none of which is the sky's dome, all in channel 0. `bodies`:
  /// those of a DirectLight of the scene.
  DirectLight(const Scene& scene, std::vector<FreeSource> sources,
              std::shared_ptr<const AbsorbingBodies> bodies);

  const std::vector<Emitter>& emitters() const;
  const std::vector<FreeSource>& free_sources() const;
  /// The dome of the sky; null if there is none.
  const FreeSource* dome() const;
  /// The light of the dome; null if there is none.
  const SkyLight* sky() const { return sky_.get(); }
  /// Absorbing bodies that surfaces lie within; null: none.
  const std::shared_ptr<const AbsorbingBodies>& bodies() const { return bodies_; }
  int light_count() const;
  /// True if the emission of that side of a facet is direct light, which other rays must not count
  /// again. Only the outside of a sphere is; its inside sees itself all around.
  bool owns(int facet, bool is_back) const {
    return owned_[facet] == Owned::whole || (owned_[facet] == Owned::front && !is_back);
  }
  /// The number of channels; 1 without channels.
  int channel_count() const;
  int column_count() const { return channel_count() * bands_; }
  /// The first column of a facet's emission; 0 for a facet that does not emit.
  int first_column(int facet) const { return first_column_[facet]; }

  /// Form factor from a differential element to one of emitters(): the unoccluded closed form times
  /// the visible share. The share is exact where few polygons are occluders (see ExactShadows),
  /// else the ratio of the cosine kernel summed over visible samples to the kernel summed over all
  /// samples. Exact without occluders. Throws std::invalid_argument for an emitter that is not one
  /// of emitters().
  double form_factor(const Emitter& emitter, const ElementCaster& caster,
                     const LightQuery& query) const;

  /// The choice of lights, for points that choose together (LightQuery::asked).
  const LightSampler& sampler() const { return *sampler_; }
  /// True if any emitters are clustered.
  bool has_emitter_clusters() const;
  /// True if any emitters or lamps are clustered.
  bool has_clusters() const;
  /// The number of lights that a point asks, of light_count(); members of clusters count each.
  int asked(const ElementCaster& caster, const LightQuery& query) const;
  /// The emitters that a point asks for, no cluster of which gives more than `share` of the light
  /// of all. `key`: of the random numbers that draw members.
  std::vector<LightSample> chosen_emitters(const SurfacePoint& at, std::uint64_t key,
                                           double share) const;

  /// The closed form alone, without occluders.
  double unoccluded_form_factor(const Emitter& emitter, const SurfacePoint& at) const;

  /// True if the sample point (u, v), in [0,1)^2, of a light is visible; empty if it would give no
  /// light.
  std::optional<bool> sees(int light, const ElementCaster& caster, const SurfacePoint& at, double u,
                           double v) const;

  /// Transmitted share of light along `ray` up to t_max, per band: 1, 0, or the transmittance of
  /// clear panes.
  Spectrum passed(const ElementCaster& caster, const Ray& ray) const;

  /// Irradiance E = sum M F at a point, W/m^2 per band, all channels added.
  Spectrum irradiance(const ElementCaster& caster, const LightQuery& query,
                      EmitterVisibility* visibility = nullptr) const;

  /// The coated base of a material; null: the material has no coat.
  const CoatedBase* base_of(int material) const { return bases_.of(material); }
  bool has_coats() const { return !bases_.empty(); }
  /// Direct light that a coated base gets at a point over that of a base without a coat: the mean
  /// of CoatedBase::factor() over emitters and lamps, by their unoccluded light, and over the dome
  /// as the surfaces near by see the dome. The sun counts as far as the surfaces near by see its
  /// part of the dome. Of more than 64 lights some stand for all.
  double base_gain(const SurfacePoint& at, const CoatedBase& base) const;
  /// Direct light that a relief gets at a point over that of a flat surface, as base_gain() by
  /// ReliefSlope::gain(). 1 under a sky, whose light on slopes is not known here.
  double relief_gain(const SurfacePoint& at, const ReliefSlope& relief) const;
  /// base_gain() for the light of each channel.
  Eigen::ArrayXd base_gains(const SurfacePoint& at, const CoatedBase& base) const;

  /// Adds the irradiance of each channel to the channel's columns of E, which has column_count()
  /// of them.
  void add_irradiance(const ElementCaster& caster, const LightQuery& query, float* E,
                      EmitterVisibility* visibility = nullptr) const;

 private:
  DirectLight(const Scene& scene, const PatchMesh& mesh, const EmitterChannels& channels,
              const DirectLight* like, std::shared_ptr<const SkyLight> sky);
  struct Shadows;
  Shadows shadows(const ElementCaster& caster, const LightQuery& query,
                  const std::vector<LightSample>& samples) const;
  Spectrum light_of(int light, const Eigen::Vector3d& point) const;
  std::optional<LightPilot> pilot(const ElementCaster& caster, const LightQuery& query) const;
  std::vector<LightSample> chosen_lights(const ElementCaster& caster,
                                         const LightQuery& query) const;
  double factor(int light, const SurfacePoint& at, const ReceiverGain& receiver) const;
  Eigen::ArrayX2d light_with_factor(const SurfacePoint& at, const ReceiverGain& receiver) const;
  double arriving_unoccluded(int light, const SurfacePoint& at) const;
  double gain(const SurfacePoint& at, const ReceiverGain& receiver) const;
  SkyGlow dome_glow(const ElementCaster& caster, const LightQuery& query, double full,
                    std::uint64_t key) const;
  template <class Add>
  void for_each_light(const ElementCaster& caster, const LightQuery& query,
                      EmitterVisibility* visibility, Add&& add) const;

  std::shared_ptr<const LightList> lights_;
  std::shared_ptr<const LightSampler> sampler_;
  std::shared_ptr<const SkyLight> sky_{};  // null: there is no dome
  std::shared_ptr<const ExactShadows> exact_{};
  enum class Owned : char { nothing, front, whole };
  std::vector<Owned> owned_;
  std::vector<int> first_column_;
  CoatedBases bases_;
  int bands_ = 0;
  SobolPoints samples_;
  ClearPanes panes_;
  std::shared_ptr<const AbsorbingBodies> bodies_{};  // null: no patch lies in one
};

}  // namespace lightwell
