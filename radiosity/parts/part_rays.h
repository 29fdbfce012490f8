#pragma once

#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/paths/light_path.h"
#include "scene/progress.h"
#include "scene/scene.h"

namespace lightwell {

/// The arrivals of one patch's rays at another patch.
struct RayArrivals {
  int patch = 0;
  float share = 0.0f;   ///< of the rays, with what mirrors and glass let pass
  float length = 0.0f;  ///< sum of the straight rays' lengths times their shares, m
};

/// The ends of a patch's rays.
struct PartRayEnds {
  std::vector<RayArrivals> at{};  ///< in the order of patches
  double escaped = 0.0;           ///< share of the rays that left the scene, or ended on a backdrop
  bool takes_part = false;        ///< false for mirrors and clear glass
  bool is_outside = false;        ///< most of the rays leave the scene; see find_parts()
};

/// The ends of cosine-distributed rays of each patch, which mirrors and glass pass on: 32 768 rays
/// over the number of patches, as a power of two, at least 32 and at most 1024. `is_outside` is
/// false. Throws Interrupted when progress says stop.
std::vector<PartRayEnds> cast_part_rays(const Scene& scene, const ElementCaster& caster,
                                        const LightPaths& paths, const Progress& progress);

/// A cluster's area, m^2, and area times rays: those that end within, their lengths (m^3), and
/// those that leave the scene.
struct ClusterSums {
  double area = 0.0, within = 0.0, length = 0.0, escaped = 0.0;
  int patches = 0;

  /// Rays that leave the scene are long: the outside of a house with deep window frames is neither
  /// a crack nor a hollow.
  bool is_enclosed() const { return within > escaped; }
  /// Mean length of the rays that end within, m.
  double mean_length() const { return within > 0.0 ? length / within : 0.0; }
};

/// The sums of each cluster; `cluster` of each patch, -1: none.
std::vector<ClusterSums> sums_of_clusters(const PatchMesh& mesh,
                                          const std::vector<PartRayEnds>& arrivals,
                                          const std::vector<int>& cluster);

}  // namespace lightwell
