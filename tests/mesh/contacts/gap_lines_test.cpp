#include "mesh/contacts/gap_lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "mesh/build_patches.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::gap_lines_test {
namespace {

using namespace lightwell::test;
using Eigen::Vector3d;

constexpr double patch = 0.2;  // m; elements are half as long

/// A floor of 2 m x 2 m, and a plate of 0.5 m x 0.4 m at a height above its middle, turned about
/// the vertical.
Scene floor_and_plate(double height, double turn, double scale = 1.0) {
  Scene scene = empty_scene();
  add_polygon(scene, "floor", {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  const double c = std::cos(turn), s = std::sin(turn);
  std::vector<Vector3d> plate;
  for (const auto& [x, y] : {std::pair(-0.25, -0.2), {-0.25, 0.2}, {0.25, 0.2}, {0.25, -0.2}}) {
    plate.push_back({1.0 + c * x - s * y, 1.0 + s * x + c * y, height});
  }
  add_polygon(scene, "plate", plate);
  for (Surface& surface : scene.surfaces) {
    for (Vector3d& v : std::get<PolygonMesh>(surface.shape).vertices) v *= scale;
  }
  return scene;
}

/// Area of the floor's elements under the plate, m^2. Fails if a vertex of the floor belongs both
/// to an element under the plate and to another one, or if an element straddles the outline.
double area_under_plate(const PatchMesh& mesh, double turn, double scale = 1.0) {
  const double c = std::cos(turn), s = std::sin(turn);
  const auto depth = [&](const Vector3d& p) {
    const Vector3d q = p / scale - Vector3d(1, 1, 0);
    const double x = c * q.x() + s * q.y(), y = c * q.y() - s * q.x();
    return std::min(0.25 - std::abs(x), 0.2 - std::abs(y));
  };
  double area = 0.0;
  std::map<int, std::set<bool>> sides_of_vertex;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (mesh.facet[e] != 0 || mesh.is_back[mesh.patch[e]] != 0) continue;
    const bool is_under = depth(element_center(mesh, e).position) > 0.0;
    if (is_under) area += mesh.element_area[e];
    for (int i = 0; i < mesh.corner_count(e); ++i) {
      sides_of_vertex[mesh.corners[e][i]].insert(is_under);
      const double at = depth(mesh.position(mesh.corners[e][i]));
      constexpr double rounding = 1e-9;
      EXPECT_TRUE(is_under ? at > -rounding : at < rounding);
    }
  }
  for (const auto& [v, sides] : sides_of_vertex) EXPECT_EQ(sides.size(), 1u) << "vertex " << v;
  return area;
}

TEST(GapLines, FloorIsCutUnderAPlateThatHovers) {
  for (const double height : {0.0002, 0.002, 0.009}) {
    for (const double turn : {0.0, 0.7}) {
      const PatchMesh mesh =
          build_patches(floor_and_plate(height, turn), {.max_patch_size = patch});
      EXPECT_NEAR(area_under_plate(mesh, turn), 0.2, 1e-9) << height << " m, turned by " << turn;
    }
  }
}

TEST(GapLines, FollowTheScaleOfTheScene) {
  for (const double scale : {1e-3, 1e3}) {
    const PatchMesh mesh =
        build_patches(floor_and_plate(0.002, 0.7, scale), {.max_patch_size = patch * scale});
    EXPECT_NEAR(area_under_plate(mesh, 0.7, scale), 0.2 * scale * scale, 1e-9 * scale * scale);
  }
}

TEST(GapLines, AreMadeOfGapsThatAreNarrowAgainstElementsAlone) {
  // Elements of 0.1 m are cut under gaps of up to a tenth of that.
  const auto count = [&](double height) {
    return build_patches(floor_and_plate(height, 0.7), {.max_patch_size = patch}).element_count();
  };
  EXPECT_GT(count(0.009), count(0.011));
  EXPECT_EQ(count(0.011), count(0.5));
}

}  // namespace
}  // namespace lightwell::gap_lines_test
