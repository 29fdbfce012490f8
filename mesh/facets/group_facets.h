#pragma once

#include <Eigen/Geometry>
#include <numbers>
#include <vector>

namespace lightwell {

/// A patch of one facet, before facets are grouped.
struct FacetPatch {
  int surface = 0;
  bool may_join = true;
  int facet = 0;  ///< number of its facet; patches that contact lines part are not joined again
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
  double angle_degrees = 20.0;  ///< largest angle of a facet's normal with its patch's mean

  double radians() const { return angle_degrees * std::numbers::pi / 180.0; }
};

/// Largest area of a group, as a share of patch_size^2.
inline constexpr double most_group_area = 1.2;
/// Share of the angle that a normal may deviate from the seed's, since the mean may move from the
/// seed.
inline constexpr double seed_angle = 0.75;

/// Joins patches of facets smaller than half a patch into patches of about `patch_size`, so that
/// the number of patches of a curved surface follows its area and not its number of facets (face
/// clusters; Willmott, Heckbert & Garland 1999, "Face cluster radiosity").
///
/// 1. Groups grow from seeds, the largest facet first. Neighbours across edges are added, nearest
///    first, while their centres are within 0.7 patch sizes of the seed's and their normals within
///    3/4 of the angle of the seed's. Members whose normals are not within the angle of the mean
///    are released.
/// 2. A group below half a patch joins a neighbour that has room.
/// 3. A group below 15 % of a patch is joined with others close by that face alike, connected or
///    not (see merge_small_groups()): a plant's leaves, a heap of bolts.
///
/// All normals of a group are within the angle of their mean. Returns for each patch the
/// lowest-numbered patch of its group.
std::vector<int> group_facets(const std::vector<FacetPatch>& patches,
                              const std::vector<FacetPatchContact>& contacts,
                              const FacetGroupOptions& options);

}  // namespace lightwell
