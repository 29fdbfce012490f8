#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "mesh/geometry/box_tree.h"
#include "radiosity/emitters/direct_light.h"
#include "radiosity/visibility/occluders.h"
#include "scene/surface_point.h"

namespace lightwell {

/// How much of a polygon that emits a point sees, found by taking away what polygons hide of it
/// (ShadowedPolygon) instead of by shadow rays: penumbras without noise, in the time of 16 to 100
/// rays, as long as few polygons are in the way.
class ExactShadows {
 public:
  /// Occluders of a mesh in which nothing moves. Of meshes of more facets than most_facets nothing
  /// is told: little of their shadows would be, and what to keep of them is large.
  ExactShadows(const Scene& scene, const PatchMesh& mesh, std::span<const Emitter> emitters);

  static constexpr int most_facets = 50000;

  /// The visible share of the form factor from a differential element to an emitter, [0, 1],
  /// exactly 1 or 0 where all or nothing is seen. Empty where rays have to tell: where more than
  /// `most_pieces` (below 0: none at all) convex polygons may be in the way, a sphere, a clear
  /// pane, or a picture that cuts holes; to emitters that are no polygons, or have something lying
  /// on them; and from points that lie under something.
  std::optional<double> share(int emitter, const SurfacePoint& at, int most_pieces) const;

 private:
  // An emitter from one of its sides.
  struct Face {
    std::vector<ConvexPolygon> parts{};   // counter-clockwise seen from there
    std::vector<Eigen::Vector3d> hull{};  // the same, holds all parts
    HalfSpace plane{};
  };
  struct Target {
    Face front{}, back{};
    std::vector<Eigen::Vector3d> corners{};
    bool is_exact = false;
  };
  Target target_of(const Emitter& emitter) const;
  bool is_covered(const Target& target, int sheet) const;
  bool is_covered(const Eigen::Vector3d& point, int sheet) const;

  std::optional<Occluders> occluders_{};
  std::vector<char> needs_rays_{};  // per piece
  std::optional<BoxTree> tree_{};   // of pieces, and after them of spheres
  std::vector<Target> targets_{};
};

}  // namespace lightwell
