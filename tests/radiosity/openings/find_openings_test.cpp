// Openings are found by geometry alone, at any width and in any place.
#include "radiosity/openings/find_openings.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/radiosity/openings/test_rooms.h"

namespace lightwell::find_openings_test {
namespace {

using Eigen::Quaterniond, Eigen::Vector3d;

const Quaterniond askew(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()));

bool covers(const Opening& opening, const Vector3d& at) {
  const Vector3d to = at - opening.center;
  return std::abs(to.dot(opening.normal)) < 1e-3 * opening.along.norm() &&
         std::abs(to.dot(opening.along)) <= opening.along.squaredNorm() &&
         std::abs(to.dot(opening.across)) <= opening.across.squaredNorm();
}

// Every place of the slit is covered by an opening that is at most a quarter wider.
TEST(FindOpenings, CoversASlitOfAnyWidth) {
  for (const double width : {1e-4, 1e-3, 0.01, 0.1}) {
    for (const Quaterniond& turn : {Quaterniond::Identity(), askew}) {
      const test::RoomsWithSlit rooms(width, turn);
      const std::vector<Opening> openings = find_openings(rooms.scene);
      for (double z = 0.05; z < 2.0; z += 0.1) {
        for (const double share : {0.01, 0.5, 0.99}) {
          const Vector3d at = rooms.at(4.0, 2.9 - share * width, z);
          const bool is_covered =
              std::any_of(openings.begin(), openings.end(), [&](const Opening& opening) {
                return covers(opening, at) && 2.0 * opening.across.norm() < 1.25 * width;
              });
          EXPECT_TRUE(is_covered) << "width " << width << ", height " << z << ", share " << share;
        }
      }
    }
  }
}

// A door that stands open by an angle leaves a wedge above it and a strip beside it.
TEST(FindOpenings, CoversTheStripBesideADoorAjar) {
  for (const double degrees : {0.1, 1.0, 10.0}) {
    test::RoomsWithSlit rooms(0.0);
    const double angle = degrees * M_PI / 180.0;
    const Vector3d hinge(4, 2, 0),
        latch = hinge + 0.9 * Vector3d(std::sin(angle), std::cos(angle), 0);
    auto& leaf = std::get<PolygonMesh>(rooms.scene.surfaces.back().shape);
    const Vector3d up(0, 0, 2);
    leaf.vertices = {hinge, latch, latch + up, hinge + up};
    const std::vector<Opening> openings = find_openings(rooms.scene);
    const Vector3d middle = 0.5 * (latch + Vector3d(4, 2.9, 0)) + Vector3d(0, 0, 1.3);
    EXPECT_TRUE(std::any_of(openings.begin(), openings.end(), [&](const Opening& opening) {
      const Vector3d to = middle - opening.center;
      return std::abs(to.dot(opening.normal)) < 0.3 * opening.across.norm() &&
             std::abs(to.dot(opening.along)) <= opening.along.squaredNorm() &&
             std::abs(to.dot(opening.across)) <= opening.across.squaredNorm();
    })) << degrees;
  }
}

TEST(FindOpenings, HasNoneInAnEmptyRoomOrWhereAllTouches) {
  Scene scene;
  const int wall = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  test::add_box(scene, {0, 0, 0}, {4, 5, 2.7}, {wall, wall, wall, wall, wall, wall}, true);
  EXPECT_TRUE(find_openings(scene).empty());
  const test::RoomsWithSlit closed(0.0);
  EXPECT_TRUE(find_openings(closed.scene).empty());
}

// The rooms' box is 9.8 m long: 20 um are 2e-6 of it, which vertices are rounded by.
TEST(FindOpenings, HasNoneWhereVerticesAreRounded) {
  const test::RoomsWithSlit rooms(2e-5);
  EXPECT_TRUE(find_openings(rooms.scene).empty());
}

}  // namespace
}  // namespace lightwell::find_openings_test
