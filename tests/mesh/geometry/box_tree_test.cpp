#include "mesh/geometry/box_tree.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "scene/sampling.h"

namespace lightwell::box_tree_test {
namespace {

using Eigen::Vector3d;

BoxTree::Box random_box(std::uint64_t key, double largest) {
  const Vector3d low(random_uniform(random_key(key, 0)), random_uniform(random_key(key, 1)),
                     random_uniform(random_key(key, 2)));
  const Vector3d extent(random_uniform(random_key(key, 3)), random_uniform(random_key(key, 4)),
                        random_uniform(random_key(key, 5)));
  return {low, low + largest * extent};
}

TEST(BoxTree, FindsWhatLookingAtEveryBoxFinds) {
  for (const int count : {0, 1, 5, 700}) {
    std::vector<BoxTree::Box> boxes;
    for (int i = 0; i < count; ++i) boxes.push_back(random_box(i, i % 7 == 0 ? 0.9 : 0.05));
    // Half of the boxes share one centre, which a median split cannot separate.
    for (int i = 0; i < count / 2; ++i) boxes.push_back(boxes[0]);
    const BoxTree tree(boxes);
    std::vector<int> found;
    for (int q = 0; q < 200; ++q) {
      const BoxTree::Box query = random_box(100000 + q, 0.2);
      tree.find_overlaps(query, found);
      std::vector<int> expected;
      for (int i = 0; i < static_cast<int>(boxes.size()); ++i) {
        if (boxes[i].intersects(query)) expected.push_back(i);
      }
      ASSERT_EQ(found, expected);
      const int first = boxes.empty() ? 0 : 37 * q % static_cast<int>(boxes.size());
      tree.find_overlaps_from(first, query, found);
      std::vector<int> following = expected;
      std::erase_if(following, [&](int i) { return i < first; });
      ASSERT_EQ(found, following);
      const Eigen::Hyperplane<double, 3> plane(Vector3d(1 + q, 2, 50 - q).normalized(),
                                               query.center());
      tree.find_on_plane(query, plane, found);
      std::erase_if(expected, [&](int i) {
        bool above = false, below = false;
        for (int c = 0; c < 8; ++c) {
          const auto corner = static_cast<BoxTree::Box::CornerType>(c);
          (plane.signedDistance(boxes[i].corner(corner)) > 0.0 ? above : below) = true;
        }
        return !(above && below);
      });
      ASSERT_EQ(found, expected);
    }
  }
}

TEST(BoxTree, FindsWhatReachesBeforeAllPlanes) {
  std::vector<BoxTree::Box> boxes;
  for (int i = 0; i < 500; ++i) boxes.push_back(random_box(i, 0.1));
  const BoxTree tree(boxes);
  std::vector<int> found;
  for (int q = 0; q < 100; ++q) {
    std::vector<Eigen::Hyperplane<double, 3>> planes;
    for (int k = 0; k < 4; ++k) {
      const BoxTree::Box at = random_box(random_key(q, k), 0.3);
      planes.emplace_back((at.sizes() - Vector3d::Constant(0.15)).normalized(), at.min());
    }
    constexpr double least = 0.01;
    std::vector<int> expected;
    for (int i = 0; i < static_cast<int>(boxes.size()); ++i) {
      const bool is_before = std::ranges::all_of(planes, [&](const auto& plane) {
        double highest = -1.0;
        for (int c = 0; c < 8; ++c) {
          const auto corner = static_cast<BoxTree::Box::CornerType>(c);
          highest = std::max(highest, plane.signedDistance(boxes[i].corner(corner)));
        }
        return highest > least;
      });
      if (is_before) expected.push_back(i);
    }
    std::int64_t visits = 1 << 20;
    ASSERT_TRUE(tree.find_before(planes, least, visits, found));
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
    visits = 1;
    EXPECT_FALSE(tree.find_before(planes, least, visits, found));
    EXPECT_TRUE(found.empty());
  }
}

TEST(BoxTree, VisitsTheBoxesAroundAPoint) {
  std::vector<BoxTree::Box> boxes;
  for (int i = 0; i < 500; ++i) boxes.push_back(random_box(i, i % 7 == 0 ? 0.9 : 0.02));
  const BoxTree tree(boxes);
  for (int q = 0; q < 100; ++q) {
    const Vector3d from = 2.0 * random_box(200000 + q, 0.0).min();
    double fixed = 0.04;
    std::vector<int> found, expected;
    tree.visit_near(from, fixed, [&](int i) { found.push_back(i); });
    std::ranges::sort(found);
    for (int i = 0; i < static_cast<int>(boxes.size()); ++i) {
      if (boxes[i].squaredExteriorDistance(from) <= fixed) expected.push_back(i);
    }
    EXPECT_EQ(found, expected);

    double least = 100.0, nearest = 100.0;
    int visited = 0;
    tree.visit_near(from, least, [&](int i) {
      ++visited;
      least = std::min(least, boxes[i].squaredExteriorDistance(from));
    });
    for (const BoxTree::Box& box : boxes) {
      nearest = std::min(nearest, box.squaredExteriorDistance(from));
    }
    EXPECT_EQ(least, nearest);
    EXPECT_LT(visited, 500);  // a search that visits all boxes is none
  }
}

}  // namespace
}  // namespace lightwell::box_tree_test
