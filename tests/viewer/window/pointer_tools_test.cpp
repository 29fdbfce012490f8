#include "viewer/window/pointer_tools.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "raytrace/readings/probe.h"
#include "scene/facet_textures.h"
#include "tests/viewer/channel_room.h"
#include "tests/viewer/pictured_wall.h"
#include "tests/viewer/shared_floor.h"
#include "tests/viewer/solved_box.h"
#include "viewer/window/x_display.h"

namespace lightwell::pointer_tools_test {
namespace {

/// A patch has the mean reflectance of its texture; a reading has that of the texel, whose codes
/// are exact to 1e-3.
TEST(PointReading, OfAPictureIsTheTexels) {
  PicturedBox box;
  box.solved.mesh.textures = std::make_shared<const FacetTextures>(box.scene);
  const ElementCaster caster(box.solved.mesh);
  const auto kinds = element_kinds(box.solved, box.scene.materials);
  const BandArray E = box.solved.solution.irradiance();
  for (const auto& [x, rho] : {std::pair(80, bright_half), std::pair(120, dark_half)}) {
    const VisibleHit seen = visible_hit_at_pixel(caster, kinds, box_camera(), x, 75);
    ASSERT_TRUE(static_cast<bool>(seen));
    const PointReading reading = read_point(box.solved.mesh, rgb_bands(), E, &box.scene, seen);
    EXPECT_NEAR(reading.reflectance[1], rho, 1e-3f * rho);
    EXPECT_NEAR(reading.luminance, rho * reading.lux / std::numbers::pi, 1e-3 * reading.luminance);
  }
}

/// A reading is the irradiance of `lightwell probe --interpolate` at the same point and normal.
/// Both interpolate in one element, at hits of different rays: float weights differ by some 1e-6 of
/// the variation of light across an element, which is at most about the light itself.
TEST(PointReading, IsWhatProbeInterpolates) {
  const Scene scene = channel_room();
  const SolvedScene solved = solve_by_channel(scene);
  const ElementCaster caster(solved.mesh);
  const auto kinds = element_kinds(solved, scene.materials);
  const BandArray E = solved.solution.irradiance();
  int compared = 0;
  for (int y = 15; y < 200; y += 24) {
    for (int x = 7; x < 200; x += 24) {
      const VisibleHit seen = visible_hit_at_pixel(caster, kinds, scene.cameras[0], x, y);
      if (!seen) continue;
      const PointReading reading = read_point(solved.mesh, solved.solution.bands, E, &scene, seen);
      const Probe probe{.position = reading.position, .normal = reading.normal};
      const BandArray wanted = interpolate_irradiance(caster, solved.solution, {&probe, 1});
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(reading.irradiance[k], wanted(0, k), 1e-4f * wanted(0, k) + 1e-5f)
            << "pixel " << x << ", " << y;
      }
      EXPECT_EQ(reading.lux, luminous(solved.solution.bands, reading.irradiance));
      EXPECT_EQ(reading.surface, scene.surfaces[solved.mesh.surface[reading.patch]].name);
      ++compared;
    }
  }
  EXPECT_GT(compared, 50);
}

TEST(PointReading, KnowsWhoseAPlaceOnASharedPolygonIs) {
  const SharedFloor floor;
  const ElementCaster caster(floor.solved.mesh);
  const auto kinds = element_kinds(floor.solved, floor.scene.materials);
  for (const double x : {0.2, 0.9, 1.1, 1.9}) {
    const Ray ray{.origin = {x, 0.4, 0.5}, .direction = -Eigen::Vector3d::UnitZ()};
    const VisibleHit seen = visible_hits(caster, kinds, {&ray, 1})[0];
    const PointReading reading =
        read_point(floor.solved.mesh, floor.solved.solution.bands,
                   floor.solved.solution.irradiance(), &floor.scene, seen, floor.names.get());
    EXPECT_EQ(reading.surface, x < 1.0 ? "left" : "right");
    EXPECT_EQ(reading.material, reading.surface + " paint");
  }
}

/// L = (M + rho E) / pi of the wall in the middle: white light of 2 W/m2 in all bands, rho = 1.
TEST(PointReading, LuminanceIsRadiosityOverPi) {
  const SolvedScene box = solved_box();
  const ElementCaster caster(box.mesh);
  const VisibleHit seen =
      visible_hit_at_pixel(caster, element_kinds(box, {}), box_camera(), 100, 75);
  const PointReading reading =
      read_point(box.mesh, box.solution.bands, box.solution.irradiance(), nullptr, seen);
  EXPECT_NEAR(reading.lux, 2.0 * 683.0, 0.1);
  EXPECT_NEAR(reading.luminance, 2.0 * 683.0 / std::numbers::pi, 0.1);
  EXPECT_NEAR((reading.position - Eigen::Vector3d(1, 1, 2)).norm(), 0.0, 1e-5);
  EXPECT_NEAR((reading.normal - Eigen::Vector3d(0, 0, -1)).norm(), 0.0, 1e-12);
  EXPECT_EQ(reading.surface, "surface 2");
  const std::string text =
      full_text(reading, box.solution.bands, {.metres_per_unit = 0.001, .unit_name = "mm"});
  EXPECT_NE(text.find("illuminance  1366 lx"), std::string::npos) << text;
  EXPECT_NE(text.find("at 1000, 1000, 2000 mm"), std::string::npos) << text;
  EXPECT_NE(text.find("patch 2, element 2"), std::string::npos) << text;
  const ShownUnits relative{.relative = true};
  EXPECT_EQ(full_text(reading, box.solution.bands, relative).find(" lx"), std::string::npos);
}

TEST(PointReading, NamesTheBoundOfIlluminanceIfItIsKnown) {
  PointReading reading;
  reading.lux = 523.4;
  EXPECT_EQ(short_text(reading, {}).find("within"), std::string::npos);
  reading.lux_within = 12.1;
  EXPECT_EQ(short_text(reading, {}).rfind("523.4 lx within 12 ", 0), 0u) << short_text(reading, {});
}

/// The back of the red wall, which faces the camera on the left, is neither drawn nor read.
TEST(PointReading, LooksThroughBacks) {
  const SolvedScene box = solved_box();
  Camera camera = box_camera();
  camera.position = {-3, 1, 1};
  camera.direction = {1, 0, 0};
  const ElementCaster caster(box.mesh);
  const VisibleHit seen = visible_hit_at_pixel(caster, element_kinds(box, {}), camera, 100, 75);
  EXPECT_EQ(seen.hit.element, 0);
  EXPECT_NEAR(seen.distance, 5.0, 1e-5) << "through the wall at 3 m";
  EXPECT_FALSE(visible_hit_at_pixel(caster, element_kinds(box, {}), box_camera(), 1, 75));
}

class PointerToolsTest : public testing::Test {
 protected:
  static ViewOptions options() {
    ViewOptions options;
    options.cameras = {box_camera()};
    return options;
  }
  DisplayConnection display_{};
  SolvedScene box_ = solved_box();
  SolutionView view_{box_, options()};
  PointerTools tools_{nullptr};
};

/// The clicks are at (1, 0, 2) on the floor and (1, 2, 2) on the ceiling, 2 m apart. At 5 m, 1 m is
/// 100 / (5 tan 20 deg) = 54.95 pixels.
TEST_F(PointerToolsTest, MeasuresBetweenTwoClicks) {
  tools_.switch_measuring();
  const double high = 100.0 / (5.0 * std::tan(20.0 * std::numbers::pi / 180.0));
  tools_.click(view_, 100, 75 + 0.9 * high);
  EXPECT_FALSE(tools_.distance());
  tools_.click(view_, 100, 75 - 0.9 * high);
  ASSERT_TRUE(tools_.distance());
  EXPECT_NEAR(*tools_.distance(), 1.8, 1e-5);
  EXPECT_NE(tools_.panel(view_).find("distance 1.8 m"), std::string::npos);
  EXPECT_EQ(tools_.marks().size(), 2u);
  tools_.click(view_, 100, 75);
  EXPECT_FALSE(tools_.distance()) << "a third click begins anew";
  tools_.switch_measuring();
  EXPECT_TRUE(tools_.marks().empty());
}

TEST_F(PointerToolsTest, TheProbeGoesWithThePointerOnlyWhenItIsOn) {
  tools_.hover(view_, 100, 75);
  EXPECT_EQ(tools_.beside_pointer(view_), "");
  tools_.switch_probe();
  tools_.hover(view_, 100, 75);
  EXPECT_NE(tools_.beside_pointer(view_).find("1366 lx"), std::string::npos);
  tools_.hover(view_, 2, 75);
  EXPECT_EQ(tools_.beside_pointer(view_), "") << "beside the box there is nothing";
}

TEST_F(PointerToolsTest, OtherLightIsReadAtOnceAtTheSamePoint) {
  tools_.click(view_, 100, 75);
  EXPECT_NEAR(tools_.reading()->lux, 1366.0, 0.1);
  box_.solution.direct_irradiance *= 0.5f;
  view_.light_changed();
  tools_.light_changed(view_, true);
  EXPECT_NEAR(tools_.reading()->lux, 683.0, 0.1);
  tools_.clear();
  EXPECT_FALSE(tools_.reading());
}

}  // namespace
}  // namespace lightwell::pointer_tools_test
