#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "radiosity/paths/caustic_photons.h"
#include "raytrace/caustics/disc_tree.h"
#include "raytrace/caustics/light_regions.h"

namespace lightwell {

/// Photons on surfaces, each one alone or the sum of some that lie together.
struct PhotonSums {
  std::vector<Eigen::Vector3d> position{};  ///< m; the mean of those that lie together
  std::vector<int> element{};               ///< of the mesh, of one of them
  BandArray power{};                        ///< sum, W, rows x bands
  Eigen::ArrayXf square{};  ///< sum of the squared powers, each the mean of the bands, W^2

  int count() const { return static_cast<int>(element.size()); }
};

/// Each photon alone.
PhotonSums each_photon(const CausticPhotons& photons);

/// Photons in a tree of boxes for each region.
struct PhotonTree {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m; centres of discs are relative to it
  DiscTree tree{};                                   ///< a disc per photon, still without a radius
  std::vector<int> root{};                           ///< root node per region; -1: no photons
};

PhotonTree build_photon_tree(const PatchMesh& mesh, const LightRegions& regions,
                             const PhotonSums& photons);

/// Sums of photons that lie together: those of the highest nodes of the tree that hold at most
/// `most` of them or are leaves.
PhotonSums clustered(const PhotonTree& tree, const PhotonSums& photons, int most);

}  // namespace lightwell
