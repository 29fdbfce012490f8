#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace lightwell {

/// An undirected link between two nodes, given once.
struct ExchangeLink {
  int a = 0, b = 0;
  float exchange = 0.0f;  ///< A_a F_ab = A_b F_ba, m^2
};

/// Nodes (patches, or groups of them) with the exchange A_i F_ij between them.
class ExchangeGraph {
 public:
  struct Neighbor {
    int node = 0;
    float exchange = 0.0f;  ///< m^2
  };

  /// Adds up links of the same two nodes in the order of `links`; links of a node to itself are
  /// dropped. A node whose links sum to more than its `area`, m^2, by noise gets their sum instead.
  ExchangeGraph(std::vector<double> area, std::span<const ExchangeLink> links);

  int count() const { return static_cast<int>(area_.size()); }
  double area(int node) const { return area_[static_cast<std::size_t>(node)]; }
  std::span<const Neighbor> neighbors(int node) const {
    return {neighbors_.data() + first_[static_cast<std::size_t>(node)],
            neighbors_.data() + first_[static_cast<std::size_t>(node) + 1]};
  }

 private:
  std::vector<double> area_;
  std::vector<std::size_t> first_;  // count() + 1 entries
  std::vector<Neighbor> neighbors_;
};

}  // namespace lightwell
