#include "scene/disjoint_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "scene/sampling.h"

namespace lightwell::disjoint_sets_test {

// The sets are the connected components of the graph whose edges are the joins: found here by
// passing on the least number along edges until none changes.
TEST(DisjointSets, AreTheComponentsOfTheGraphOfJoins) {
  constexpr int count = 60, joins = 40;
  for (std::uint64_t graph = 0; graph < 50; ++graph) {
    DisjointSets sets(count);
    std::vector<int> least(count);
    for (int i = 0; i < count; ++i) least[i] = i;
    std::vector<std::array<int, 2>> edges;
    for (std::uint64_t j = 0; j < joins; ++j) {
      const auto pick = [&](std::uint64_t end) {
        return static_cast<int>(count * random_uniform(random_key(graph, j, end)));
      };
      edges.push_back({pick(0), pick(1)});
      const int root = sets.join(edges.back()[0], edges.back()[1]);
      EXPECT_EQ(root, sets.root(edges.back()[1]));
    }
    for (bool is_changed = true; is_changed;) {
      is_changed = false;
      for (const auto& [a, b] : edges) {
        if (least[a] == least[b]) continue;
        least[a] = least[b] = std::min(least[a], least[b]);
        is_changed = true;
      }
    }
    for (int i = 0; i < count; ++i) EXPECT_EQ(sets.root(i), least[i]) << "number " << i;
  }
}

TEST(DisjointSets, GrowBySetsOfOne) {
  DisjointSets sets(2);
  sets.join(0, 1);
  EXPECT_EQ(sets.add(3), 2);
  EXPECT_EQ(sets.size(), 5u);
  EXPECT_EQ(sets.root(4), 4);
  EXPECT_EQ(sets.join(4, 1), 0);
  EXPECT_EQ(sets.root(3), 3);
}

}  // namespace lightwell::disjoint_sets_test
