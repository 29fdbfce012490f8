#pragma once

#include <Eigen/Geometry>
#include <vector>

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

  /// The sizes for a shape of a surface: those of `size`, but elements no longer than a quarter of
  /// the way to the nearest emitter of another surface, and no shorter than a 16th of `size`.
  CutSize cut(const RoundShape& shape, int surface, const CutSize& size) const;

 private:
  double distance(const RoundShape& shape, int surface, double farthest) const;

  struct Emitter {
    int surface = -1;  // -1: a lamp
    Eigen::AlignedBox3d box{};
  };
  std::vector<Emitter> emitters_{};
};

}  // namespace lightwell
