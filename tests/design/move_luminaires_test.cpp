#include "design/move_luminaires.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "scene/errors.h"
#include "tests/design/coarse_solve.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::move_luminaires_test {
namespace {

constexpr double watts_each = 20.0;

/// A room of 6 m x 4 m x 2.7 m with a desk in a corner, a luminous panel, and two lamps far from
/// the desk.
Scene room() {
  const Paint wall{.reflectance = 0.5f, .one_sided = true};
  SceneBuilder builder;
  builder.box(wall, {0, 0, 0}, {6, 4, 2.7}, true);
  builder.square(wall, {1.5, 1.2, 0.75}, Eigen::Vector3d::UnitZ(), 0.6);
  builder.square({.exitance = 1.0f, .one_sided = true}, {3, 2, 2.69}, -Eigen::Vector3d::UnitZ(),
                 0.2);
  Scene scene = builder.build();
  for (const double x : {4.0, 5.0}) {
    scene.lamps.push_back({.name = "spot",
                           .position = {x, 3.0, 2.5},
                           .intensity = constant_spectrum(scene.bands, 250.0f / 683.0f)});
  }
  scene.lamps.push_back({.name = "bulb",
                         .position = {5.5, 0.5, 2.5},
                         .intensity = constant_spectrum(scene.bands, 50.0f / 683.0f)});
  return scene;
}

const WordedMove spots{.names = {"spot"},
                       .axes = {0, 1},
                       .lowest = {0.5, 0.5},
                       .highest = {5.5, 3.5},
                       .apart = 0.4,
                       .origin = "limits.toml:7:1: move 1"};

DesignTask task_of(const Scene& scene, double lux) {
  DesignTask task{.request = {.limits = {.maintenance_factor = 0.8}, .rays = 256}};
  task.request.limits.limits = {{.kind = LimitKind::mean_at_least, .place = "desk", .value = lux}};
  task.request.limits.moves = {spots};
  for (const char* const name : {"surface 2", "spot", "bulb"}) {
    task.request.watts.push_back({.name = name, .value = watts_each});
  }
  task.design.grids = {{.name = "desk", .surface = 1, .spacing = 0.3}};
  task.grids = {0};
  task.limits = {{.kind = LimitKind::mean_at_least, .value = lux}};
  task.places = allowed_places(scene, task.request.limits.moves);
  return task;
}

SolvedScene solve(const Scene& scene) {
  return test::coarse_solve(scene, 1.0);
}

// Direct light of a spot on the desk or in its plane, 1.75 m below, lx.
double direct_lux(double sideways) {
  constexpr double candelas = 250.0, height = 1.75;
  return candelas * height / std::pow(height * height + sideways * sideways, 1.5);
}

/// Lamps 3 m away from a desk move to it: by the inverse square law they then take a fraction of
/// the power. The answer is measured in the light of the scene as it is afterwards.
TEST(MoveLuminaires, LampsMoveToTheDesk) {
  const Scene scene = room();
  const DesignTask task = task_of(scene, 60.0);
  const MovedDesign made = move_luminaires(task, {scene}, &solve, {});
  const LightingPlan& plan = made.plan;
  ASSERT_TRUE(plan.earlier);
  EXPECT_TRUE(plan.is_feasible);
  EXPECT_TRUE(plan.meets_all());
  // The nearest spot is 3.08 m from the middle of the desk before, and 0.85 m from its corners
  // after. Reflected light is about that of an even room of 102 m2 that reflects half,
  // 4 pi 250 cd * 0.5 / (102 * 0.5) = 31 lx, and no more than twice that.
  constexpr double reflected = 2.0 * 31.0;
  const double share = (direct_lux(3.08) + reflected) / (direct_lux(0.85) + reflected);
  EXPECT_LT(plan.cost, share * plan.earlier->cost);
  EXPECT_GE(plan.earlier->solves, 2);
  EXPECT_TRUE(allows(task.places, places_of(made.scene, task.places)));
  // The lamp that gives the light is above the desk; what has no table stays.
  double nearest = 10.0;
  for (std::size_t i = 0; i < plan.luminaires.size(); ++i) {
    const Luminaire& luminaire = plan.luminaires[i];
    if (luminaire.shared_name != "spot") {
      EXPECT_EQ(luminaire.position, plan.earlier->positions[i]) << luminaire.name;
      continue;
    }
    EXPECT_EQ(luminaire.position.z(), 2.5);
    nearest = std::min(nearest, (luminaire.position - Eigen::Vector3d(1.5, 1.2, 2.5)).norm());
    for (int axis = 0; axis < 2; ++axis) {
      const double micrometres = 1e6 * luminaire.position[axis];
      // Rounded when written, when read, and by the factor here.
      constexpr double roundings = 3.0;
      EXPECT_NEAR(micrometres, std::round(micrometres), roundings * 0x1p-53 * micrometres);
    }
  }
  // Two lamps above the desk are half of `apart` off its middle each, and within 0.1 m more direct
  // light changes by 1.5 (0.1 / 1.75)^2 = 0.5 %, less than the light's noise.
  EXPECT_LT(nearest, 0.5 * spots.apart + 0.1);
  EXPECT_EQ(made.scene.lamps[2].position, scene.lamps[2].position);
  EXPECT_EQ(scene_hash(made.scene), made.solved.solution.provenance.scene_hash);
}

/// Out of reach, places are found that are nearer to the limit.
TEST(MoveLuminaires, OutOfReachLampsComeNearer) {
  const Scene scene = room();
  const DesignTask task = task_of(scene, 5000.0);
  SolvedScene before = solve(scene);
  const LightingPlan unmoved = design_lighting(task, {scene}, before, {});
  const MovedDesign made = move_luminaires(task, {scene}, &solve, {});
  EXPECT_FALSE(made.plan.is_feasible);
  EXPECT_FALSE(made.plan.earlier->meets_all);
  EXPECT_GT(made.plan.limits[0].reached, 1.5 * unmoved.limits[0].reached);
}

void expect_refused(const WordedMove& move, const std::string& sentence,
                    const std::vector<WordedMove>& besides = {}) {
  std::vector<WordedMove> moves = besides;
  moves.push_back(move);
  try {
    allowed_places(room(), moves);
    ADD_FAILURE() << "accepted: " << sentence;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(sentence), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("limits.toml:"), std::string::npos) << error.what();
  }
}

