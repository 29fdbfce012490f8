#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "scene/ray_caster.h"

namespace lightwell {

/// Where the groups of a CastGeometry lie, and where one lies on another in the same plane: what a
/// ray that starts on a group needs to know.
class CoplanarGroups {
 public:
  /// Planes closer than `tolerance`, metres, are one.
  CoplanarGroups(const CastGeometry& geometry, double tolerance);

  /// Unit normal, of either sign; zero for a sphere, or a number that is no group.
  const Eigen::Vector3d& normal(int group) const {
    return is_known(group) ? groups_[group].normal : none_;
  }

  /// Whether another group may lie on this one at `point`. Never wrong with "no"; a "yes" may be,
  /// for boxes stand for the groups.
  bool may_be_covered(int group, const Eigen::Vector3d& point) const;

 private:
  struct Group {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    std::vector<Eigen::AlignedBox3d> overlaps{};  // with others of its plane
  };
  struct Plane;
  static std::vector<Plane> planes_of(const CastGeometry& geometry);
  void add_overlaps(const CastGeometry& geometry, std::span<Plane> planes, double tolerance);
  bool is_known(int group) const { return group >= 0 && group < static_cast<int>(groups_.size()); }

  std::vector<Group> groups_;
  Eigen::Vector3d none_ = Eigen::Vector3d::Zero();
};

}  // namespace lightwell
