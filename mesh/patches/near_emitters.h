#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "mesh/geometry/box_tree.h"
#include "mesh/geometry/cut_size.h"
#include "scene/round_shape.h"
#include "scene/scene.h"

namespace lightwell {

/// Emitting facets and lamps of a scene, for the elements of round shapes near them. Refinement
/// splits no round shape, and light of a bulb falls to a quarter within the bulb's distance from
/// its shade.
class NearEmitters {
 public:
  explicit NearEmitters(const Scene& scene);

  /// The sizes, m, for a shape of a surface of the scene: those of `size`, but elements no longer
  /// than a quarter of the way to the nearest emitter of another surface. They are no shorter for
  /// that than a 16th of those of `size`, nor than a twelfth of the radius of a ball around the
  /// shape: on a column with a lamp all elements would be as small as the lamp's.
  CutSize cut(const RoundShape& shape, int surface, const CutSize& size) const;

 private:
  double distance(const RoundShape& shape, int surface, double farthest) const;

  std::vector<Eigen::AlignedBox3d> boxes_{};
  std::vector<int> surface_{};  // of each box; -1: a lamp
  BoxTree tree_;
};

}  // namespace lightwell
