#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "raytrace/caustics/disc_tree.h"
#include "raytrace/caustics/light_regions.h"
#include "raytrace/caustics/photon_tree.h"

namespace lightwell {

/// Irradiance of photons, and the variance of the noise.
struct PhotonDensity {
  Spectrum irradiance{};  ///< W/m^2 per band
  /// Variance of the noise of independent photons, mean of the bands, (W/m^2)^2.
  double variance = 0.0;
};

/// Discs over which photons are spread (Jensen 1996), each with a radius r of its own, by
/// Epanechnikov's kernel, 2 / (pi r^2) (1 - (d / r)^2). The radius is the distance to the k-th
/// neighbour.
///
/// Energy is conserved. A photon contributes to points of its own region alone (see LightRegions),
/// and the part of its disc beyond the region's boundary is folded back, so the integral of
/// irradiance equals the power of the photons.
class PhotonDiscs {
 public:
  /// Regions with fewer than `fewest` rows of `photons` have no discs.
  PhotonDiscs(const LightRegions& regions, PhotonTree tree, const PhotonSums& photons, int k,
              int fewest = 1);

  /// True if photons of the region are spread over discs.
  bool cover(int region) const { return root_[static_cast<std::size_t>(region)] >= 0; }

  /// The density at `point` of a region. `normal` is the unit normal of the surface at `point`.
  /// Photons on elements whose normal is within 60 degrees of `normal` count.
  PhotonDensity at(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, int region) const;

 private:
  using Edges = std::span<const LightRegions::Edge>;
  void set_radii(int root, Edges bounds, int k);
  /// Result of folding a disc: the factor of its power, and the centres of its mirror images.
  struct Folded {
    float weight = 0.0f;
    std::vector<Eigen::Vector3f> mirrored{};
  };
  void fold_discs(int root, Edges bounds, std::vector<Folded>& folded) const;
  std::vector<LightRegions::Edge> edges_about(const DiscTree::Node& about, Edges edges) const;
  template <int Columns>
  void add_leaf(const DiscTree::Node& leaf, const Eigen::Vector3f& point,
                const Eigen::Vector3f& normal, float* sums) const;
  void insert(const std::vector<Folded>& folded, const PhotonSums& photons);

  Eigen::Vector3d origin_;  // m; disc centres are relative to this point
  DiscTree tree_;
  std::vector<int> root_;  // root node per region; -1: no discs
  // Per disc: power, times a factor of 1 / (pi r^2 / 2) / the share of the kernel within the
  // region, and in the last column PhotonSums::square times the squared factor.
  BandArray power_{};
};

}  // namespace lightwell
