#pragma once

#include <cstdint>
#include <span>

#include "mesh/element_caster.h"
#include "radiosity/direct_light.h"
#include "radiosity/solution.h"
#include "scene/progress.h"

namespace lightwell {

/// Where irradiance is asked for.
struct GatherPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< metres
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   ///< unit
  int facet =
      -1;  ///< scene-wide facet it lies on, so that it does not see its own plane; -1: free space
};

struct GatherOptions {
  int rays = 512;  ///< hemisphere rays per point, a power of two
  int max_specular_depth = 8;
  ShadowOptions shadows{};
  std::uint64_t replica = 0;  ///< another number gives an independent estimate
  Progress progress{};
};

/// points x bands, W/m^2.
struct GatheredIrradiance {
  BandArray direct{};    ///< straight from DirectLight's emitters
  BandArray indirect{};  ///< from reflecting (and large emitting) surfaces, also by way of mirrors
                         ///< and glass
};

/// Irradiance at points from a solved scene: direct light by closed form times visibility, the rest
/// by cosine-distributed rays that read the radiosity where they end, continuing through mirrors
/// and clear glass. Light that small bright emitters send by way of mirrors or glass (caustics) is
/// not in it; see SpecularLight. `vertex_radiosity` is vertices x bands and must leave out the
/// emission of the facets DirectLight owns.
GatheredIrradiance gather_irradiance(const Scene& scene, const ElementCaster& caster,
                                     const DirectLight& direct_light,
                                     const BandArray& vertex_radiosity,
                                     std::span<const GatherPoint> points,
                                     const GatherOptions& options = {});

/// rho E + the emission of facets that `direct_light` does not own: what gather_irradiance reads.
BandArray gatherable_radiosity(const PatchMesh& mesh, const DirectLight& direct_light,
                               const BandArray& vertex_irradiance);

/// A point within a hair of the vertex, moved inwards so that it lies on none of its elements'
/// edges.
GatherPoint vertex_gather_point(const PatchMesh& mesh, int vertex,
                                std::span<const int> elements_around);

}  // namespace lightwell
