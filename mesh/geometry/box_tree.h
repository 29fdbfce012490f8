#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

namespace lightwell {

/// A binary tree of axis-aligned boxes, split at the median centre along the widest axis. Building
/// takes O(n log n); a query takes about O(log n + boxes found).
class BoxTree {
 public:
  using Box = Eigen::AlignedBox3d;
  explicit BoxTree(std::vector<Box> boxes);

  /// Fills `found` with the indices of the boxes that meet `query` (touching counts), ascending.
  void find_overlaps(const Box& query, std::vector<int>& found) const;
  /// Fills `found` with the indices of the boxes that meet both `query` and `plane` (unit normal),
  /// ascending.
  void find_on_plane(const Box& query, const Eigen::Hyperplane<double, 3>& plane,
                     std::vector<int>& found) const;
  /// Fills `found` with the indices of the boxes that reach more than `least` in front of every one
  /// of the planes (unit normals), in no particular order. `visits` and the result are those of
  /// find_along().
  bool find_before(std::span<const Eigen::Hyperplane<double, 3>> planes, double least,
                   std::int64_t& visits, std::vector<int>& found) const;
  /// Fills `found` with the indices of the boxes within `reach` of the segment a-b, in no
  /// particular order; a few boxes slightly farther away may be among them. At most `visits` nodes
  /// of the tree are visited, and `visits` is lowered by their number. Returns false, with `found`
  /// empty, if `visits` did not suffice.
  bool find_along(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double reach,
                  std::int64_t& visits, std::vector<int>& found) const;

 private:
  struct Node {
    Box box{};
    int begin = 0, end = 0;  ///< a range of order_
    int right = 0;  ///< index of the right child, 0 in a leaf; the left child follows its parent
  };
  int build(int begin, int end);
  // Fills `found` with the boxes for which meets(box) holds, in no particular order; `visits` and
  // the result are those of find_along().
  template <class Meets>
  bool collect(const Meets& meets, std::int64_t& visits, std::vector<int>& found) const;
  template <class Meets>
  void find(const Meets& meets, std::vector<int>& found) const;

  std::vector<Box> boxes_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace lightwell