TEST(AllowedPlacesOfAScene, WrongTablesAreRefusedWithASentence) {
  WordedMove move = spots;
  move.names = {"spott"};
  expect_refused(move, "Did you mean 'spot'?");
  move.names = {"surface 2"};
  expect_refused(move, "which is a surface, and only lamps are moved");
  move = spots;
  move.lowest = {4.5, 0.5};
  expect_refused(move, "lets 'spot 1' move from x = 4.5 to 5.5, and the scene has it at 4");
  move = spots;
  move.apart = 1.5;
  expect_refused(move, "closer to each other than 'apart' allows");
  move = spots;
  move.names = {"spot 2"};
  move.origin = "limits.toml:9:1: move 2";
  expect_refused(move, "would move 'spot 2', as limits.toml:7:1: move 1 does", {spots});
}

/// A table may name a lamp twice, and axes that are not named keep the lamp where it is.
TEST(AllowedPlacesOfAScene, BoxesAreInTheUnitOfTheFile) {
  Scene scene = room();
  scene.metres_per_unit = 0.001;
  WordedMove move = spots;
  move.names = {"spot", "spot 1"};
  move.axes = {1};
  move.lowest = {2000.0};
  move.highest = {3500.0};
  move.apart = 500.0;
  const AllowedPlaces allowed = allowed_places(scene, std::span(&move, 1));
  ASSERT_EQ(allowed.moved.size(), 2u);
  EXPECT_TRUE(allowed.moved[0].low.isApprox(Eigen::Vector3d(4.0, 2.0, 2.5)));
  EXPECT_TRUE(allowed.moved[1].high.isApprox(Eigen::Vector3d(5.0, 3.5, 2.5)));
  EXPECT_DOUBLE_EQ(allowed.moved[0].apart, 0.5);
  EXPECT_EQ(allowed.fixed.size(), 1u);
}

}  // namespace
}  // namespace lightwell::move_luminaires_test
