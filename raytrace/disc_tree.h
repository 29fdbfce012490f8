#pragma once

#include <Eigen/Core>
#include <vector>

namespace lightwell {

/// Discs that lie on surfaces, and trees of boxes over them: one over each run of discs that
/// build() is given.
struct DiscTree {
  struct Disc {
    Eigen::Vector3f center, normal;
    float radius2 = 0.0f;  ///< the radius squared
    int photon = 0;        ///< that it is of
  };
  /// Children of node i are i + 1 and `second`.
  struct Node {
    Eigen::Array3f low, high;
    int begin = 0, end = 0;  ///< discs
    int second = -1;         ///< -1: a leaf
  };
  static constexpr int leaf_size = 12;

  std::vector<Disc> discs{};
  std::vector<Node> nodes{};

  /// Orders the discs from `begin` to `end`, at least one, and puts boxes around their centres; the
  /// root's number.
  int build(int begin, int end);
  /// Appends the largest nodes at and below `n` that hold no more than `most` discs, or are leaves.
  void collect(int n, int most, std::vector<int>& found) const;
};

/// Finds the k-th nearest disc's centre.
class NearestDiscs {
 public:
  NearestDiscs(const DiscTree& tree, int k);

  /// Squared distance to the k-th of the discs below `root`, of which there are k at least.
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
