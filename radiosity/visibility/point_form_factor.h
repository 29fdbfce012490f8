#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/visibility/shaft.h"

namespace lightwell {

/// A point of a surface that receives.
struct ReceivingPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit
  int facet = -1;         ///< scene-wide facet on which it lies; -1: in free space
  std::uint64_t key = 0;  ///< with the shooter decides where samples fall: the number of a vertex
};

/// A corner of an element, moved by 1e-4 of the way towards the element's middle: on its own side
/// of whatever touches the surface there, and off the edges of shooters, at which form factors
/// jump.
ReceivingPoint receiving_corner(const PatchMesh& mesh, int element, int corner);

struct PointFormFactorOptions {
  int min_rays = 16;   ///< shadow rays for a point to begin with; a power of 4 stratifies best
  int max_rays = 256;  ///< most for a point
  /// Rays are multiplied by four while some are blocked and some not and the standard error of F is
  /// above this.
  double target_error = 1e-3;
};

/// Form factors F from points (differential elements) of surfaces to patches that shoot, visibility
/// included: what progressive refinement needs at the vertices of elements (Wallace, Elmquist &
/// Haines 1989). A shooter of radiosity B gives the point the irradiance B F.
///
/// 0 <= F <= 1. 0 for points behind or in the plane of the shooter (to Occluders::tolerance), on
/// its edges too. What lies in a point's own plane, or has the point in its plane, does not hide
/// anything from it. F depends on the shooter and the point alone, not on what else is asked for
/// or on the number of threads. Keeps a reference to the caster.
class PointFormFactors {
 public:
  explicit PointFormFactors(const ElementCaster& caster);

  /// The shooter as n discs of its area A, one about each of n stratified random points,
  ///
  ///   F = A/n sum_s V_s cos(theta) cos(theta_s) / (pi r_s^2 + A/n)
  ///
  /// (Wallace et al. 1989), V_s by a shadow ray to each point. Quick and never infinite; too
  /// small near the shooter, by a share of about A / (n pi r^2).
  void by_discs(int shooter, int n, std::span<const ReceivingPoint> points,
                std::span<double> F) const;

  /// The closed form of the whole shooter (point_to_polygon) times visibility: 1 where the shaft
  /// from the point to the shooter holds nothing, exact by clipping (ShadowedPolygon) where it
  /// holds at most most_pieces_between convex polygons, else the share of the kernel cos cos / r^2
  /// that shadow rays to stratified points of the shooter see. For patches of spheres, and polygons
  /// that cross themselves, it is by_discs with `max_rays` discs.
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
