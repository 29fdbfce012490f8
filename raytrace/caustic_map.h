#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/paths/caustic_photons.h"
#include "raytrace/disc_tree.h"
#include "raytrace/light_regions.h"

namespace lightwell {

/// Irradiance by photons that lie on surfaces (Jensen 1996), as sharp as there are photons: each is
/// spread over a disc of its own radius r by Epanechnikov's kernel, 2 / (pi r^2) (1 - (d / r)^2).
/// The radius is the distance to its k-th neighbour, k growing as N^(2/3) of N photons: both the
/// noise, k^(-1/2), and the area that is blurred, k / N, shrink, in the balance that makes their
/// sum least (Silverman 1986).
///
/// No light is lost or leaks: a photon gives to places of its own region alone, see LightRegions,
/// and what of its disc lies beyond the region's boundary is folded back, so that the irradiance
/// adds up to the power of the photons.
class CausticMap {
 public:
  CausticMap(const PatchMesh& mesh, const CausticPhotons& photons);

  /// W/m^2 at a place on an element; `normal` is the surface's own there, unit.
  Spectrum irradiance(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                      int element) const;

  /// Of `count` photons, how many a disc reaches over.
  static int neighbours(std::size_t count);

 private:
  void set_radii(int region, int k);
  /// What the disc's power is multiplied by, and where it is once more.
  struct Folded {
    float weight = 0.0f;
    std::vector<Eigen::Vector3f> mirrored{};
  };
  void fold_discs(int region, std::vector<Folded>& folded) const;
  std::vector<LightRegions::Edge> edges_about(const DiscTree::Node& about,
                                              std::span<const LightRegions::Edge> edges) const;
  void insert(const std::vector<Folded>& folded, const BandArray& power);

  LightRegions regions_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();  // of the discs' coordinates
  DiscTree tree_;
  BandArray power_;        // per disc, over pi r^2 / 2 and the share of the kernel that is within
  std::vector<int> root_;  // per region; -1: no photons
};

/// Shoots photons, see shoot_photons, and makes the map of them.
std::shared_ptr<const CausticMap> trace_caustics(const Scene& scene, const ElementCaster& caster,
                                                 const DirectLight& direct_light, int photons,
                                                 int max_specular_depth,
                                                 const Progress& progress = {});

}  // namespace lightwell
