#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "mesh/geometry/box_tree.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/emitters/emitter.h"
#include "radiosity/visibility/occluders.h"
#include "scene/surface_point.h"

namespace lightwell {

/// The visible share of an emitting polygon from a point, by clipping away the parts that polygons
/// hide (ShadowedPolygon) instead of by shadow rays: penumbrae without noise, in the time of 16 to
/// 100 rays, while few polygons are occluders.
class ExactShadows {
 public:
  /// `mesh` must be free of moving bodies. Meshes of more than most_facets facets get no exact
  /// shares: few of their shadows would be exact, and the table of occluders would be large.
  ExactShadows(const Scene& scene, const PatchMesh& mesh, std::span<const Emitter> emitters);

  static constexpr int most_facets = 50000;

  /// The visible share of the form factor from a differential element to an emitter, [0, 1];
  /// exactly 1 or 0 where all or nothing is visible. Empty, so that rays must decide, if
  /// - more than `most_pieces` convex polygons may be occluders (below 0: always empty);
  /// - a round shape, a clear pane or a texture with holes may be one;
  /// - the emitter is no polygon, or another surface lies on it;
  /// - another surface lies on the point.
  std::optional<double> share(int emitter, const SurfacePoint& at, int most_pieces) const;

 private:
  // One side of an emitter.
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
  std::optional<BoxTree> tree_{};   // of pieces, and after them of round shapes
  std::vector<Target> targets_{};
};

}  // namespace lightwell
