#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "mesh/build_patches.h"
#include "mesh/elements/element_caster.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/form_factors/hemicube_view.h"
#include "scene/sampling.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::hemicube_scan_test {
namespace {

using Eigen::Vector3d;

HemicubeEye free_eye(const Vector3d& position, const Vector3d& normal, double turn) {
  Vector3d x, y;
  tangent_frame(normal, x, y);
  HemicubeEye eye{.position = position};
  eye.frame << std::cos(turn) * x + std::sin(turn) * y, std::cos(turn) * y - std::sin(turn) * x,
      normal;
  return eye;
}

std::vector<int> scanned(const PatchMesh& mesh, const HemicubeEye& eye,
                         const HemicubeCells& cells) {
  std::vector<int> items(cells.cell_count());
  HemicubeScan::Scratch scratch;
  const ElementCaster caster(mesh);
  HemicubeScan(caster).draw(eye, cells, scratch, items);
  return items;
}

std::vector<int> cast(const PatchMesh& mesh, const HemicubeEye& eye, const HemicubeCells& cells) {
  std::vector<int> items(cells.cell_count());
  cast_hemicube(ElementCaster(mesh), eye, cells, items);
  return items;
}

template <class Claim>
double share_where(const HemicubeCells& cells, const std::vector<int>& items, Claim claim) {
  double share = 0.0;
  std::size_t i = 0;
  for (int f = 0; f < HemicubeCells::face_count; ++f) {
    for (int row = 0; row < cells.rows(f); ++row) {
      for (int c = 0; c < cells.resolution(); ++c, ++i) {
        if (claim(items[i])) share += cells.delta_form_factor(f, row, c, c + 1);
      }
    }
  }
  return share;
}

bool sees_something(int item) {
  return item != hemicube_item::nothing;
}

// One element per facet, where its shape allows.
PatchMesh coarse_mesh(const Scene& scene) {
  return build_patches(scene, {.max_patch_size = 1e3, .elements_per_patch_edge = 1});
}

PatchMesh polygon_mesh(const std::vector<Vector3d>& points) {
  Scene scene;
  test::add_polygon(scene, "polygon", test::add_material(scene, test::diffuse(scene.bands, 0.5f)),
                    points);
  return coarse_mesh(scene);
}

Vector3d vector_of(const nlohmann::json& value) {
  return Vector3d(value[0], value[1], value[2]);
}

// The catalogue's differential element to polygon and sphere. 2e-3 is the error of the default
// resolution. Polygons reach below the horizon and around the hemicube's corners.
TEST(HemicubeScan, ElementToPolygonIsTheCataloguesAtAnyTurn) {
  std::ifstream file(LIGHTWELL_TEST_DATA "/analytic/viewfactors.json");
  const HemicubeCells cells(256);
  int cases = 0;
  for (const auto& entry : nlohmann::json::parse(file)) {
    const auto& geometry = entry["geometry"];
    if (geometry["type"] != "element-polygon") continue;
    ++cases;
    std::vector<Vector3d> points;
    for (const auto& p : geometry["polygon"]) points.push_back(vector_of(p));
    const PatchMesh mesh = polygon_mesh(points);
    for (double turn = 0.0; turn < 3.0; turn += 0.37) {
      const HemicubeEye eye =
          free_eye(vector_of(geometry["point"]), vector_of(geometry["normal"]), turn);
      const double exact = entry["value"];
      EXPECT_NEAR(share_where(cells, scanned(mesh, eye, cells), sees_something), exact, 2e-3)
          << entry["id"] << ", scan, turn " << turn;
      EXPECT_NEAR(share_where(cells, cast(mesh, eye, cells), sees_something), exact, 2e-3)
          << entry["id"] << ", rays, turn " << turn;
    }
  }
  EXPECT_GE(cases, 5);
}

// Rays meet the exact sphere. Its inscribed elements cover less, by a share in proportion to the
// square of their size.
TEST(HemicubeScan, SphereIsExactInRaysAndInscribedInScanConversion) {
  const HemicubeCells cells(256);
  const double exact = 0.140625;  // (0.75 / 2)^2, the sphere straight above
  constexpr std::uint64_t eyes = 16;
  std::array<double, 2> missing{};  // mean over eyes around the sphere
  for (int level = 0; level < 2; ++level) {
    Scene scene;
    const int m = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
    scene.surfaces.push_back(
        {.name = "ball", .material = m, .shape = Sphere{.center = {0, 0, 0}, .radius = 0.75}});
    const PatchMesh mesh = build_patches(
        scene, {.max_patch_size = level == 0 ? 0.3 : 0.15, .elements_per_patch_edge = 1});
    for (std::uint64_t k = 0; k < eyes; ++k) {
      const auto u = [&](std::uint64_t c) { return 2.0 * random_uniform(random_key(k, c)) - 1.0; };
      const Vector3d away = Vector3d(u(1), u(2), u(3)).normalized();
      const HemicubeEye eye = free_eye(2.0 * away, -away, 3.0 * u(4));
      EXPECT_NEAR(share_where(cells, cast(mesh, eye, cells), sees_something), exact, 1e-3);
      missing[level] +=
          (exact - share_where(cells, scanned(mesh, eye, cells), sees_something)) / eyes;
    }
  }
  // About 2e-4 of aliasing per eye, relative to a missing share of 1e-3, averages to 5 %. The
  // outline on the grid of elements adds as much again.
  EXPECT_GT(missing[1], 0.0);
  EXPECT_NEAR(missing[0] / missing[1], 4.0, 0.8);
}

// A wall from far below the horizon to far above, wider than the hemicube: a strip of each face.
// Every corner of the wall is beside, behind or below some face.
TEST(HemicubeScan, HugeWallsAreCutAtHorizonAndCorners) {
  const HemicubeCells cells(128);
  const PatchMesh mesh =
      polygon_mesh({{0.5, -1e4, -1e4}, {0.5, -1e4, 1e4}, {0.5, 1e4, 1e4}, {0.5, 1e4, -1e4}});
  for (double turn = 0.0; turn < 6.28; turn += 0.13) {
    const HemicubeEye eye = free_eye(Vector3d::Zero(), Vector3d::UnitZ(), turn);
    const double share = share_where(cells, scanned(mesh, eye, cells), sees_something);
    // Half of the hemisphere, except beyond the wall's end 1e4 away: 0.5 / 1e4. The edge crosses n
    // cells in the middle of the top, of delta 4/(pi n^2): half of each, in the worst case all on
    // one side.
    EXPECT_NEAR(share, 0.5, 0.5e-4 + 0.5 * 4.0 / (3.14 * 128)) << turn;
  }
}

// Compared cell by cell: two triangles with a common edge equal their quadrilateral.
TEST(HemicubeScan, NeighboursNeitherGapNorOverlap) {
  const HemicubeCells cells(64);
  int covered = 0;
  for (std::uint64_t trial = 0; trial < 120; ++trial) {
    const auto u = [&](std::uint64_t k) {
      return 2.0 * random_uniform(random_key(trial, k)) - 1.0;
    };
    const Vector3d center = 1.2 * Vector3d(u(0), u(1), u(2));
    const Vector3d first(u(3), u(4), u(5)), second(u(6), u(7), u(8));
    // Planar and convex: the diagonals cross in `center`.
    const std::array<Vector3d, 4> p = {center - first, center - (0.6 + 0.4 * u(9)) * second,
                                       center + (0.6 + 0.4 * u(10)) * first, center + second};
    const HemicubeEye eye =
        free_eye(Vector3d::Zero(), Vector3d(u(11), u(12), u(13)).normalized(), 3.0 * u(14));
    const auto whole = scanned(polygon_mesh({p[0], p[1], p[2], p[3]}), eye, cells);
    const auto one = scanned(polygon_mesh({p[0], p[1], p[2]}), eye, cells);
    const auto other = scanned(polygon_mesh({p[0], p[2], p[3]}), eye, cells);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      ASSERT_FALSE(sees_something(one[i]) && sees_something(other[i])) << trial << " cell " << i;
      ASSERT_EQ(sees_something(whole[i]), sees_something(one[i]) || sees_something(other[i]))
          << trial << " cell " << i;
      covered += sees_something(whole[i]);
    }
  }
  EXPECT_GT(covered, 10000);  // the polygons were visible
}

