#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
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
  /// The same, of the boxes of index `first` and above. A search for all pairs that meet finds each
  /// pair once if the search for a box begins behind that box.
  void find_overlaps_from(int first, const Box& query, std::vector<int>& found) const;
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
  /// Calls visit(i) for boxes at most sqrt(`reach2`) metres from a point, parts of the tree that
  /// lie nearer first. `visit` may lower `reach2`, as a search for the nearest does.
  template <class Visit>
  void visit_near(const Eigen::Vector3d& from, const double& reach2, Visit&& visit) const;

 private:
  /// The tree halves at every level, so its depth stays below 32 for any int count, and a search
  /// that keeps one node of each level has room.
  static constexpr std::size_t deepest = 64;
  struct Node {
    Box box{};
    int begin = 0, end = 0;  ///< a range of order_
    int right = 0;    ///< index of the right child, 0 in a leaf; the left child follows its parent
    int highest = 0;  ///< index of a box
  };
  using Key = std::pair<double, int>;  ///< a centre along an axis, and the index of its box
  int build(int begin, int end, std::vector<Key>& keys);
  // Fills `found` with the boxes for which meets(box) holds, in no particular order; `visits` and
  // the result are those of find_along().
  template <class Meets>
  bool collect(const Meets& meets, std::int64_t& visits, std::vector<int>& found) const;

  std::vector<Box> boxes_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

template <class Visit>
void BoxTree::visit_near(const Eigen::Vector3d& from, const double& reach2, Visit&& visit) const {
  if (nodes_.empty()) return;
  struct Branch {
    int node = 0;
    double distance2 = 0.0;
  };
  const auto branch = [&](int node) {
    return Branch{node, nodes_[static_cast<std::size_t>(node)].box.squaredExteriorDistance(from)};
  };
  std::array<Branch, deepest> stack;
  std::size_t depth = 0;
  stack[depth++] = branch(0);
  while (depth > 0) {
    const Branch next = stack[--depth];
    if (next.distance2 > reach2) continue;
    const Node& node = nodes_[static_cast<std::size_t>(next.node)];
    if (node.right != 0) {
      const Branch left = branch(next.node + 1), right = branch(node.right);
      const bool is_left_nearer = left.distance2 <= right.distance2;
      stack[depth++] = is_left_nearer ? right : left;
      stack[depth++] = is_left_nearer ? left : right;
      continue;
    }
    for (int i = node.begin; i < node.end; ++i) {
      const int box = order_[static_cast<std::size_t>(i)];
      if (boxes_[static_cast<std::size_t>(box)].squaredExteriorDistance(from) <= reach2) visit(box);
    }
  }
}

}  // namespace lightwell
