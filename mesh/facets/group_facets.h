#pragma once

#include <Eigen/Geometry>
#include <numbers>
#include <vector>

namespace lightwell {

/// A patch of one facet, which may become part of a larger one that reaches over many.
struct FacetPatch {
  int surface = 0;
  bool may_join = true;
  int facet = 0;  ///< lines on which others stand may part its patches: they are not joined again
  double area = 0.0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit
  Eigen::AlignedBox3d box{};
};

/// Two patches of different facets that share an edge at which nothing else stands.
struct FacetPatchContact {
  int one = 0, other = 0;
};

struct FacetGroupOptions {
  double patch_size = 1.0;      ///< metres
  double angle_degrees = 20.0;  ///< of a facet's normal from its patch's mean

  double radians() const { return angle_degrees * std::numbers::pi / 180.0; }
};

inline constexpr double most_group_area = 1.2;  ///< of a patch of the size asked for
inline constexpr double seed_angle = 0.75;      ///< of the angle: a mean may move from its seed

/// Joins patches of facets smaller than half a patch into patches of about `patch_size`, so that a
/// curved surface has as many as its area asks for and not as many as it has facets (face clusters;
/// Willmott, Heckbert & Garland 1999, "Face cluster radiosity").
///
/// From the largest facet on, its neighbours across edges are added, nearest first, while their
/// middles are within 0.7 patch sizes of its middle and their normals within 3/4 of the angle of
/// its own; what then is not within the angle of the mean is let go of. Less than half a patch
/// joins a neighbour that has room. What is less than 15 % of a patch still is joined with others
/// of its place that face alike (see merge_small_groups): a plant's leaves, a heap of bolts. All
/// normals of a group are within the angle of their mean. Result: by patch of a facet the lowest
/// one of its group.
std::vector<int> group_facets(const std::vector<FacetPatch>& patches,
                              const std::vector<FacetPatchContact>& contacts,
                              const FacetGroupOptions& options);

}  // namespace lightwell
