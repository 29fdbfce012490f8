#include "design/places/place_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

#include "tests/raytrace/lit_scene.h"

namespace lightwell::place_search_test {
namespace {

/// A room of 4 m x 3 m x 2.5 m with lamps of 100 cd to all sides at 2.2 m, above a strip of nine
/// points from x = 0.4 m to 3.6 m along the middle of the floor.
struct Strip {
  explicit Strip(const std::vector<Eigen::Vector2d>& at, float reflectance = 0.5f) {
    SceneBuilder builder;
    builder.box({.reflectance = reflectance, .one_sided = true}, {0, 0, 0}, {4, 3, 2.5}, true);
    scene = builder.build();
    for (const Eigen::Vector2d& place : at) {
      const auto number = static_cast<int>(scene.lamps.size());
      scene.lamps.push_back({.name = "lamp",
                             .position = {place.x(), place.y(), 2.2},
                             .intensity = constant_spectrum(scene.bands, 100.0f / 683.0f)});
      allowed.moved.push_back(
          {.lamp = number, .low = {0.3, 0.3, 2.2}, .high = {3.7, 2.7, 2.2}, .apart = 0.5});
    }
    for (int i = 0; i < 9; ++i) strip.points.push_back({.position = {0.4 + 0.4 * i, 1.5, 0.8}});
    std::vector<int> lamps(at.size());
    std::iota(lamps.begin(), lamps.end(), 0);
    PlacedLightOptions effort;
    effort.mesh.max_patch_size = 0.5;
    light = std::make_unique<PlacedLight>(scene, lamps, LightReceivers{.grids = {strip}},
                                          std::span<const double>(), effort);
  }

  // The problem with the light of the lamps where they are. `limits` are of the strip.
  PlaceProblem problem(const std::vector<DimmingLimit>& limits) {
    measured = {.limits = limits};
    const Eigen::Matrix3Xd places = places_of(scene, allowed);
    measured.grids = {{.name = "strip", .lux = light->at(places).lux.value}};
    PlaceProblem made{.light = *light, .allowed = allowed, .measured = measured, .places = places};
    for (int i = 0; i < static_cast<int>(scene.lamps.size()); ++i) {
      measured.luminaires.push_back({.name = "lamp", .cost = 50.0});
      made.luminaire.push_back(i);
    }
    return made;
  }

