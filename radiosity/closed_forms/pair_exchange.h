#pragma once

#include <array>

#include "mesh/patches/patch_outline.h"

namespace lightwell {

/// Unoccluded exchange areas S_ij = A_i F_ij of pairs of patches, by one of two methods:
///   - the double contour integral (polygon_exchange) where the patches are close to each other,
///     are cut by each other's plane, or are not triangles or convex quadrilaterals;
///   - the double area integral otherwise,
///
///   S_ij = int int cos(theta_i) cos(theta_j) / (pi r^2) dA_i dA_j,
///
/// by Gauss's rule with 2 x 2 or 3 x 3 points on each patch. Relative errors of the area integral
/// stay below a bound. Keeps a reference to the outlines.
class PairExchange {
 public:
  /// Relative error of the area integral, unless another is asked for.
  static constexpr double usual_error = 1e-5;

  /// `relative_error`: bound of the relative error of the area integral; at most usual_error.
  explicit PairExchange(const std::vector<PatchOutline>& outlines,
                        double relative_error = usual_error);

  /// S_ij in square metres; 0 for patches of round shapes.
  double between(int i, int j) const { return bounded(i, j).value; }

  struct Bounded {
    double value = 0.0;  ///< S_ij, m^2
    double error = 0.0;  ///< bound of its error, m^2
  };
  /// S_ij with the bound of the method that computes the pair.
  Bounded bounded(int i, int j) const;

  /// True if some of each patch lies before the other's plane. False for patches of round shapes.
  bool face_each_other(int i, int j) const;

 private:
  /// Quadrature points, m, and weights, m^2, that sum to the area: one array per coordinate, so
  /// that loops over points vectorise.
  template <int N>
  struct Points {
    std::array<double, N> x, y, z, weight;
  };
  /// Points per patch of the 2 x 2 and the 3 x 3 rule.
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
  /// Position of patch `other` relative to the plane of patch `plane`: 1: all before it, -1: none
  /// before it, 0: cut by the plane.
  int side(int plane, int other) const;

  const std::vector<PatchOutline>& outlines_;
  double relative_error_;
  double far_from_, middle_from_;  // squares of the distances from which an area integral will do
  std::vector<double> offset_;     // of the planes, m
  std::vector<Patch> patches_;
};

}  // namespace lightwell
