#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "mesh/geometry/box_tree.h"
#include "mesh/geometry/cut_size.h"
#include "scene/round_shape.h"
#include "scene/scene.h"

namespace lightwell {

/// The sizes for a sphere whose elements stay as they are: `size`, but with elements that span 180
/// / 8 degrees at most, however small the sphere. The irradiance of far light is a cosine along a
/// great circle, and linear elements of an angle d are off by d^2 / 8 of its greatest value at
/// most: 2 % for 8 rings, 31 % for 2. Where a scene has so many `spheres` that their elements would
/// be more than 65536, rings are fewer. Other shapes keep `size`: they are straight along their
/// axes, and have enough sectors.
CutSize fine_enough(const RoundShape& shape, const CutSize& size, int spheres);

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
