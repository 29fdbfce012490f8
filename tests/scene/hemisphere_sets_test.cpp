#include "scene/hemisphere_sets.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

namespace lightwell::hemisphere_sets_test {
namespace {

constexpr int count = 1024;

TEST(HemisphereSets, DrawsHaveTheMomentsOfLambertsLaw) {
  const HemisphereSets sets(count, true);
  const Eigen::Vector3d normal = Eigen::Vector3d(1.0, -2.0, 0.5).normalized();
  for (std::uint64_t key = 0; key < 50; ++key) {
    const auto draw = sets.draw(key);
    const Eigen::Matrix3d frame = draw.frame(normal);
    ASSERT_NEAR((frame.transpose() * frame - Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-14);
    ASSERT_NEAR(frame.determinant(), 1.0, 1e-14);
    Eigen::Vector3d mean_direction = Eigen::Vector3d::Zero();
    Eigen::Vector2d mean_point = Eigen::Vector2d::Zero();
    for (const HemispherePoint& point : draw.all()) {
      const Eigen::Vector3d d = frame * Eigen::Vector3d(point.x, point.y, point.z);
      const Eigen::Vector2d planar = draw.planar_point(0, point);
      ASSERT_NEAR(d.norm(), 1.0, 1e-6);
      ASSERT_TRUE((planar.array() >= 0.0).all() && (planar.array() < 1.0).all());
      mean_direction += d / count;
      mean_point += planar / count;
    }
    // The mean of cos(theta) is 2/3; with stratified points the error is far below 1/sqrt(1024).
    EXPECT_NEAR((mean_direction - 2.0 / 3.0 * normal).norm(), 0.0, 2e-3);
    EXPECT_NEAR((mean_point - Eigen::Vector2d(0.5, 0.5)).norm(), 0.0, 2e-3);
  }
}

TEST(HemisphereSets, KeysGiveDifferentDrawsAndOneKeyTheSame) {
  const HemisphereSets sets(16, true);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  EXPECT_EQ(sets.draw(7).all().data(), sets.draw(7).all().data());
  EXPECT_EQ(sets.draw(7).frame(up), sets.draw(7).frame(up));
  EXPECT_NE(sets.draw(7).frame(up), sets.draw(8).frame(up));
  const HemispherePoint& point = sets.draw(7).all()[0];
  EXPECT_NE(sets.draw(7).planar_point(0, point), sets.draw(8).planar_point(0, point));
}

TEST(HemisphereSets, OnePointIsASet) {
  const HemisphereSets sets(1);
  EXPECT_EQ(sets.draw(3).all().size(), 1u);
}

// The first points of a block are the first of the sequence, which are spread evenly, not the first
// in the order of directions.
TEST(HemisphereSets, AnyNumberOfFirstPointsIsSpreadEvenly) {
  const HemisphereSets sets(4 * HemisphereSets::block);
  const auto draw = sets.draw(5);
  std::vector<HemispherePoint> some;
  for (const int first : {0, HemisphereSets::block}) {
    for (const int size : {16, 64, 100, 1000, HemisphereSets::block}) {
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      const auto points = draw.points(first, size, some);
      ASSERT_EQ(points.size(), static_cast<std::size_t>(size));
      std::vector<char> is_there(static_cast<std::size_t>(size), 0);
      for (const HemispherePoint& p : points) {
        mean += Eigen::Vector3d(p.x, p.y, p.z) / size;
        ++is_there[static_cast<std::size_t>(p.rank)];
      }
      EXPECT_EQ(std::count(is_there.begin(), is_there.end(), 1), size);
      // The mean of random points would have an error of about 0.8 / sqrt(size).
      EXPECT_NEAR((mean - Eigen::Vector3d(0.0, 0.0, 2.0 / 3.0)).norm(), 0.0, 1.0 / size + 2e-3)
          << first << ' ' << size;
    }
  }
}

TEST(HemisphereSets, NeighboursPointNearlyAlike) {
  const HemisphereSets sets(HemisphereSets::block);
  const auto points = sets.draw(5).all();
  double sum = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    sum += Eigen::Vector3f(points[i].x - points[i - 1].x, points[i].y - points[i - 1].y,
                           points[i].z - points[i - 1].z)
               .norm();
  }
  // 1024 cells over the hemisphere are 0.08 wide; the Morton curve has some jumps.
  EXPECT_LT(sum / static_cast<double>(points.size()), 0.16);
}

}  // namespace
}  // namespace lightwell::hemisphere_sets_test
