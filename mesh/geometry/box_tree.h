#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

namespace lightwell {

/// Finds which of many axis-aligned boxes meet a given one: a binary tree of boxes split at the
/// median centre of the widest axis. O(n log n) to build, about O(log n + answers) a question.
class BoxTree {
 public:
  using Box = Eigen::AlignedBox3d;
  explicit BoxTree(std::vector<Box> boxes);

  /// Fills `found` with the boxes that meet `query` (touching counts), in ascending order.
  void find_overlaps(const Box& query, std::vector<int>& found) const;
  /// Of those the ones that the plane (of unit normal) meets as well.
  void find_on_plane(const Box& query, const Eigen::Hyperplane<double, 3>& plane,
                     std::vector<int>& found) const;
  /// Fills `found` with the boxes that reach further than `least` before every one of the planes
  /// (of unit normals), in no order; `visits` and the result as for find_along.
  bool find_before(std::span<const Eigen::Hyperplane<double, 3>> planes, double least,
                   std::int64_t& visits, std::vector<int>& found) const;
  /// Fills `found` with the boxes that come within `reach` of the segment a-b, in no order; a few
  /// that do not may be among them. `visits` is how many nodes may be looked at, and after the call
  /// how many are left; false, and nothing found, if they were not enough.
  bool find_along(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double reach,
                  std::int64_t& visits, std::vector<int>& found) const;

 private:
  struct Node {
    Box box{};
    int begin = 0, end = 0;  ///< of order_; a leaf if `right` is 0
    int right = 0;           ///< the left child follows its parent
  };
  int build(int begin, int end);
  // False, with nothing found, when it would take more visits of nodes; counts them down.
  template <class Meets>
  bool collect(const Meets& meets, std::int64_t& visits, std::vector<int>& found) const;
  template <class Meets>
  void find(const Meets& meets, std::vector<int>& found) const;

  std::vector<Box> boxes_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace lightwell
