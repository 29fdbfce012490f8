#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/journal/run_control.h"
#include "radiosity/solution/solution.h"

namespace lightwell {

class Portals;

/// A point at which irradiance is gathered.
struct GatherPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< metres
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   ///< unit
  /// Scene-wide facet that the point lies on, whose plane its rays then do not meet; -1: free
  /// space.
  int facet = -1;
  /// Key of the random numbers; empty: the point's index in the list. Points with the same key have
  /// the same noise of light from afar, which is then not in the differences between them.
  std::optional<std::uint64_t> key{};
  int rays = 0;           ///< hemisphere rays; 0: GatherOptions::rays
  NoiseGoal sky_noise{};  ///< LightQuery::sky_noise
};

/// A list of gather points. Either a reference to a given list, or a function that makes each point
/// on demand and is called from many threads. (A list of all vertices' points takes several times
/// the memory of the light gathered there.)
class GatherPoints {
 public:
  template <class List>
  requires std::convertible_to<const List&, std::span<const GatherPoint>> GatherPoints(
      const List& list)
      : GatherPoints(static_cast<int>(std::size(list)),
                     [list = std::span<const GatherPoint>(list)](int i) { return list[i]; }) {}
  GatherPoints(int count, std::function<GatherPoint(int)> at) : count_(count), at_(std::move(at)) {}

  int size() const { return count_; }
  GatherPoint operator[](int i) const { return at_(i); }

 private:
  int count_;
  std::function<GatherPoint(int)> at_;
};

/// Options of a gather.
struct GatherOptions {
  int rays = 512;  ///< hemisphere rays per point; a power of two stratifies best
  int max_specular_depth = 8;
  ShadowOptions shadows{.min_rays = 32, .max_rays = 256};
  std::uint64_t replica = 0;                 ///< another number gives an independent estimate
  std::shared_ptr<const Portals> portals{};  ///< openings that rays are aimed at; null: none
  /// Aims rays out of narrow gaps: for points that are read by themselves. Light of vertices, of
  /// which a gap has few, gains too little for the time.
  bool aims_out_of_gaps = false;
  RunControl run{};  ///< the journal keeps the gathered light
};

/// Gathered irradiance, points x columns, W/m^2. The columns are the bands; if light is kept apart
/// by channels (see DirectLight), the bands of one channel after those of another.
struct GatheredIrradiance {
  BandArray direct{};    ///< straight from the emitters of DirectLight
  BandArray indirect{};  ///< from all other emitters and reflectors, also through mirrors and glass
  /// Variance of the sum of channels of `indirect`, mean of the bands, (W/m^2)^2: the square of
  /// half the difference between two halves of the rays. For one point little more than a guess;
  /// means over neighbours are good.
  Eigen::ArrayXf variance{};
};

/// Irradiance at points of a solved scene (final gather, Reichert 1992).
///
/// - Direct light: closed form times visibility.
/// - Indirect light: E = (1/N) sum B over N cosine-distributed rays, which continue through mirrors
///   and clear glass, and read the radiosity B where they end.
/// - A quarter as many rays more are aimed at `options.portals`, from their dim sides.
/// - Light of DirectLight's emitters through mirrors and glass is left out, since rays from the
///   receiver find it by chance only (see caustic_irradiance). Such light of the sky's dome is
///   included, since the rays find it well.
///
/// `radiosity` is vertices x columns, W/m^2, as gatherable_radiosity makes it. Throws Interrupted
/// when progress says stop.
GatheredIrradiance gather_irradiance(const LitScene& lit, const BandArray& radiosity,
                                     const GatherPoints& points, const GatherOptions& options = {});

/// The direct light alone, points x columns, W/m^2; `visibilities`, if given, gets one entry for
/// each point. Throws Interrupted when progress says stop.
BandArray gather_direct(const LitScene& lit, const GatherPoints& points,
                        const GatherOptions& options,
                        std::vector<EmitterVisibility>* visibilities = nullptr);

/// The indirect light alone; `direct` is empty. Throws Interrupted when progress says stop.
GatheredIrradiance gather_indirect(const LitScene& lit, const BandArray& radiosity,
                                   const GatherPoints& points, const GatherOptions& options);

/// Shares of vertices in the light that gather_indirect() finds: the irradiance of each point by
/// radiosity 1 of one band at one vertex alone, points x (vertices x bands), the bands of a vertex
/// side by side. No rays are aimed at bright patches, which are not known. Throws
/// std::invalid_argument for a scene with lights, whose light belongs to no vertex, and Interrupted
/// when progress says stop.
BandArray gather_shares(const LitScene& lit, const GatherPoints& points,
                        const GatherOptions& options);

/// The radiosity that gather_irradiance reads, W/m^2: rho E, plus the emission of patches that
/// `direct_light` does not own. `irradiance` E, its part `direct` straight from the lights, and the
/// result are vertices x columns. Coated surfaces reflect direct light by its angle (see
/// DirectLight::base_gain); with `direct` empty, they reflect all light as if it were even.
BandArray gatherable_radiosity(const PatchMesh& mesh, const DirectLight& direct_light,
                               const BandArray& irradiance,
                               const Eigen::Ref<const BandArray>& direct = BandArray());
/// Gatherable radiosity of the light of a solution.
BandArray gatherable_radiosity(const PatchMesh& mesh, const DirectLight& direct_light,
                               const RadiositySolution& solution);

}  // namespace lightwell
