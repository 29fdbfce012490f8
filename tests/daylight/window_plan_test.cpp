#include "daylight/window_plan.h"

#include <gtest/gtest.h>

#include "scene/errors.h"
#include "tests/daylight/daylight_rooms.h"

namespace lightwell::window_plan_test {
namespace {

// All combinations of two states of each group, an hour for each.
Eigen::ArrayXXi all_combinations(int groups) {
  Eigen::ArrayXXi states(groups, 1 << groups);
  for (int h = 0; h < states.cols(); ++h) {
    for (int g = 0; g < groups; ++g) states(g, h) = h >> g & 1;
  }
  return states;
}

OperatedWindows windows_of(int groups) {
  const Scene room = test::room_with_panes(groups);
  return test::windows_of_panes(room, test::diffuse(room.bands, 0.0f));
}

}  // namespace

TEST(WindowPlan, FewCombinationsAreComputedEach) {
  const Eigen::ArrayXXi states = all_combinations(2);
  const WindowPlan plan = plan_computations(windows_of(2), states);
  EXPECT_FALSE(plan.is_superposed);
  ASSERT_EQ(plan.computations.size(), 4u);
  EXPECT_EQ(plan.computations[0], (WindowStates{0, 0}));
  for (Eigen::Index h = 0; h < states.cols(); ++h) {
    const WindowStates in_hour = states_of_hour(states, h);
    for (std::size_t c = 0; c < plan.computations.size(); ++c) {
      EXPECT_EQ(plan.weight(c, in_hour), plan.computations[c] == in_hour ? 1.0 : 0.0);
    }
  }
}

// 2^5 combinations, where 1 + 5 computations and one of all groups changed are enough. The last
// hour, in which all are, has that computation for itself.
TEST(WindowPlan, ManyCombinationsAreSuperposed) {
  const Eigen::ArrayXXi states = all_combinations(5);
  const WindowPlan plan = plan_computations(windows_of(5), states);
  EXPECT_TRUE(plan.is_superposed);
  ASSERT_EQ(plan.computations.size(), 7u);
  EXPECT_EQ(plan.computations.back(), (WindowStates{1, 1, 1, 1, 1}));
  EXPECT_EQ(plan.weight(6, plan.computations.back()), 1.0);
  EXPECT_EQ(plan.weight(0, plan.computations.back()), 0.0);
  EXPECT_EQ(plan.superposed_weight(0, plan.computations.back()), -4.0);
  for (Eigen::Index h = 0; h + 1 < states.cols(); ++h) {
    const WindowStates in_hour = states_of_hour(states, h);
    double sum = 0.0, changes = 0.0;
    for (std::size_t c = 0; c < plan.computations.size(); ++c) {
      sum += plan.weight(c, in_hour);
      if (c > 0) changes += plan.weight(c, in_hour);
    }
    EXPECT_EQ(sum, 1.0);
    EXPECT_EQ(changes, static_cast<double>(states.col(h).sum()));
  }
}

// Only what some hour has is computed.
TEST(WindowPlan, StatesThatNoHourHasAreLeftOut) {
  Eigen::ArrayXXi states = Eigen::ArrayXXi::Zero(5, 10);
  states(2, 4) = 1;
  EXPECT_EQ(plan_computations(windows_of(5), states).computations,
            (std::vector<WindowStates>{{0, 0, 0, 0, 0}, {0, 0, 1, 0, 0}}));
  EXPECT_EQ(plan_computations({}, Eigen::ArrayXXi(0, 10)).computations.size(), 1u);
}

TEST(WindowPlan, TooManyComputationsAreRefused) {
  const int groups = most_computations;
  Eigen::ArrayXXi states(groups, groups * 2);
  for (Eigen::Index h = 0; h < states.cols(); ++h) {
    for (Eigen::Index g = 0; g < groups; ++g) states(g, h) = (h + g) % groups < groups / 2;
  }
  // An hour is one combination, and half of these are equal; they are more than the groups with the
  // open state and the check.
  for (int h = 0; h < groups; ++h) states(h, groups + h) = 1 - states(h, groups + h);
  EXPECT_THROW(plan_computations(windows_of(groups), states), InputError);
}

TEST(WindowPlan, SceneInStatesHasTheirMaterials) {
  const Scene room = test::room_with_panes(2);
  const Material closed = test::diffuse(room.bands, 0.25f);
  const OperatedWindows windows = test::windows_of_panes(room, closed);
  const Scene changed = scene_in_states(room, windows, {0, 1});
  for (std::size_t s = 0; s < room.surfaces.size(); ++s) {
    const Material& material =
        changed.materials[static_cast<std::size_t>(changed.surfaces[s].material)];
    if (room.surfaces[s].name == "pane 1") {
      EXPECT_EQ(material.name, closed.name);
    } else {
      EXPECT_EQ(changed.surfaces[s].material, room.surfaces[s].material);
    }
  }
  EXPECT_EQ(states_text(windows, {0, 1}), "pane 0: open, pane 1: closed");
}

}  // namespace lightwell::window_plan_test
