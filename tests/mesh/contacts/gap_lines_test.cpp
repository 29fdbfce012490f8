#include "mesh/contacts/gap_lines.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "mesh/build_patches.h"
#include "mesh/elements/element_caster.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::gap_lines_test {
namespace {

using namespace lightwell::test;
using Eigen::Vector3d;

constexpr double patch = 0.2;  // m; elements are half as long

/// Half-axes of a plate.
struct Half {
  double x = 0.25, y = 0.2;
};

/// A floor of 2 m x 2 m, and a plate at a height above its middle, turned about the vertical.
Scene floor_and_plate(double height, double turn, double scale = 1.0, Half half = {}) {
  Scene scene = empty_scene();
  add_polygon(scene, "floor", {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  const double c = std::cos(turn), s = std::sin(turn);
  std::vector<Vector3d> plate;
  for (const auto& [x, y] :
       {std::pair(-half.x, -half.y), {-half.x, half.y}, {half.x, half.y}, {half.x, -half.y}}) {
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
double area_under_plate(const PatchMesh& mesh, double turn, double scale = 1.0, Half half = {}) {
  const double c = std::cos(turn), s = std::sin(turn);
  const auto depth = [&](const Vector3d& p) {
    const Vector3d q = p / scale - Vector3d(1, 1, 0);
    const double x = c * q.x() + s * q.y(), y = c * q.y() - s * q.x();
    return std::min(half.x - std::abs(x), half.y - std::abs(y));
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

// The lower edge of a door, 40 mm thick, is narrower than a fifth of an element of 0.25 m. A patch
// must not reach from one side of the door to the other.
TEST(GapLines, FloorIsCutUnderADoor) {
  constexpr Half door{.x = 0.45, .y = 0.02};
  for (const double height : {0.0005, 0.002, 0.009}) {
    const PatchMesh mesh =
        build_patches(floor_and_plate(height, 0.7, 1.0, door), {.max_patch_size = 0.5});
    EXPECT_NEAR(area_under_plate(mesh, 0.7, 1.0, door), 4.0 * door.x * door.y, 1e-9) << height;
  }
  // Below a strip shorter than an element, such as the foot of a chair, and below one less than
  // three times as wide as the gap, the floor is not cut.
  const auto count = [&](double height, const Half& half) {
    return build_patches(floor_and_plate(height, 0.7, 1.0, half), {.max_patch_size = 0.5})
        .element_count();
  };
  for (const auto& half : {Half{.x = 0.1, .y = 0.02}, Half{.x = 0.45, .y = 0.004}}) {
    EXPECT_EQ(count(0.009, half), count(0.5, half)) << half.x;
  }
}

// Rays take planes up to 2.7e-6 m apart as one here, 16 roundings of a float in a diagonal of 2.8
// m; points are welded up to 2.8e-7 m. What lies between must hide the floor below itself, and no
// more of the floor: an element that straddled the outline would be black beside the plate.
TEST(GapLines, FloorIsHiddenUnderWhatNearlyTouchesIt) {
  constexpr Half plate{}, foot{.x = 0.05, .y = 0.04};  // narrower than a fifth of an element
  for (const Half& half : {plate, foot}) {
    for (const double height : {0.0, 1e-7, 2e-7, 4e-7, 1e-6, 2e-6}) {
      for (const bool faces_floor : {true, false}) {
        Scene scene = floor_and_plate(height, 0.7, 1.0, half);
        auto& loop = std::get<PolygonMesh>(scene.surfaces[1].shape);
        if (!faces_floor) std::ranges::reverse(loop.vertices);
        const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
        const ElementCaster caster(mesh);
        double hidden = 0.0;
        for (int e = 0; e < mesh.element_count(); ++e) {
          if (mesh.facet[e] != 0 || mesh.is_back[mesh.patch[e]] != 0) continue;
          if (caster.is_hidden(e, false)) hidden += mesh.element_area[e];
        }
        // Welding moves corners by 2.8e-7 m at most, and each side of the outline with them: the
        // area changes by no more than that times the perimeter.
        const double perimeter = 4.0 * (half.x + half.y);
        EXPECT_NEAR(hidden, 4.0 * half.x * half.y, 2.8e-7 * perimeter)
            << height << " m, half width " << half.x << (faces_floor ? "" : ", faces up");
      }
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

// A plate that is tilted and runs through the floor: under its upper part a gap closes in a wedge,
// whose lines end where contact lines do. Two ends a little apart would leave an element as narrow
// as that.
TEST(GapLines, EndInTheCornersOfContactLines) {
  for (const double tilt : {0.1, 0.3, 0.6}) {
    Scene scene = floor_and_plate(0.003, 0.7);
    Vector3d axis(std::cos(0.4), std::sin(0.4), 0.0);
    for (Vector3d& v : std::get<PolygonMesh>(scene.surfaces[1].shape).vertices) {
      v = Vector3d(1, 1, 0) + Eigen::AngleAxisd(tilt, axis) * (v - Vector3d(1, 1, 0));
    }
    const PatchMesh mesh = build_patches(scene, {.max_patch_size = patch});
    double least = 1.0;
    for (int e = 0; e < mesh.element_count(); ++e) {
      if (mesh.facet[e] != 0) continue;
      double boundary = 0.0;
      for (int i = 0, n = mesh.corner_count(e); i < n; ++i) {
        boundary +=
            (mesh.position(mesh.corners[e][i]) - mesh.position(mesh.corners[e][(i + 1) % n]))
                .norm();
      }
      least = std::min(least, mesh.element_area[e] / (boundary * boundary));
    }
    // A square has 1/16. With ends 6e-7 m apart, twice the tolerance of 1e-7 of the diagonal, an
    // element of 0.1 m has less than 6e-7 * 0.1 / 2 / 0.2^2 = 8e-7.
    EXPECT_GT(least, 1e-4) << tilt;
  }
}

}  // namespace
}  // namespace lightwell::gap_lines_test
