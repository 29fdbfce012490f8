#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/emitters/direct_light.h"
#include "radiosity/emitters/lit_scene.h"
#include "radiosity/journal/run_control.h"
#include "radiosity/solution/solution.h"
#include "scene/progress.h"

namespace lightwell {

/// Where irradiance is asked for.
struct GatherPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< metres
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   ///< unit
  int facet =
      -1;  ///< scene-wide facet it lies on, whose plane it then does not see; -1: free space
  /// Of the random numbers; else its place in the list. What points of one key have in common,
  /// light from afar, has the same noise in all of them: it is not in their differences.
  std::optional<std::uint64_t> key{};
  int rays = 0;  ///< hemisphere rays, if not as many as GatherOptions say
};

/// A list of them, which is kept a reference to; or each made when it is asked for, from many
/// threads: to keep all vertices' takes several times the memory of what is gathered there.
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

struct GatherOptions {
  int rays = 512;  ///< hemisphere rays per point; a power of two stratifies best
  int max_specular_depth = 8;
  ShadowOptions shadows{.min_rays = 32, .max_rays = 256};
  std::uint64_t replica = 0;  ///< another number gives an independent estimate
  RunControl run{};           ///< the journal keeps gathered irradiance
};

/// points x bands, W/m^2. Where light is kept apart by channels (see DirectLight), here and below
/// the columns of bands of one channel follow those of another.
struct GatheredIrradiance {
  BandArray direct{};    ///< straight from DirectLight's emitters
  BandArray indirect{};  ///< from everything else that reflects or emits, also by way of mirrors
                         ///< and glass
  /// Of the indirect light, channels added: the variance that its rays leave, mean of the bands,
  /// (W/m^2)^2, as half of them against the other half tells. Of one point that is little more than
  /// a guess; means over neighbours are good.
  Eigen::ArrayXf variance{};
};

/// Irradiance at points of a solved scene: direct light by closed form times visibility, the rest
/// by cosine-distributed rays that read the radiosity where they end, going on through mirrors and
/// clear glass. Light that DirectLight's emitters send by way of mirrors and glass is left out,
/// since rays from the receiver find it by chance only: see caustic_irradiance. That of the sky's
/// dome they find well. `radiosity` is
/// vertices x bands, as gatherable_radiosity makes it.
GatheredIrradiance gather_irradiance(const LitScene& lit, const BandArray& radiosity,
                                     const GatherPoints& points, const GatherOptions& options = {});

/// Only the direct light; `visibilities`, if given, gets one entry a point.
BandArray gather_direct(const LitScene& lit, const GatherPoints& points,
                        const GatherOptions& options,
                        std::vector<EmitterVisibility>* visibilities = nullptr);

/// Only the indirect light; `direct` is left empty.
GatheredIrradiance gather_indirect(const LitScene& lit, const BandArray& radiosity,
                                   const GatherPoints& points, const GatherOptions& options);

/// rho E, plus the emission of patches that `direct_light` does not own: what gather_irradiance
/// reads. `irradiance` is vertices x bands.
BandArray gatherable_radiosity(const PatchMesh& mesh, const DirectLight& direct_light,
                               const BandArray& irradiance);

/// Irradiance at every vertex (vertices x bands, W/m^2) from emitters by way of mirrors and glass:
/// `rays` rays in all from each light of DirectLight leave their power on the elements where
/// they end (after Heckbert 1990), and vertices take the mean of the elements around; but for what
/// goes straight through ClearPanes, which is direct light. Empty if the scene has no mirrors or
/// glass.
BandArray caustic_irradiance(const LitScene& lit, int rays, int max_specular_depth,
                             const RunControl& run = {});

/// For every vertex, a point a hair inside one of its elements, so that it lies on no edge, and
/// that element's facet and normal; where facets that meet smoothly share it, a hair above them
/// too, with the normal of them all, on no facet.
std::vector<GatherPoint> vertex_gather_points(const PatchMesh& mesh);

/// The same, each made when it is asked for. Keeps a reference to the mesh.
class VertexGatherPoints {
 public:
  explicit VertexGatherPoints(const PatchMesh& mesh);
  GatherPoint operator[](int vertex) const;

 private:
  const PatchMesh& mesh_;
  std::vector<int> element_;  // per vertex, the first that has it
};

}  // namespace lightwell
