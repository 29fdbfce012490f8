#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>
#include <vector>

#include "scene/rays/ray_caster.h"

namespace lightwell {

/// Planes of the groups of a CastGeometry, the groups that lie on each other in one plane, and
/// which of two such groups a ray meets first.
///
/// Two surfaces in one plane coincide, but are seldom meant to be one: the floor and the block that
/// stands on the floor, the wall of a room and the wall of the next room. Each surface belongs to a
/// body, which consists of the faces that share its edges, and lies on that body's side. If both
/// bodies are on one side, one holds the other: the block, whose faces lie behind its bottom, is
/// inside of the room, whose walls rise before its floor. If a body is not known (a sheet),
/// surfaces that face opposite ways are taken to touch with their fronts; two sheets of one area,
/// by which many programs write a sheet with two faces, with their backs. Of surfaces that face the
/// same way and whose bodies do not differ, or are not known, the smaller lies before the larger,
/// as a picture lies on a wall; of one area, a sheet before the face of a body, and otherwise the
/// group of the lower number, as where a model holds a surface twice.
class CoplanarGroups {
 public:
  /// Planes closer than `tolerance`, metres, are one. Distances are measured from the middle of the
  /// geometry, so that a geometry far from the origin of its coordinates loses no digits.
  CoplanarGroups(const CastGeometry& geometry, double tolerance);

  /// Unit normal of a group's plane, of either sign; groups that lie on each other have the same
  /// sign. Zero for a round shape, or for a number that is no group.
  const Eigen::Vector3d& normal(int group) const {
    return is_known(group) ? groups_[group].normal : none_;
  }

  /// True if two groups' planes are parallel, within the digits of a file.
  bool are_parallel(int a, int b) const { return lie_parallel(normal(a), normal(b)); }

  /// Order of two groups that lie on each other: 1 if `a` lies above `b` along normal(a), -1 if
  /// below, 0 for a group and itself.
  int order(int a, int b) const;

  /// True if the group lies on any other.
  bool has_overlaps(int group) const { return is_known(group) && !groups_[group].overlaps.empty(); }

  /// Height of `point` over the group's plane along normal(group), metres.
  double height(int group, const Eigen::Vector3d& point) const {
    return normal(group).dot(point - groups_[group].corner);
  }

  /// False if no other group lies on this group at `point`. True may be wrong, because boxes stand
  /// for the groups.
  bool may_be_covered(int group, const Eigen::Vector3d& point) const;

  /// The same for the groups that order() places on the side that `direction` points to.
  bool may_be_covered(int group, const Eigen::Vector3d& point,
                      const Eigen::Vector3d& direction) const;

 private:
  // Boxes sorted along an axis: a hundred blocks may stand on a floor, and every ray from the floor
  // searches for the blocks about its origin.
  class Boxes {
   public:
    Boxes() = default;
    explicit Boxes(const Eigen::AlignedBox3d& box) : boxes_{box} {}
    void add(const Eigen::AlignedBox3d& box) { boxes_.push_back(box); }
    bool empty() const { return boxes_.empty(); }
    void sort();  // to be called after the last add() and before contain()
    bool contain(const Eigen::Vector3d& point) const;

   private:
    std::vector<Eigen::AlignedBox3d> boxes_{};  // sorted by their low ends along axis_
    std::vector<double> reach_{};               // highest end among a box and all boxes before
    int axis_ = 0;
  };
  struct Group {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    Eigen::Vector3d corner = Eigen::Vector3d::Zero();  // a point of the plane
    Boxes overlaps{};                                  // with other groups of the plane
    Boxes above{}, below{};  // overlaps of groups that lie above or below, along the normal
    int facing = 0;          // front: 1 along the normal, -1 against the normal
    int body = 0;       // side of the body: 1 along the normal, -1 against the normal, 0 not known
    double area = 0.0;  // m^2
  };
  struct Plane;
  struct Pair {  // groups that lie on each other, and the box that holds all they share
    std::array<int, 2> group{};
    Eigen::AlignedBox3d box{};
  };
  bool lies_before(int a, int b) const;
  static bool have_one_area(const Group& a, const Group& b);
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
  void sort_by_side(const std::vector<Pair>& pairs);
  void find_bodies(const CastGeometry& geometry, double tolerance);
  bool is_known(int group) const { return group >= 0 && group < static_cast<int>(groups_.size()); }

  std::vector<Group> groups_;
  Eigen::Vector3d none_ = Eigen::Vector3d::Zero();
};

}  // namespace lightwell