// Edges along rows and columns, through the centres of cells.
TEST(HemicubeScan, CentresOnASharedEdgeBelongToOneSide) {
  const int n = 16;
  const HemicubeCells cells(n);
  HemicubeEye eye;
  const double at = 1.0 / n;  // centres of row and column n/2 of the top
  for (const bool along_rows : {true, false}) {
    const auto point = [&](double x, double y) -> Vector3d {
      return along_rows ? Vector3d(x, y, 1.0) : Vector3d(y, x, 1.0);
    };
    const auto low = scanned(
        polygon_mesh({point(-1, -1), point(-1, at), point(1, at), point(1, -1)}), eye, cells);
    const auto high =
        scanned(polygon_mesh({point(-1, at), point(-1, 1), point(1, 1), point(1, at)}), eye, cells);
    int lows = 0, highs = 0;
    for (int i = 0; i < n * n; ++i) {
      EXPECT_NE(sees_something(low[i]), sees_something(high[i])) << i;
      lows += sees_something(low[i]);
      highs += sees_something(high[i]);
    }
    EXPECT_EQ(lows + highs, n * n);
    EXPECT_EQ(std::abs(highs - lows), 0);  // the cells on the line belong to the higher side
  }
}

TEST(HemicubeScan, ClosedRoomLeavesNoCellEmpty) {
  const PatchMesh mesh = build_patches(test::furnace(0.5f, 1.0f, true), {.max_patch_size = 0.15});
  const ElementCaster caster(mesh);
  const HemicubeScan scan(caster);
  HemicubeScan::Scratch scratch;
  for (const int n : {2, 30, 128}) {
    const HemicubeCells cells(n);
    std::vector<int> items(cells.cell_count());
    for (int patch = 0; patch < mesh.patch_count(); ++patch) {
      scan.draw(hemicube_eye(mesh, patch, true), cells, scratch, items);
      for (int item : items) ASSERT_GE(item, 0) << "patch " << patch << ", " << n << " cells";
    }
  }
}

