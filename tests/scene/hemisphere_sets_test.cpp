#include "scene/hemisphere_sets.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace lightwell {
namespace {

constexpr int count = 1024;

TEST(HemisphereSets, DrawsHaveTheMomentsOfLambertsLaw) {
  const HemisphereSets sets(count);
  const Eigen::Vector3d normal = Eigen::Vector3d(1.0, -2.0, 0.5).normalized();
  for (std::uint64_t key = 0; key < 50; ++key) {
    const auto draw = sets.draw(key);
    const Eigen::Matrix3d frame = draw.frame(normal);
    ASSERT_NEAR((frame.transpose() * frame - Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-14);
    ASSERT_NEAR(frame.determinant(), 1.0, 1e-14);
    Eigen::Vector3d mean_direction = Eigen::Vector3d::Zero();
    Eigen::Vector2d mean_place = Eigen::Vector2d::Zero();
    for (const HemispherePoint& point : draw.points(0, count)) {
      const Eigen::Vector3d d = frame * Eigen::Vector3d(point.x, point.y, point.z);
      const Eigen::Vector2d place = draw.place(point);
      ASSERT_NEAR(d.norm(), 1.0, 1e-6);
      ASSERT_TRUE((place.array() >= 0.0).all() && (place.array() < 1.0).all());
      mean_direction += d / count;
      mean_place += place / count;
    }
    // The mean of cos(theta) is 2/3; stratified, so far closer than 1/sqrt(1024).
    EXPECT_NEAR((mean_direction - 2.0 / 3.0 * normal).norm(), 0.0, 2e-3);
    EXPECT_NEAR((mean_place - Eigen::Vector2d(0.5, 0.5)).norm(), 0.0, 2e-3);
  }
}

TEST(HemisphereSets, KeysGiveDifferentDrawsAndOneKeyTheSame) {
  const HemisphereSets sets(16);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  EXPECT_EQ(sets.draw(7).points(0, 16).data(), sets.draw(7).points(0, 16).data());
  EXPECT_EQ(sets.draw(7).frame(up), sets.draw(7).frame(up));
  EXPECT_NE(sets.draw(7).frame(up), sets.draw(8).frame(up));
  const HemispherePoint& point = sets.draw(7).points(0, 1)[0];
  EXPECT_NE(sets.draw(7).place(point), sets.draw(8).place(point));
}

TEST(HemisphereSets, OnePointIsASet) {
  const HemisphereSets sets(1);
  EXPECT_EQ(sets.draw(3).points(0, 1).size(), 1u);
}

}  // namespace
}  // namespace lightwell
