#include "scene/io/polygon.h"
#include "scene/io/mesh_builder.h"
#include "scene/io/polygon_repair.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <numbers>
#include <numeric>
#include <random>

#include "scene/io/loop_tree.h"

namespace lightwell::polygon_test {
namespace {

double area(const PolygonMesh& mesh) {
  double sum = 0.0;
  for (const Facet& facet : mesh.facets) sum += facet_area(mesh, facet);
  return sum;
}

Loop square(double low, double high, double z = 0.0) {
  return {{low, low, z}, {high, low, z}, {high, high, z}, {low, high, z}};
}

// A polygon turned and moved out of every symmetry, and scaled down.
Polygon moved(Polygon polygon) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const auto move = [&](Loop& loop) {
    for (auto& p : loop) p = 1e-3 * (turn * p) + Eigen::Vector3d(5, 6, 7);
  };
  move(polygon.boundary);
  for (Loop& hole : polygon.holes) move(hole);
  return polygon;
}

TEST(PolygonFault, FindsNoneInSoundPolygons) {
  Loop circle;
  for (int i = 0; i < 300; ++i) {
    const double phi = 2.0 * std::numbers::pi * i / 300;
    circle.emplace_back(std::cos(phi), std::sin(phi), 0.0);
  }
  const std::vector<Polygon> sound = {
      {square(0, 1)},
      {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
      {{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {0, 4, 0}}},  // concave
      {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}},  // a vertex on a straight edge
      {{{0, 0, 0}, {10, 0, 0}, {10, 1e-4, 0}, {0, 1e-4, 0}}},     // 1e5 : 1
      {circle},
      {square(0, 9), {square(1, 2), square(3, 4)}},
  };
  for (const Polygon& polygon : sound) {
    EXPECT_EQ(fault(polygon), "");
    EXPECT_EQ(fault(moved(polygon)), "");
    EXPECT_LE(deviation_from_plane(moved(polygon)), flatness);
  }
}

TEST(PolygonFault, DoesNotDependOnPlaceAndOrientation) {
  const std::vector<Polygon> faulty = {
      {{{0, 0, 0}, {1, 0, 0}}},
      {{{0, 0, 0}, {1, 1, 0}, {2, 0, 0}, {0, 1, 0}}},
      {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}},
      {{{0, 0, 0}, {3, 0, 0}, {1, 0, 0}, {1, 1, 0}}},
      {{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 0, 0}, {0, 4, 0}}},  // a vertex touches an edge
      {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}},
      {square(0, 9), {square(8, 10)}},
      {square(0, 9), {square(10, 11)}},
      {square(0, 9), {square(1, 4), square(2, 3)}},
      {square(0, 9), {square(2, 3), square(1, 4)}},
  };
  for (const Polygon& polygon : faulty) {
    EXPECT_NE(fault(polygon), "");
    EXPECT_EQ(fault(polygon), fault(moved(polygon)));
  }
}

TEST(DeviationFromPlane, IsTheShareOfTheSize) {
  Loop loop = square(0, 1);
  loop[2].z() = 0.04;  // the plane through the mean is 0.01 from each vertex
  EXPECT_NEAR(deviation_from_plane({loop}), 0.01 / std::sqrt(2.0), 1e-5);
  EXPECT_NEAR(deviation_from_plane(moved({loop})), 0.01 / std::sqrt(2.0), 1e-5);
}

TEST(SplitIntoTriangles, CutsAQuadrilateralFromTheFirstVertex) {
  Loop loop = square(0, 1);
  loop[2].z() = 0.1;
  const auto triangles = split_into_triangles(loop);
  ASSERT_EQ(triangles.size(), 2u);
  EXPECT_EQ(triangles[0], (std::array{0, 1, 2}));
  EXPECT_EQ(triangles[1], (std::array{0, 2, 3}));
}

TEST(SplitIntoTriangles, StaysInsideAConcaveQuadrilateral) {
  // The diagonal v0-v2 would run outside, past the notch at v1.
  const Loop arrow = {{0, 0, 0}, {1, 1, 0.01}, {4, 0, 0}, {1, 4, 0}};
  const auto triangles = split_into_triangles(arrow);
  ASSERT_EQ(triangles.size(), 2u);
  for (const auto& t : triangles) {
    EXPECT_GT((arrow[t[1]] - arrow[t[0]]).cross(arrow[t[2]] - arrow[t[0]]).z(), 0.0);
  }
}

