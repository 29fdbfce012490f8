#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>
#include <vector>

#include "scene/rays/ray_caster.h"

namespace lightwell {

/// Where the groups of a CastGeometry lie, where one lies on another in the same plane, and which
/// of the two is then met first.
///
/// Two surfaces in one plane are as near as can be, but seldom meant to be one: the floor and the
/// block that stands on it, the wall of a room and the wall of the next. Each belongs to a body,
/// the faces that share its edges, and lies on that body's side. Where both bodies are on one side,
/// one holds the other: the block, whose faces lie behind its bottom, is inside of the room, whose
/// walls rise before its floor. Where a body is not known (a sheet), surfaces that face each other
/// are taken to touch with their fronts. Of those that face one way nothing is known then.
class CoplanarGroups {
 public:
  /// Planes closer than `tolerance`, metres, are one. They are measured from the middle of the
  /// geometry, so that one far from the origin of its coordinates loses no digits.
  CoplanarGroups(const CastGeometry& geometry, double tolerance);

  /// Unit normal, of either sign, but of one sign for groups that lie on each other; zero for a
  /// sphere, or a number that is no group.
  const Eigen::Vector3d& normal(int group) const {
    return is_known(group) ? groups_[group].normal : none_;
  }

  /// Whether two groups' planes are parallel, for all that a file's digits can tell.
  bool are_parallel(int a, int b) const { return lie_parallel(normal(a), normal(b)); }

  /// Of two groups that lie on each other: 1 if `a` lies above `b` along normal(a), -1 if below, 0
  /// if that cannot be told.
  int order(int a, int b) const;

  /// Whether the group lies on any other.
  bool has_overlaps(int group) const { return is_known(group) && !groups_[group].overlaps.empty(); }

  /// How far `point` lies off the group's plane, along its normal.
  double height(int group, const Eigen::Vector3d& point) const {
    return normal(group).dot(point - groups_[group].corner);
  }

  /// Whether another group may lie on this one at `point`. Never wrong with "no"; a "yes" may be,
  /// for boxes stand for the groups.
  bool may_be_covered(int group, const Eigen::Vector3d& point) const;

 private:
  // A hundred boxes may stand on a floor, and every ray from there asks for those about its origin.
  class Boxes {
   public:
    Boxes() = default;
    explicit Boxes(const Eigen::AlignedBox3d& box) : boxes_{box} {}
    void add(const Eigen::AlignedBox3d& box) { boxes_.push_back(box); }
    bool empty() const { return boxes_.empty(); }
    void sort();  // when all are there, and before contain() is asked
    bool contain(const Eigen::Vector3d& point) const;

   private:
    std::vector<Eigen::AlignedBox3d> boxes_{};  // by their low ends along the axis
    std::vector<double> reach_{};               // the highest end of these and all before
    int axis_ = 0;
  };
  struct Group {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    Eigen::Vector3d corner = Eigen::Vector3d::Zero();  // a point of the plane
    Boxes overlaps{};                                  // with others of its plane
    int facing = 0;  // of the front: 1 along the normal, -1 against it
    int body = 0;    // 1: its body lies on the side of the normal, -1: on the other, 0: not known
  };
  struct Plane;
  using Pair = std::array<int, 2>;  // groups that lie on each other
  static bool lie_parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
  static std::vector<Plane> planes_of(const CastGeometry& geometry);
  void add_overlaps(const CastGeometry& geometry, std::span<Plane> planes, double tolerance,
                    std::vector<Pair>& pairs);
  static bool is_one_plane(const Plane& a, const Plane& b, const Eigen::Vector3d& place,
                           double tolerance);
  static bool share_area(const CastGeometry& geometry, const Plane& a, const Plane& b, int along,
                         double tolerance);
  static void flatten(const CastGeometry& geometry, int along, Plane& plane);
  void align_normals(const std::vector<Pair>& pairs);
  void find_bodies(const CastGeometry& geometry, double tolerance);
  bool is_known(int group) const { return group >= 0 && group < static_cast<int>(groups_.size()); }

  std::vector<Group> groups_;
  Eigen::Vector3d none_ = Eigen::Vector3d::Zero();
};

}  // namespace lightwell
