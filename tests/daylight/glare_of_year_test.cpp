#include "daylight/glare_of_year.h"

#include <gtest/gtest.h>

#include "tests/daylight/daylight_rooms.h"

namespace lightwell::glare_of_year_test {
namespace {

using Eigen::Vector3d;

DaylightModel direct_model(const Scene& scene) {
  DaylightOptions options{.sky_subdivision = 1, .direct_only = true};
  options.mesh.auto_patch_count = 100;
  return {scene, Vector3d::UnitZ(), Vector3d::UnitY(), options};
}

}  // namespace

// Hours have the contrast of their state of the window: a veil of one half leaves a quarter. The
// sun is behind the eye, and lux at the eye are those of the block.
TEST(GlareCount, HoursHaveTheContrastOfTheirStates) {
  Scene room = test::room_with_panes(1);
  const DaylightModel open = direct_model(room);
  for (Material& material : room.materials) {
    if (material.dielectric) material = test::veil(room.bands, 0.5f);
  }
  const DaylightModel veiled = direct_model(room);
  const Camera eye{.name = "eye",
                   .position = {2.0, 1.5, 1.2},
                   .direction = -Vector3d::UnitY(),
                   .up = Vector3d::UnitZ()};
  const SkyHour even{.number = 12, .sun = Vector3d::UnitY(), .dome_lux = 30000.0};
  const std::vector<SkyHour> hours = {even, even};
  GlareCount count({&eye, 1}, 0, hours, 0.2);
  count.add_computation(open);
  count.add_computation(veiled);
  HourBlock block{.hours = hours,
                  .total = Eigen::ArrayXXf::Constant(1, 2, 2000.0f),
                  .sunlight = Eigen::ArrayXXf::Zero(1, 2)};
  count.add_light(block);
  const WindowPlan plan{.computations = {{0}, {1}}};
  const GlareOfYear glare = count.finish(plan, Eigen::ArrayXXi{{0, 1}}, Occupancy{}, 3650).front();
  const double contrast = sky_contrast(open, glare_view(open, eye), {&even, 1}, 0.2)[0];
  EXPECT_GT(contrast, 0.0);
  // Probabilities are floats: 6e-8 of at most 1.
  EXPECT_NEAR(double{glare.dgp[0]}, daylight_glare_probability(2000.0, contrast), 1e-7);
  EXPECT_NEAR(double{glare.dgp[1]}, daylight_glare_probability(2000.0, 0.25 * contrast), 1e-7);
  EXPECT_LT(glare.dgp[1], glare.dgp[0]);
}

}  // namespace lightwell::glare_of_year_test