// Cell whose pyramid holds a direction of the hemicube's frame; -1 below the horizon.
int cell_of(const HemicubeCells& cells, const Vector3d& d) {
  int best = -1;
  for (int f = 0; f < HemicubeCells::face_count; ++f) {
    const auto& face = HemicubeCells::face(f);
    const double outwards = face.outward_sign * d[face.outward_axis];
    if (!(outwards > 0.0)) continue;
    const int n = cells.resolution();
    const int c = static_cast<int>(std::floor(0.5 * n * (d[face.column_axis] / outwards + 1.0)));
    const double low = f == 0 ? -1.0 : 0.0;
    const int r = static_cast<int>(std::floor(0.5 * n * (d[face.row_axis] / outwards - low)));
    if (c >= 0 && c < n && r >= 0 && r < cells.rows(f)) best = cells.first_cell(f) + r * n + c;
  }
  return best;
}

// True if one of the eight cells around, across the hemicube's edges too, holds `item`.
bool is_beside(const HemicubeCells& cells, const std::vector<int>& items, int f, int row,
               int column, int item) {
  for (int r = row - 1; r <= row + 1; ++r) {
    for (int c = column - 1; c <= column + 1; ++c) {
      const int cell = cell_of(cells, cells.direction(f, r, c));
      if (cell >= 0 && items[cell] == item) return true;
    }
  }
  return false;
}

Scene room_with_plates() {
  Scene scene = test::furnace(0.5f, 1.0f, true);
  Material thin = test::diffuse(scene.bands, 0.3f);
  thin.one_sided = false;
  const int two_sided = test::add_material(scene, thin);
  test::add_polygon(scene, "shelf", two_sided,
                    {{0.1, 0.1, 0.7}, {0.5, 0.15, 0.72}, {0.45, 0.3, 0.75}});
  test::add_polygon(scene, "black back", 0,
                    {{0.7, 0.8, 0.4}, {0.9, 0.8, 0.45}, {0.9, 1.0, 0.5}, {0.7, 1.0, 0.45}});
  return scene;
}