  Scene scene{};
  AllowedPlaces allowed{};
  LuxGrid strip{.name = "strip"};
  std::unique_ptr<PlacedLight> light{};
  DimmingProblem measured{};
};

class OneLamp : public testing::TestWithParam<LimitKind> {};

/// A lamp above a strip gives the most light in the mean, and the most at the darkest point, above
/// the middle, by symmetry. In a black room nothing but the last steps is left of the way.
TEST_P(OneLamp, MovesAboveTheMiddleOfAStrip) {
  Strip room({{0.9, 0.6}}, 0.0f);
  const PlaceOptimum found = descend(room.problem({{.kind = GetParam(), .value = 10.0}}));
  ASSERT_TRUE(found.plan.is_feasible);
  EXPECT_LT(found.plan.cost, found.first.cost);
  constexpr double last_steps = 0.005;
  EXPECT_NEAR(found.places(0, 0), 2.0, last_steps);
  EXPECT_NEAR(found.places(1, 0), 1.5, last_steps);
  EXPECT_EQ(found.places(2, 0), 2.2);
}

/// Random numbers of patches do not know of the symmetry and shift the optimum by reflected light;
/// the lamp finds a place at least as good as the middle.
TEST_P(OneLamp, FindsAPlaceAsGoodAsTheMiddleWithReflections) {
  Strip room({{0.9, 0.6}});
  const PlaceProblem problem = room.problem({{.kind = GetParam(), .value = 15.0}});
  const PlaceOptimum found = descend(problem);
  ASSERT_TRUE(found.plan.is_feasible);
  const double in_the_middle = cost_at(problem, Eigen::Vector3d(2.0, 1.5, 2.2)).plan.cost;
  EXPECT_LT(in_the_middle, 0.8 * found.first.cost);
  EXPECT_LE(found.plan.cost, (1.0 + 1e-4) * in_the_middle);
}

INSTANTIATE_TEST_SUITE_P(Limits, OneLamp,
                         testing::Values(LimitKind::mean_at_least, LimitKind::least_at_least));

/// Beyond what full power gives, a lamp comes as near to the limit as it can, in the same place.
TEST(PlaceSearch, OutOfReachTheLampComesNearer) {
  Strip room({{0.9, 0.6}}, 0.0f);
  const PlaceOptimum found =
      descend(room.problem({{.kind = LimitKind::mean_at_least, .value = 500.0}}));
  EXPECT_FALSE(found.plan.is_feasible);
  EXPECT_LT(found.plan.worst_miss, found.first.worst_miss);
  EXPECT_NEAR(found.places(0, 0), 2.0, 0.005);
  EXPECT_NEAR(found.places(1, 0), 1.5, 0.005);
}

/// The gradient of the least cost beside central differences, with limits of which two bind.
TEST(PlaceSearch, GradientIsThatOfCentralDifferences) {
  Strip room({{1.1, 1.2}, {2.7, 2.0}});
  const PlaceProblem problem =
      room.problem({{.kind = LimitKind::mean_at_least, .value = 20.0},
                    {.kind = LimitKind::uniformity_at_least, .value = 0.75}});
  const PlaceCost here = cost_at(problem, problem.places);
  ASSERT_TRUE(here.plan.is_feasible);
  EXPECT_GT(here.plan.price[0], 0.0);
  EXPECT_GT(here.plan.price[1], 0.0);
  constexpr double h = 0.005;
  for (int lamp = 0; lamp < 2; ++lamp) {
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Matrix3Xd forth = problem.places, back = problem.places;
      forth(axis, lamp) += h;
      back(axis, lamp) -= h;
      const double difference =
          (cost_at(problem, forth).plan.cost - cost_at(problem, back).plan.cost) / (2.0 * h);
      EXPECT_NEAR(here.gradient(axis, lamp), difference, 1e-3 * here.gradient.cwiseAbs().maxCoeff())
          << "lamp " << lamp << ", axis " << axis;
    }
  }
}

/// Two lamps that are dimmed together are one luminaire of the programme, and each has a gradient.
TEST(PlaceSearch, GradientOfAGroupIsThatOfCentralDifferences) {
  Strip room({{1.1, 1.2}, {2.7, 2.0}});
  PlaceProblem problem = room.problem({{.kind = LimitKind::least_at_least, .value = 15.0}});
  room.measured.luminaires = {{.name = "both", .cost = 100.0}};
  const Eigen::VectorXd sum = room.measured.grids[0].lux.rowwise().sum();
  room.measured.grids[0].lux = sum;
  problem.luminaire = {0, 0};
  const Eigen::Matrix3Xd gradient = cost_at(problem, problem.places).gradient;
  constexpr double h = 0.005;
  for (int lamp = 0; lamp < 2; ++lamp) {
    Eigen::Matrix3Xd forth = problem.places, back = problem.places;
    forth(0, lamp) += h;
    back(0, lamp) -= h;
    const double difference =
        (cost_at(problem, forth).plan.cost - cost_at(problem, back).plan.cost) / (2.0 * h);
    EXPECT_NEAR(gradient(0, lamp), difference, 1e-3 * gradient.cwiseAbs().maxCoeff()) << lamp;
  }
}

TEST(PlaceSearch, LampsKeepTheirDistanceAndTheirBoxes) {
  Strip room({{0.6, 0.6}, {1.2, 0.6}, {3.4, 2.4}});
  const PlaceOptimum found =
      descend(room.problem({{.kind = LimitKind::mean_at_least, .value = 1000.0}}));
  EXPECT_LT(found.plan.worst_miss, found.first.worst_miss);
  EXPECT_GT(found.steps, 0);
  EXPECT_TRUE(allows(room.allowed, found.places));
  // All want to be above the middle, so that two at least are as close as they may be.
  double closest = 10.0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < i; ++j) {
      closest = std::min(closest, (found.places.col(i) - found.places.col(j)).norm());
    }
  }
  EXPECT_NEAR(closest, 0.5, 0.01);
}

/// A lamp with an opening dazzles an eye that looks at it too much for the light that the strip
/// needs. Places are found from which it does not.
TEST(PlaceSearch, GlareIsKeptFromAnotherPlace) {
  Strip room({{2.0, 1.5}});
  room.scene.lamps[0].opening = {.along_c0 = 0.2, .along_c90 = 0.2};
  const Camera eye{.name = "seat",
                   .position = {0.5, 1.5, 1.2},
                   .direction = Eigen::Vector3d::UnitX(),
                   .up = Eigen::Vector3d::UnitZ()};
  PlacedLightOptions effort;
  effort.mesh.max_patch_size = 0.5;
  constexpr int only[] = {0};
  const PlacedLight light(room.scene, only, {.grids = {room.strip}, .eyes = {eye}}, {}, effort);
  const Eigen::Matrix3Xd places = places_of(room.scene, room.allowed);
  const PlacedReadings here = light.at(places);
  DimmingProblem measured{.luminaires = {{.name = "lamp", .cost = 50.0}},
                          .grids = {{.name = "strip", .lux = here.lux.value}},
                          .observers = {{.name = "seat",
                                         .glare = here.glare.value.row(0).transpose(),
                                         .background = here.background.value.row(0).transpose()}},
                          .limits = {{.kind = LimitKind::mean_at_least, .value = 18.0},
                                     {.kind = LimitKind::ugr_at_most, .value = 13.0}}};
  const PlaceOptimum found = descend({.light = light,
                                      .allowed = room.allowed,
                                      .measured = measured,
                                      .places = places,
                                      .luminaire = {0}});
  EXPECT_FALSE(found.first.is_feasible);
  EXPECT_GT(found.first.reached[1], 13.1);
  EXPECT_TRUE(found.plan.is_feasible);
  EXPECT_LE(found.plan.reached[1], 13.0 + 1e-3);
}

}  // namespace
}  // namespace lightwell::place_search_test
