#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/paths/caustic_photons.h"
#include "raytrace/caustics/light_regions.h"
#include "raytrace/caustics/photon_discs.h"

namespace lightwell {

/// Irradiance of photons on surfaces (Jensen 1996), spread over discs (see PhotonDiscs) that reach
/// to the k-th neighbour, with k proportional to N^(2/3) for N photons. Both the noise, k^(-1/2),
/// and the blurred area, k / N, then shrink with N, in the balance that minimizes their sum
/// (Silverman 1986).
///
/// Wider discs, of some ten and forty times the area, take over where light is smooth: of clusters
/// of as many photons, so that a point reads about as many discs of each width. The light of a
/// wider disc counts (after Lepski 1991)
/// - as far as it agrees with that of the narrowest one within the noise: whole up to three
///   standard deviations, and nothing from four on;
/// - as far as a still wider disc agrees with it: whole up to half a standard deviation of the
///   narrower disc that it takes over from, or 2 % of all light if that is less, and nothing from
///   three times that on.
/// The integral of irradiance equals the power of the photons up to a part of the noise.
class CausticMap {
 public:
  CausticMap(const PatchMesh& mesh, const CausticPhotons& photons);

  /// Irradiance at `point` of `element`, W/m^2 per band. `normal` is the unit normal of the surface
  /// at `point`. Photons on elements whose normal is within 60 degrees of `normal` count. Wider
  /// discs are left out where the noise is half a percent of all light or less, with `besides`, the
  /// mean of the bands of other irradiance there, W/m^2.
  Spectrum irradiance(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, int element,
                      double besides = 0.0) const;

  /// Number of neighbours k that a disc reaches over, for `count` photons in all; at least 16.
  static int neighbours(std::size_t count);

 private:
  void measure_noise(const PatchMesh& mesh, const PhotonSums& clusters, int k);

  LightRegions regions_;
  int bands_;
  std::vector<float> noise_{};         // per region, over that of independent photons
  std::vector<PhotonDiscs> layers_{};  // the narrowest first
};

/// Returns the map of `photons` photons of shoot_photons(), which follow up to `max_specular_depth`
/// mirrors and glass surfaces. Throws as shoot_photons().
std::shared_ptr<const CausticMap> trace_caustics(const Scene& scene, const ElementCaster& caster,
                                                 const DirectLight& direct_light, int photons,
                                                 int max_specular_depth,
                                                 const Progress& progress = {});

}  // namespace lightwell
