#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/paths/caustic_photons.h"
#include "raytrace/caustics/disc_tree.h"
#include "raytrace/caustics/light_regions.h"

namespace lightwell {

/// Irradiance of photons on surfaces (Jensen 1996). Each photon is spread over a disc of its own
/// radius r by Epanechnikov's kernel, 2 / (pi r^2) (1 - (d / r)^2). The radius is the distance to
/// the photon's k-th neighbour, with k proportional to N^(2/3) for N photons. Both the noise,
/// k^(-1/2), and the blurred area, k / N, then shrink with N, in the balance that minimizes their
/// sum (Silverman 1986).
///
/// Energy is conserved. A photon contributes to points of its own region alone (see LightRegions),
/// and the part of its disc beyond the region's boundary is folded back, so the integral of
/// irradiance equals the power of the photons.
class CausticMap {
 public:
  CausticMap(const PatchMesh& mesh, const CausticPhotons& photons);

  /// Irradiance at `point` of `element`, W/m^2 per band. `normal` is the unit normal of the surface
  /// at `point`. Photons on elements whose normal is within 60 degrees of `normal` count.
  Spectrum irradiance(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                      int element) const;

  /// Number of neighbours k that a disc reaches over, for `count` photons in all; at least 16.
  static int neighbours(std::size_t count);

 private:
  void set_radii(int region, int k);
  /// Result of folding a disc: the factor of its power, and the centres of its mirror images.
  struct Folded {
    float weight = 0.0f;
    std::vector<Eigen::Vector3f> mirrored{};
  };
  void fold_discs(int region, std::vector<Folded>& folded) const;
  std::vector<LightRegions::Edge> edges_about(const DiscTree::Node& about,
                                              std::span<const LightRegions::Edge> edges) const;
  void insert(const std::vector<Folded>& folded, const BandArray& power);

  LightRegions regions_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();  // m; disc centres are relative to this point
  DiscTree tree_;
  BandArray power_;  // per disc: power / (pi r^2 / 2) / the share of the kernel within the region
  std::vector<int> root_;  // root node per region; -1: no photons
};

/// Returns the map of `photons` photons of shoot_photons(), which follow up to `max_specular_depth`
/// mirrors and glass surfaces. Throws as shoot_photons().
std::shared_ptr<const CausticMap> trace_caustics(const Scene& scene, const ElementCaster& caster,
                                                 const DirectLight& direct_light, int photons,
                                                 int max_specular_depth,
                                                 const Progress& progress = {});

}  // namespace lightwell
