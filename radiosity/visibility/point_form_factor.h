#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/visibility/shaft.h"

namespace lightwell {

/// A point of a receiving surface.
struct ReceivingPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit
  int facet = -1;         ///< scene-wide facet of the point; -1: in free space
  std::uint64_t key = 0;  ///< with the shooter, seed of the samples: the number of a vertex
};

/// Corner of an element, moved by 1e-4 of the way towards the element's centre. The moved point
/// lies on the element's side of any surface that touches the corner. The moved point also lies off
/// the edges of shooters, at which form factors jump.
ReceivingPoint receiving_corner(const PatchMesh& mesh, int element, int corner);

struct PointFormFactorOptions {
  int min_rays = 16;   ///< initial shadow rays per point; a power of 4 stratifies best
  int max_rays = 256;  ///< most shadow rays per point
  /// Standard error of F above which a point with both blocked and unblocked rays casts four times
  /// as many.
  double target_error = 1e-3;
};

/// Form factors F from points (differential elements) of surfaces to shooting patches, visibility
/// included, for progressive refinement at the vertices of elements (Wallace, Elmquist & Haines
/// 1989). A shooter of radiosity B gives the point the irradiance E = B F.
///
/// 0 <= F <= 1. F is 0 for points behind, in the plane of (to Occluders::tolerance), or on an edge
/// of the shooter. An occluder hides nothing from a point if either lies in the plane of the other.
/// F depends on the shooter and the point alone, not on other points of the call or on the number
/// of threads. Keeps a reference to the caster.
class PointFormFactors {
 public:
  explicit PointFormFactors(const ElementCaster& caster);

  /// F with the shooter of area A as n discs of area A/n, one about each of n stratified random
  /// points,
  ///
  ///   F = A/n sum_s V_s cos(theta) cos(theta_s) / (pi r_s^2 + A/n)
  ///
  /// (Wallace et al. 1989). V_s is the visibility of sample point s by one shadow ray. Fast and
  /// bounded. Too small near the shooter, by a relative error of about A / (n pi r^2).
  void by_discs(int shooter, int n, std::span<const ReceivingPoint> points,
                std::span<double> F) const;

  /// F as the closed form of the whole shooter (point_to_polygon) times visibility. Methods for the
  /// visibility:
  ///   - 1 where the shaft from the point to the shooter is empty;
  ///   - exact clipping (ShadowedPolygon) where the shaft holds at most most_pieces_between convex
  ///     polygons;
  ///   - otherwise the visible share of the kernel cos cos / r^2, by shadow rays to stratified
  ///     points of the shooter.
  ///
  /// Patches of round shapes, and polygons that cross themselves, use by_discs with `max_rays`
  /// discs.
  void by_closed_form(int shooter, std::span<const ReceivingPoint> points, std::span<double> F,
                      const PointFormFactorOptions& options = {}) const;

 private:
  struct Unsampled {
    double F = 0.0;
    bool needs_rays = false;
  };
  Unsampled without_rays(const ShaftEnd& target, const ReceivingPoint& point) const;

  const ElementCaster& caster_;
  Shafts shafts_;
};

}  // namespace lightwell