TEST(SplitIntoTriangles, CoversThePolygonOnce) {
  // A comb with six teeth: area by the shoelace formula.
  Loop comb = {{0, 0, 0}, {12, 0, 0}};
  for (int tooth = 5; tooth >= 0; --tooth) {
    comb.emplace_back(2 * tooth + 1.5, 5, 0);
    comb.emplace_back(2 * tooth + 0.2, 1, 0);
  }
  const auto triangles = split_into_triangles(comb);
  ASSERT_EQ(triangles.size(), comb.size() - 2);
  double sum = 0.0, shoelace = 0.0;
  for (const auto& t : triangles) {
    const double twice = (comb[t[1]] - comb[t[0]]).cross(comb[t[2]] - comb[t[0]]).z();
    EXPECT_GT(twice, 0.0);
    sum += twice;
  }
  for (std::size_t i = 0; i < comb.size(); ++i) {
    shoelace += comb[i].cross(comb[(i + 1) % comb.size()]).z();
  }
  EXPECT_NEAR(sum, shoelace, 1e-12 * shoelace);
}

// Ear clipping as it stands in the papers, cubic in the number of corners.
std::vector<std::array<int, 3>> plain_ear_clipping(const Loop& loop) {
  const auto turn = [&](int a, int b, int c) {
    return (loop[b] - loop[a]).cross(loop[c] - loop[a]).z();
  };
  std::vector<int> left(loop.size());
  std::iota(left.begin(), left.end(), 0);
  std::vector<std::array<int, 3>> triangles;
  while (left.size() >= 3) {
    const std::size_t n = left.size();
    std::size_t i = 1;
    for (std::size_t tried = 0; tried < n; ++tried, i = (i + 1) % n) {
      const int a = left[(i + n - 1) % n], b = left[i], c = left[(i + 1) % n];
      const auto is_in_the_way = [&](int p) {
        return p != a && p != b && p != c && turn(a, b, p) > 0.0 && turn(b, c, p) > 0.0 &&
               turn(c, a, p) > 0.0;
      };
      if (turn(a, b, c) > 0.0 && std::ranges::none_of(left, is_in_the_way)) break;
    }
    triangles.push_back({left[(i + n - 1) % n], left[i], left[(i + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return triangles;
}

// A star whose points are of random lengths: no three corners lie on a line.
Loop random_star(int corners, std::mt19937& random) {
  std::uniform_real_distribution<double> radius(0.2, 1.0);
  Loop loop;
  for (int i = 0; i < corners; ++i) {
    const double phi = 2.0 * std::numbers::pi * i / corners, r = radius(random);
    loop.emplace_back(r * std::cos(phi), r * std::sin(phi), 0.0);
  }
  return loop;
}

TEST(SplitIntoTriangles, CutsTheEarsThatPlainEarClippingCuts) {
  std::mt19937 random(7);
  for (int corners = 3; corners < 200; corners += 7) {
    const Loop loop = random_star(corners, random);
    EXPECT_EQ(split_into_triangles(loop), plain_ear_clipping(loop)) << corners << " corners";
  }
}

TEST(PolygonFault, IsTheFirstOfAllPairs) {
  std::mt19937 random(8);
  for (int corners = 10; corners < 300; corners += 13) {
    Loop loop = random_star(corners, random);
    const auto at = static_cast<std::size_t>(random() % (corners - 5));
    std::swap(loop[at + 1], loop[at + 3]);  // the edges after `at` and before at + 4 cross others
    const auto crosses = [&](std::size_t i, std::size_t j) {
      const auto side = [&](std::size_t e, std::size_t p) {
        const Eigen::Vector3d& a = loop[e];
        return (loop[(e + 1) % loop.size()] - a).cross(loop[p % loop.size()] - a).z();
      };
      return side(i, j) * side(i, j + 1) < 0.0 && side(j, i) * side(j, i + 1) < 0.0;
    };
    std::string first;
    for (std::size_t i = 0; i < loop.size() && first.empty(); ++i) {
      for (std::size_t j = i + 2; j < loop.size() && first.empty(); ++j) {
        if (!crosses(i, j) || (i == 0 && j + 1 == loop.size())) continue;
        first = "has edges " + std::to_string(i + 1) + " and " + std::to_string(j + 1) +
                " that cross or touch";
      }
    }
    EXPECT_EQ(fault({loop}), first) << corners << " corners";
  }
}

// All pairs of corners, 5e9, are more than most_pair_tests: a polygon that took them would be left
// out.
TEST(AddRepaired, NeedsFewTestsOfPairsForVeryManyCorners) {
  static_assert(most_pair_tests < 1'000'000'000);
  constexpr int corners = 100'000;
  Loop loop, bent;
  for (int i = 0; i < corners; ++i) {
    const double phi = 2.0 * std::numbers::pi * i / corners;
    loop.emplace_back(std::cos(phi), std::sin(phi), 0.0);
    bent.emplace_back(std::cos(phi), std::sin(phi), 0.01 * std::cos(2.0 * phi));
  }
  Repairs repairs;
  MeshBuilder mesh;
  add_repaired(mesh, loop, repairs);
  EXPECT_EQ(mesh.mesh().facets.size(), 1u);
  add_repaired(mesh, bent, repairs);
  EXPECT_EQ(repairs.split, 1);
}

TEST(SplitIntoTriangles, GivesUpOnACrossing) {
  EXPECT_TRUE(split_into_triangles({{0, 0, 0}, {1, 1, 0}, {2, 0, 0}, {0, 1, 0}}).empty());
  Loop pentagram;
  for (int i = 0; i < 5; ++i) {
    pentagram.emplace_back(std::cos(0.8 * std::numbers::pi * i),
                           std::sin(0.8 * std::numbers::pi * i), 0);
  }
  EXPECT_TRUE(split_into_triangles(pentagram).empty());
}

TEST(MeshBuilder, JoinsEqualVerticesAndTurnsHoles) {
  MeshBuilder builder;
  builder.add({square(0, 9), {square(1, 2), {{3, 3, 0}, {3, 4, 0}, {4, 4, 0}, {4, 3, 0}}}});
  builder.add({{{9, 0, 0}, {18, 0, 0}, {18, 9, -0.0}, {9, 9, -0.0}}});
  const PolygonMesh& mesh = builder.mesh();
  EXPECT_EQ(mesh.vertices.size(), 4u + 4u + 4u + 2u);
  EXPECT_DOUBLE_EQ(facet_area(mesh, mesh.facets[0]), 81.0 - 1.0 - 1.0);
}

TEST(AddRepaired, KeepsWhatIsSoundAndCountsTheRest) {
  MeshBuilder builder;
  Repairs repairs;
  Loop bent = square(0, 1);
  bent[1].z() = 0.2;
  add_repaired(builder, square(0, 1), repairs);
  add_repaired(builder, bent, repairs);
  add_repaired(builder, {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}}, repairs);
  add_repaired(builder, {{0, 0, 0}, {1, 0, 0}}, repairs);
  add_repaired(builder, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, repairs);
  add_repaired(builder, {{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}}, repairs);
  // The square, two triangles of the bent one, and the two wings of the bow tie.
  EXPECT_EQ(builder.mesh().facets.size(), 5u);
  EXPECT_NEAR(area(builder.mesh()), 1.0 + 0.5 * (std::sqrt(1.0 + 2.0 * 0.2 * 0.2) + 1.0) + 2.0,
              1e-12);
  EXPECT_EQ(repairs.split, 1);
  EXPECT_EQ(repairs.thin, 3);
  EXPECT_EQ(repairs.crossing, 1);
  EXPECT_EQ(repairs.notes().size(), 3u);
}

TEST(AddRepaired, OpensAHoleThatIsJoinedByABridge) {
  // The loop runs from (0,0) to the hole's corner, clockwise round the hole, and back along the
  // same edge.
  MeshBuilder builder;
  Repairs repairs;
  add_repaired(builder,
               {{0, 0, 0},
                {9, 0, 0},
                {9, 9, 0},
                {0, 9, 0},
                {0, 0, 0},
                {3, 3, 0},
                {3, 6, 0},
                {6, 6, 0},
                {6, 3, 0},
                {3, 3, 0}},
               repairs);
  EXPECT_EQ(repairs.split, 1);
  EXPECT_NEAR(area(builder.mesh()), 81.0 - 9.0, 1e-12 * 81.0);
}

}  // namespace
}  // namespace lightwell::polygon_test
