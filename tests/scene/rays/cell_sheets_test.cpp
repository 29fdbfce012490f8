#include "scene/rays/cell_sheets.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>

#include "scene/rays/ray_caster.h"
#include "scene/sampling.h"

namespace lightwell::cell_sheets_test {
namespace {

using Eigen::Vector3d;

double uniform(std::uint64_t a, std::uint64_t b) {
  return random_uniform(random_key(a, b));
}

// Cells between lines of a parallelogram; all are of group 0.
CastGeometry grid(const std::vector<double>& u, const std::vector<double>& v) {
  CastGeometry g;
  const Vector3d origin(3.0, -1.0, 0.2), along(2.0, 0.3, 0.1), up(0.4, 0.1, 1.5);
  for (const double t : v) {
    for (const double s : u) g.vertices.push_back(origin + s * along + t * up);
  }
  const auto n = static_cast<int>(u.size());
  for (int j = 0; j + 1 < static_cast<int>(v.size()); ++j) {
    for (int i = 0; i + 1 < n; ++i) {
      g.quads.push_back({j * n + i, j * n + i + 1, (j + 1) * n + i + 1, (j + 1) * n + i});
    }
  }
  g.group.assign(g.quads.size(), 0);
  return g;
}

std::vector<double> even(int cells) {
  std::vector<double> lines;
  for (int i = 0; i <= cells; ++i) lines.push_back(static_cast<double>(i) / cells);
  return lines;
}

constexpr double any_length = 1e3;

CellSheets join_all(const CastGeometry& g, double margin = 0.0) {
  return join_cells(g, any_length, margin, [](int) { return true; });
}

Vector3d corner(const CastGeometry& g, int quad, int c) {
  return g.vertices[static_cast<std::size_t>(g.quads[static_cast<std::size_t>(quad)][c])];
}

Vector3d at(const std::array<Vector3d, 4>& corners, double u, double v) {
  return corners[0] + u * (corners[1] - corners[0]) + v * (corners[3] - corners[0]);
}

// Expects that each quadrilateral is in exactly one sheet, or single.
void expect_all_once(const CastGeometry& g, const CellSheets& sheets) {
  std::vector<int> found = sheets.cells;
  found.insert(found.end(), sheets.single.begin(), sheets.single.end());
  std::ranges::sort(found);
  std::vector<int> all(g.quads.size());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(found, all);
}

// Checks places() at points of the inner part `inner` of each sheet, around its middle.
void expect_cells(const CastGeometry& g, const CellSheets& sheets, double inner = 1.0) {
  for (std::size_t s = 0; s < sheets.sheets.size(); ++s) {
    const CellSheet& sheet = sheets.sheets[s];
    for (int i = 0; i < 1000; ++i) {
      const double u = 0.5 + inner * (uniform(s, 2 * i) - 0.5),
                   v = 0.5 + inner * (uniform(s, 2 * i + 1) - 0.5);
      const auto cell = sheets.cell_point(sheet, static_cast<float>(u), static_cast<float>(v));
      ASSERT_GE(std::min(cell.u, cell.v), 0.0f);
      ASSERT_LE(std::max(cell.u, cell.v), 1.0f);
      const Vector3d in_cell = at({corner(g, cell.quad, 0), corner(g, cell.quad, 1),
                                   corner(g, cell.quad, 2), corner(g, cell.quad, 3)},
                                  cell.u, cell.v);
      // Floats have u and v of 2 m to 2e-7; a product and a difference for up to 20 cells add a
      // rounding each.
      ASSERT_LT((in_cell - at(sheet.corners, u, v)).norm(), 1e-5);
    }
  }
}

TEST(CellSheets, EvenCellsAreOneAndToldApart) {
  const CastGeometry g = grid(even(5), even(3));
  const CellSheets sheets = join_all(g);
  ASSERT_EQ(sheets.sheets.size(), 1u);
  EXPECT_EQ(sheets.sheets[0].columns, 5);
  EXPECT_EQ(sheets.sheets[0].rows, 3);
  EXPECT_TRUE(sheets.single.empty());
  expect_all_once(g, sheets);
  expect_cells(g, sheets);
}

TEST(CellSheets, WhatMayNotJoinIsLeftOut) {
  const CastGeometry g = grid(even(8), even(8));
  const std::set<int> covered{18, 19, 26, 27, 63, 9};
  const CellSheets sheets =
      join_cells(g, any_length, 0.0, [&](int q) { return !covered.contains(q); });
  expect_all_once(g, sheets);
  expect_cells(g, sheets);
  for (const int q : covered) {
    EXPECT_NE(std::ranges::find(sheets.single, q), sheets.single.end());
  }
  EXPECT_LT(sheets.sheets.size(), 16u);
}

TEST(CellSheets, NoneIsLongerThanAllowed) {
  const CastGeometry g = grid(even(20), even(10));
  constexpr double longest = 0.55;
  const CellSheets sheets = join_cells(g, longest, 0.0, [](int) { return true; });
  expect_all_once(g, sheets);
  expect_cells(g, sheets);
  EXPECT_EQ(sheets.sheets.size(), 4u * 4u);
  for (const CellSheet& sheet : sheets.sheets) {
    EXPECT_LE((sheet.corners[1] - sheet.corners[0]).norm(), longest);
    EXPECT_LE((sheet.corners[3] - sheet.corners[0]).norm(), longest);
  }
}

TEST(CellSheets, UnequalCellsAndOtherGroupsStayApart) {
  const CastGeometry g = grid({0.0, 0.2, 0.4, 0.6, 0.8 + 1e-5, 1.0}, even(2));
  const CellSheets sheets = join_all(g);
  expect_all_once(g, sheets);
  ASSERT_EQ(sheets.sheets.size(), 3u);
  EXPECT_EQ(sheets.sheets[0].columns, 3);
  EXPECT_EQ(sheets.sheets[1].columns, 1);
  EXPECT_EQ(sheets.sheets[2].columns, 1);

  CastGeometry two = grid(even(4), even(1));
  two.group = {0, 0, 1, 1};
  EXPECT_EQ(join_all(two).sheets.size(), 2u);

  CastGeometry trapezoids = grid(even(5), even(1));
  trapezoids.vertices[8].z() += 0.1;  // a vertex of the second and the third cell
  expect_all_once(trapezoids, join_all(trapezoids));
  EXPECT_EQ(join_all(trapezoids).sheets.size(), 1u);
}

TEST(CellSheets, CellsOfNoWidthAreSingle) {
  const CastGeometry g = grid({0.0, 0.0, 0.0, 0.5, 1.0}, even(2));
  const CellSheets sheets = join_all(g, 1e-6);
  expect_all_once(g, sheets);
  EXPECT_EQ(sheets.sheets.size(), 1u);
  EXPECT_EQ(sheets.single.size(), 4u);
  expect_cells(g, sheets, 0.99);
}

TEST(CellSheets, AMarginMovesNoPlace) {
  const CastGeometry g = grid(even(7), even(4));
  const CellSheets bare = join_all(g), wide = join_all(g, 0.01);
  const CellSheet &a = bare.sheets.at(0), &b = wide.sheets.at(0);
  // A way along both edges. Coordinates up to 8 have a rounding error, and are subtracted twice.
  const Vector3d way = (corner(g, 0, 1) - corner(g, 0, 0)).normalized() +
                       (corner(g, 0, 3) - corner(g, 0, 0)).normalized();
  const double roundings = 4.0 * 8.0 * std::numeric_limits<double>::epsilon();
  EXPECT_LT((a.corners[0] - 0.01 * way - b.corners[0]).norm(), roundings);
  expect_cells(g, wide, 0.98);
  const auto edge = wide.cell_point(b, 0.0f, 1.0f);  // beyond the cells
  EXPECT_EQ(edge.quad, bare.cell_point(a, 0.0f, 1.0f).quad);
  EXPECT_EQ(edge.u, 0.0f);
  EXPECT_EQ(edge.v, 1.0f);
}

// Rays hit the same cells at the same points as without sheets: cells of different groups are not
// joined.
TEST(CellSheets, RaysMeetTheCellsThatTheyMetApart) {
  CastGeometry together = grid(even(9), even(6));
  CastGeometry apart = together;
  std::iota(apart.group.begin(), apart.group.end(), 0);
  const RayCaster joined(together), single(apart);
  const Vector3d normal = (corner(together, 0, 1) - corner(together, 0, 0))
                              .cross(corner(together, 0, 3) - corner(together, 0, 0))
                              .normalized();
  // Bound of EmbreeScene on float rounding of a point: four roundings of half the diagonal. (Both
  // casters have the same centre, and round rays alike.)
  Eigen::AlignedBox3d box;
  for (const Vector3d& v : together.vertices) box.extend(v);
  const double rounding =
      4.0 * 0.5 * box.diagonal().norm() * double{std::numeric_limits<float>::epsilon()};
  const Vector3d along = corner(together, 0, 1) - corner(together, 0, 0),
                 up = corner(together, 0, 3) - corner(together, 0, 0);
  const double width = along.cross(up).norm() / std::max(along.norm(), up.norm());
  constexpr int count = 100'000;
  int met = 0, elsewhere = 0;
  for (int i = 0; i < count; ++i) {
    const double z = 2.0 * uniform(i, 1) - 1.0, phi = 2.0 * std::numbers::pi * uniform(i, 2);
    const double r = std::sqrt(1.0 - z * z);
    const Ray ray{.origin = {3.0 + 2.0 * uniform(i, 3), -2.0 + 2.5 * uniform(i, 4), 1.0},
                  .direction = {r * std::cos(phi), r * std::sin(phi), z}};
    Hit a, b;
    joined.closest_hits({&ray, 1}, {&a, 1});
    single.closest_hits({&ray, 1}, {&b, 1});
    ASSERT_EQ(a.primitive < 0, b.primitive < 0);
    if (a.primitive < 0) continue;
    ++met;
    const double facing = std::abs(ray.direction.dot(normal));
    // Error along the plane, and error across the plane projected at the angle of incidence.
    const double in_plane = rounding * (1.0 + 1.0 / facing);
    EXPECT_NEAR(a.t * facing, b.t * facing, rounding);
    EXPECT_EQ(a.from_back, b.from_back);
    if (a.primitive != b.primitive) {
      ++elsewhere;  // within rounding of an edge
      continue;
    }
    EXPECT_NEAR(a.u, b.u, in_plane / width);
    EXPECT_NEAR(a.v, b.v, in_plane / width);
  }
  EXPECT_GT(met, count / 10);
  // Lines are a quarter of a metre apart, and some 1e-6 m wide for rays that do not graze.
  EXPECT_LE(elsewhere, met / 10'000);
}

}  // namespace
}  // namespace lightwell::cell_sheets_test