TEST(HemicubeScan, AgreesWithRaysButForCellsAtEdges) {
  const PatchMesh mesh = build_patches(room_with_plates(), {.max_patch_size = 0.2});
  const ElementCaster caster(mesh);
  const HemicubeScan scan(caster);
  HemicubeScan::Scratch scratch;
  const HemicubeCells cells(128);
  const int n = cells.resolution();
  std::vector<int> painted(cells.cell_count()), traced(cells.cell_count());
  int differing = 0, eyes = 0;
  for (int patch = 0; patch < mesh.patch_count(); patch += 3, ++eyes) {
    const HemicubeEye eye = hemicube_eye(mesh, patch, false);
    scan.draw(eye, cells, scratch, painted);
    cast_hemicube(caster, eye, cells, traced);
    for (int f = 0; f < HemicubeCells::face_count; ++f) {
      for (int row = 0; row < cells.rows(f); ++row) {
        for (int c = 0; c < n; ++c) {
          const int cell = cells.first_cell(f) + row * n + c;
          if (painted[cell] == traced[cell]) continue;
          ++differing;
          EXPECT_TRUE(is_beside(cells, painted, f, row, c, traced[cell]) ||
                      is_beside(cells, traced, f, row, c, painted[cell]))
              << "patch " << patch << " cell " << cell << ": " << painted[cell] << " painted, "
              << traced[cell] << " traced";
        }
      }
    }
  }
  // Rays are in single precision, so edges are accurate to 1e-6 of the room. A cell is 1e-2 wide,
  // and less than a fifth of the cells contain an edge.
  EXPECT_LT(differing, 1 + 0.2 * 1e-4 * eyes * cells.cell_count());
}

TEST(HemicubeScan, FloorUnderABlockSeesItsBottomAlone) {
  const PatchMesh mesh = build_patches(test::furnace(0.5f, 1.0f, true), {.max_patch_size = 0.1});
  const HemicubeCells cells(32);
  int covered = 0;
  for (int patch = 0; patch < mesh.patch_count(); ++patch) {
    const HemicubeEye eye = hemicube_eye(mesh, patch, true);
    const Vector3d& p = eye.position;
    if (mesh.facet_of(patch) != 4 || p.x() < 0.3 || p.x() > 0.6 || p.y() < 0.4 || p.y() > 0.7)
      continue;
    ++covered;
    constexpr int bottom = 6 + 4;
    for (int item : scanned(mesh, eye, cells)) ASSERT_EQ(hemicube_item::facet(mesh, item), bottom);
  }
  EXPECT_GE(covered, 9);
}

TEST(HemicubeScan, NearerSurfaceHidesTheFartherWhateverTheirOrder) {
  const HemicubeCells cells(64);
  for (const bool near_first : {true, false}) {
    Scene scene;
    const int m = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
    const auto plate = [&](double z, double half) {
      test::add_polygon(scene, "plate" + std::to_string(z), m,
                        {{-half, -half, z}, {-half, half, z}, {half, half, z}, {half, -half, z}});
    };
    if (near_first) plate(1.0, 0.5);
    plate(2.0, 2.0);
    if (!near_first) plate(1.0, 0.5);
    const PatchMesh mesh = coarse_mesh(scene);
    const auto items = scanned(mesh, free_eye(Vector3d::Zero(), Vector3d::UnitZ(), 0.4), cells);
    const int near_facet = near_first ? 0 : 1;
    const double seen = share_where(
        cells, items, [&](int item) { return hemicube_item::facet(mesh, item) == near_facet; });
    const Loop loop = {{-0.5, -0.5, 1}, {-0.5, 0.5, 1}, {0.5, 0.5, 1}, {0.5, -0.5, 1}};
    const double exact =
        std::abs(point_to_polygon(Vector3d::Zero(), Vector3d::UnitZ(), {&loop, 1}));
    EXPECT_NEAR(seen, exact, 4e-3);  // 128 cells of the outline, 3e-4 each, at random
  }
}

TEST(HemicubeScan, EyeOfAnLShapedPatchLiesOnIt) {
  const PatchMesh mesh =
      polygon_mesh({{0, 0, 0}, {3, 0, 0}, {3, 0.2, 0}, {0.2, 0.2, 0}, {0.2, 3, 0}, {0, 3, 0}});
  for (int patch = 0; patch < mesh.patch_count(); ++patch) {
    const Vector3d p = hemicube_eye(mesh, patch, true).position;
    EXPECT_TRUE(p.x() > 0 && p.y() > 0 && std::min(p.x(), p.y()) < 0.2 && p.z() == 0) << p;
  }
}

}  // namespace
}  // namespace lightwell::hemicube_scan_test
