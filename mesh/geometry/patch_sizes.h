#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "mesh/geometry/cut_size.h"
#include "scene/scenery_box.h"

namespace lightwell {

class PatchSizes;

/// The sizes that one facet is cut with.
struct FacetSize {
  CutSize cut{};  ///< of the whole facet, or its smallest ones
  /// Not null: patches grow from those of `cut` as these sizes do from place to place.
  const PatchSizes* graded = nullptr;
};

/// Sizes of patches by facet and place: even, or those of a scene with surroundings. What is near
/// then has the sizes that it has without them. At a distance d from the box of what is near,
/// patches of the surroundings are at most d / 2 long, and neither shorter than those of what is
/// near nor longer than a largest size. All sizes are those of what is near times powers of two.
class PatchSizes {
 public:
  /// `even` sizes everywhere.
  explicit PatchSizes(const CutSize& even) : near_(even) {}
  /// Sizes for a scene's parts, with the power of two that makes `near` about `farthest` metres.
  PatchSizes(const CutSize& near, double farthest, Scenery scenery);

  /// The same patches with other elements.
  PatchSizes with(int elements_per_edge) const;
  const CutSize& near() const { return near_; }
  bool are_even() const { return levels_ == 0; }
  /// True for a facet of what is near; for all facets if sizes are even.
  bool is_near(int facet) const {
    return are_even() || scenery_.is_near[static_cast<std::size_t>(facet)] != 0;
  }
  /// The largest patch size, a power of two times the smallest, of the surroundings at places
  /// within `radius` (metres) of `center`.
  double within(const Eigen::Vector3d& center, double radius) const;
  FacetSize of_facet(int facet, const Eigen::AlignedBox3d& box) const;
  /// The sizes of a round shape, which are those of what is near or the largest: surroundings such
  /// as a globe have their middle where sizes are smallest.
  CutSize of_round_shape(int facet) const;
  /// Parameters, ascending in (0, 1), that cut a line of the surroundings from a to b into elements
  /// of the sizes along it.
  std::vector<double> cuts(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
  /// About how many elements a polygon facet of an area (m^2) and a boundary (m) has.
  double elements(const FacetSize& size, double area, double boundary) const;

 private:
  CutSize at_level(int level) const;
  int level_at(double distance) const;
  /// The levels of the smallest and the largest sizes within `radius` of `center`.
  std::array<int, 2> levels_within(const Eigen::Vector3d& center, double radius) const;

  CutSize near_;
  Scenery scenery_{};
  int levels_ = 0;  // sizes are near_ times 2^0 to 2^levels_
};

}  // namespace lightwell
