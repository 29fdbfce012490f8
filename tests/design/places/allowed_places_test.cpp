#include "design/places/allowed_places.h"

#include <gtest/gtest.h>

namespace lightwell::allowed_places_test {
namespace {

/// Lamps under one ceiling, 4 m x 3 m at 2.5 m.
AllowedPlaces under_a_ceiling(int lamps, double apart) {
  AllowedPlaces allowed;
  for (int i = 0; i < lamps; ++i) {
    allowed.moved.push_back({.lamp = i, .low = {0, 0, 2.5}, .high = {4, 3, 2.5}, .apart = apart});
  }
  return allowed;
}

TEST(AllowedPlaces, OutsideTheBoxTheNearestPlaceIsOnItsFace) {
  Eigen::Matrix3Xd places(3, 1);
  places << 5.0, 1.0, 2.0;
  const auto nearest = nearest_allowed(under_a_ceiling(1, 0.0), places);
  ASSERT_TRUE(nearest);
  EXPECT_EQ(nearest->col(0), Eigen::Vector3d(4.0, 1.0, 2.5));
}

/// Two lamps 0.2 m apart along x that have to be 1 m apart: each goes half of 0.8 m.
TEST(AllowedPlaces, LampsThatAreTooCloseShareTheWay) {
  const AllowedPlaces allowed = under_a_ceiling(2, 1.0);
  Eigen::Matrix3Xd places(3, 2);
  places << 1.9, 2.1, 1.0, 1.0, 2.5, 2.5;
  EXPECT_FALSE(allows(allowed, places));
  const auto nearest = nearest_allowed(allowed, places);
  ASSERT_TRUE(nearest);
  EXPECT_TRUE(allows(allowed, *nearest));
  EXPECT_NEAR((*nearest)(0, 0), 1.5, 2.0 * place_tolerance);
  EXPECT_NEAR((*nearest)(0, 1), 2.5, 2.0 * place_tolerance);
}

TEST(AllowedPlaces, LampsInOnePlaceArePartedToo) {
  const AllowedPlaces allowed = under_a_ceiling(2, 1.0);
  Eigen::Matrix3Xd places(3, 2);
  places << 2.0, 2.0, 1.0, 1.0, 2.5, 2.5;
  const auto nearest = nearest_allowed(allowed, places);
  ASSERT_TRUE(nearest);
  EXPECT_TRUE(allows(allowed, *nearest));
}

TEST(AllowedPlaces, ALampKeepsItsDistanceFromOneThatStays) {
  AllowedPlaces allowed = under_a_ceiling(1, 0.5);
  allowed.fixed = {{1.0, 1.0, 2.5}};
  Eigen::Matrix3Xd places(3, 1);
  places << 1.1, 1.0, 2.5;
  const auto nearest = nearest_allowed(allowed, places);
  ASSERT_TRUE(nearest);
  EXPECT_NEAR((*nearest)(0, 0), 1.5, 2.0 * place_tolerance);
  EXPECT_DOUBLE_EQ((*nearest)(1, 0), 1.0);
}

/// Ten lamps 2 m apart from each other do not fit under 4 m x 3 m: discs of 1 m around them, of
/// pi m^2 each and none over another, would lie in 6 m x 5 m, which is 30 m^2 to 31.4 m^2.
TEST(AllowedPlaces, TooManyLampsHaveNoPlace) {
  EXPECT_FALSE(nearest_allowed(under_a_ceiling(10, 2.0), Eigen::Matrix3Xd::Random(3, 10)));
}

}  // namespace
}  // namespace lightwell::allowed_places_test
