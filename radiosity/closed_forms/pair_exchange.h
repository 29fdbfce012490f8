#pragma once

#include <array>

#include "mesh/patches/patch_outline.h"

namespace lightwell {

/// Unoccluded exchange areas S_ij = A_i F_ij of patches, by the cheapest way that is good enough
/// for the pair: the double contour integral (polygon_exchange) where they are near or cut by each
/// other's plane or no triangles or convex quadrilaterals, else the double area integral
///
///   S_ij = int int cos(theta_i) cos(theta_j) / (pi r^2) dA_i dA_j
///
/// by Gauss's rule with 2 x 2 or 3 x 3 points on each patch. Errors of the latter stay below 1e-5
/// of the value.
class PairExchange {
 public:
  explicit PairExchange(const std::vector<PatchOutline>& outlines);

  /// Square metres; 0 for patches of spheres.
  double between(int i, int j) const;

  /// Whether any of the pair can see the other, nothing else being there.
  bool face_each_other(int i, int j) const;

 private:
  /// Points with weights that sum to the area, in arrays that a processor can work on together.
  template <int N>
  struct Points {
    std::array<double, N> x, y, z, weight;
  };
  static constexpr int few = 4, more = 9;

  struct Patch {
    Points<few> far;
    Points<more> middle;
    bool has_points = false;
  };
  template <int N>
  static Points<N> gauss_points(const std::vector<Eigen::Vector3d>& loop);
  template <int N>
  double area_integral(int i, int j, const Points<N>& from, const Points<N>& to) const;
  /// 1: all of `other` lies before the plane of `plane`, -1: nothing does, 0: the plane cuts it.
  int side(int plane, int other) const;

  const std::vector<PatchOutline>& outlines_;
  std::vector<double> offset_;  // of the planes
  std::vector<Patch> patches_;
};

}  // namespace lightwell
