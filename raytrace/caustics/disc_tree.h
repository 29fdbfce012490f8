#pragma once

#include <Eigen/Core>
#include <vector>

namespace lightwell {

/// Discs on surfaces, and binary trees of axis-aligned boxes over them. Each call of build() makes
/// one tree over a run of discs.
struct DiscTree {
  struct Disc {
    Eigen::Vector3f center, normal;
    float radius2 = 0.0f;  ///< squared radius
    int photon = 0;        ///< number of the disc's photon
  };
  /// Box of a run of discs. The children of node i are i + 1 and `second`.
  struct Node {
    Eigen::Array3f low, high;
    int begin = 0, end = 0;  ///< discs
    int second = -1;         ///< -1: a leaf
  };
  static constexpr int leaf_size = 12;

  std::vector<Disc> discs{};
  std::vector<Node> nodes{};

  /// Sorts the discs from `begin` to `end`, at least one, into a tree of boxes around their
  /// centres. Returns the number of the root node.
  int build(int begin, int end);
  /// Appends the highest nodes at and below `n` that are leaves or hold at most `most` discs.
  void collect(int n, int most, std::vector<int>& found) const;
};

/// Search for the k-th nearest disc centre.
class NearestDiscs {
 public:
  NearestDiscs(const DiscTree& tree, int k);

  /// Squared distance from `from` to the k-th nearest centre of the discs below `root`, of which
  /// there must be at least k.
  float distance2_to_last(int root, const Eigen::Vector3f& from);

 private:
  float reach() const;
  void visit(int n, const Eigen::Vector3f& from);
  void add(float distance2);

  const DiscTree& tree_;
  std::size_t k_;
  std::vector<float> heap_;  // of squared distances, the largest first
};

}  // namespace lightwell
