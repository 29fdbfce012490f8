#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/emitters/free_source.h"
#include "radiosity/emitters/sky_light.h"
#include "radiosity/solution/emitter_channels.h"
#include "radiosity/visibility/clear_panes.h"
#include "scene/sampling.h"
#include "scene/scene.h"
#include "scene/surface_point.h"

namespace lightwell {

class ExactShadows;

/// An emitting facet whose light is computed by closed form times visibility, never left to chance.
struct Emitter {
  int facet = 0;        ///< scene-wide facet number
  Spectrum exitance{};  ///< M, W/m^2, as the mesh has it
  double area = 0.0;    ///< m^2, one side
  bool emits_both_sides = false;
  bool is_sphere = false;
  Sphere sphere{};
  std::vector<Loop> loops{};  ///< boundary, then holes; counter-clockwise seen from the front
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  std::vector<std::array<Eigen::Vector3d, 3>> triangles{};  ///< tile the polygon, to place samples
  std::vector<double> area_cdf{};  ///< running share of the area, one per triangle, last is 1
};

constexpr int most_shadow_rays = 256;

/// Shadow rays from a point to an emitter that would give all of its direct light: `min_rays`
/// stratified ones first; where they disagree, `max_rays`. Emitters that would give less get fewer.
/// Where ExactShadows tells without rays, in about the time of as many, none are cast.
struct ShadowOptions {
  int min_rays = 16;
  int max_rays = 64;  ///< 1 to most_shadow_rays
};

/// What a point sees of the lights, by the shadows of its irradiance.
struct EmitterVisibility {
  /// sum M F with nothing in the way, mean of the bands, W/m^2, of lights whose shadow rays
  /// disagreed: what their noise is a share of.
  double noisy = 0.0;
  std::uint64_t whole = 0;   ///< bit i: all of light i is seen, of the first 64
  std::uint64_t hidden = 0;  ///< bit i: nothing is
};

/// Lights that give a sum: all, free sources only, or sky and sun only.
enum class Lights { all, free, distant };

/// A point that direct light is computed at, and with which effort.
struct LightQuery {
  SurfacePoint at{};
  std::uint64_t key = 0;  ///< of the shadow rays' random numbers
  ShadowOptions shadows{};
  Lights lights = Lights::all;
};

/// Light straight from the scene's emitters. Emitters are taken in order of falling exitance, all
/// of one exitance together, while they add up to at most a quarter of the scene's area: those are
/// small and bright, and a hemisphere of rays would find them by chance. What emits beyond that is
/// large and is found by any hemisphere of rays. What counts for that is the scene's exitance; the
/// light is that of the mesh, whose emission relight() may have scaled since.
///
/// Free sources, lamps that are no surface, are here as well: nothing else sees them. *Lights* are
/// the emitters and after them the free sources.
///
/// Irradiance includes what goes straight through ClearPanes; form factors take those for opaque.
///
/// With `channels`, light of each is kept apart in columns of its own: channel c in those from
/// c * bands on.
class DirectLight {
 public:
  /// `like`: another of the same scene and mesh, whose knowledge of the sky and of what casts
  /// shadows is shared instead of learnt again.
  DirectLight(const Scene& scene, const PatchMesh& mesh, const EmitterChannels& channels = {},
              const DirectLight* like = nullptr);

  const std::vector<Emitter>& emitters() const { return emitters_; }
  const std::vector<FreeSource>& free_sources() const { return free_sources_; }
  /// The dome of the sky; null if there is none.
  const FreeSource* dome() const;
  int light_count() const { return static_cast<int>(emitters_.size() + free_sources_.size()); }
  /// Whether emission of that side of a facet is accounted for here (and must not be counted again
  /// by other rays). Of a sphere that is its outside: its inside sees itself all around.
  bool owns(int facet, bool is_back) const {
    return owned_[facet] == Owned::whole || (owned_[facet] == Owned::front && !is_back);
  }
  /// 1 if light is not kept apart.
  int channel_count() const { return channel_count_; }
  int column_count() const { return channel_count_ * bands_; }
  /// The first column of what a facet emits; 0 if it does not.
  int first_column(int facet) const { return first_column_[facet]; }

  /// Form factor from a differential element to one of emitters(): the unoccluded closed form times
  /// the visible share. That is exact where few polygons are in the way (see ExactShadows); else it
  /// is the ratio of the cosine kernel over samples that see the point to that over all samples, so
  /// that without an occluder, too, the result is exact. Throws std::invalid_argument for an
  /// emitter that is not one of emitters().
  double form_factor(const Emitter& emitter, const ElementCaster& caster,
                     const LightQuery& query) const;

  /// The same with nothing in the way.
  double unoccluded_form_factor(const Emitter& emitter, const SurfacePoint& at) const;

  /// Whether a point sees the place (u, v), in [0,1)^2, of a light; empty if no light would come
  /// from there.
  std::optional<bool> sees(int light, const ElementCaster& caster, const SurfacePoint& at, double u,
                           double v) const;

  /// Share of light that a straight way to `ray.t_max` lets through, in each band: 1, 0, or what
  /// clear panes pass.
  Spectrum passed(const ElementCaster& caster, const Ray& ray) const;

  /// Irradiance E = sum M F at a point, W/m^2 per band, all channels added.
  Spectrum irradiance(const ElementCaster& caster, const LightQuery& query,
                      EmitterVisibility* visibility = nullptr) const;

  /// Adds the irradiance of each channel to the channel's columns of E, which has column_count()
  /// of them.
  void add_irradiance(const ElementCaster& caster, const LightQuery& query, float* E,
                      EmitterVisibility* visibility = nullptr) const;

 private:
  int first_light(Lights lights) const;
  template <class Add>
  void for_each_light(const ElementCaster& caster, const LightQuery& query,
                      EmitterVisibility* visibility, Add&& add) const;

  std::vector<Emitter> emitters_;
  std::vector<FreeSource> free_sources_;
  std::shared_ptr<const SkyLight> sky_{};  // null: there is no dome
  std::shared_ptr<const ExactShadows> exact_{};
  enum class Owned : char { nothing, front, whole };
  std::vector<Owned> owned_;
  std::vector<int> first_column_;
  int bands_ = 0, channel_count_ = 1;
  SobolPoints samples_;
  ClearPanes panes_;
};

}  // namespace lightwell
