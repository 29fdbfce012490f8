// The walkthrough page on the screens of phones and tablets, with fingers.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/viewer/channel_room.h"
#include "tests/viewer/in_browser.h"
#include "tests/viewer/lit_sides.h"
#include "tests/viewer/solved_box.h"

namespace lightwell::touch_in_browser_test {
namespace {

/// Opens every panel in every language, and lists panels that overlap or leave the screen, and
/// targets below 44 pixels.
constexpr const char* open_all = R"(<script>
driver.run(async (page, found) => {
  const {touch, tap_finger} = driver;
  touch('down', 1, 200, 200);
  touch('up', 1, 200, 200);
  Object.assign(found, {covered: [], outside: [], small: [], seen: []});
  const boxes = (selector) => [...document.querySelectorAll(selector)].flatMap((part) => {
    const box = part.getBoundingClientRect();
    return box.width > 0 && box.height > 0 ? [{name: part.id || part.className || part.type, box}] : [];
  });
  const check = (state) => {
    const panels = boxes('.panel, #stick, #ruler');
    found.seen.push(...panels.map(({name}) => name));
    panels.forEach(({name, box}, i) => {
      if (box.left < 0 || box.top < 0 || box.right > innerWidth || box.bottom > innerHeight) found.outside.push(`${state}: ${name}`);
      for (const {name: other, box: b} of panels.slice(i + 1)) {
        const apart = box.right <= b.left || b.right <= box.left || box.bottom <= b.top || b.bottom <= box.top;
        if (!apart) found.covered.push(`${state}: ${name}, ${other}`);
      }
    });
    for (const {name, box} of boxes('button, select, summary, .power, input:not([type="checkbox"])')) {
      if (box.width < 44 || box.height < 44) found.small.push(`${state}: ${name} ${box.width} x ${box.height}`);
    }
  };
  for (const code of Object.keys(texts)) {
    element('language').value = code;
    element('language').dispatchEvent(new Event('change'));
    for (const name of panel_names) toggle_panel(name, false);
    page.set_mode('walk');
    page.set_measuring(false);
    page.set_false_colors(null);
    await tap_finger(innerWidth / 2, 0.6 * innerHeight);
    check(`${code} reading`);
    page.set_false_colors('illuminance');
    page.set_isolux(true);
    for (const name of panel_names) {
      toggle_panel(name, true);
      check(`${code} ${name}`);
      toggle_panel(name, false);
    }
    page.set_measuring(true);
    page.set_mode('plan');
    check(`${code} plan`);
  }
});
</script>)";

TEST_P(InBrowser, PanelsNeverOverlapOnSmallScreens) {
  const Scene scene = channel_room();
  const BakedModel model = bake_model(solve_by_channel(scene), scene);
  const std::array<std::array<int, 2>, 3> screens = {{{390, 844}, {844, 390}, {820, 1180}}};
  for (const auto& [width, height] : screens) {
    const Json found = run(model, open_all, {.width = width, .height = height});
    ASSERT_FALSE(found.is_null());
    ASSERT_FALSE(found.contains("failed")) << found["failed"];
    EXPECT_EQ(found["errors"], Json::array());
    EXPECT_EQ(found["covered"], Json::array()) << width;
    EXPECT_EQ(found["outside"], Json::array()) << width;
    EXPECT_EQ(found["small"], Json::array()) << width;
    for (const char* panel :
         {"bar", "stick", "probe", "legend", "adjust", "lights", "help", "distance", "ruler"}) {
      EXPECT_NE(std::ranges::find(found["seen"], Json(panel)), found["seen"].end()) << panel;
    }
  }
}

constexpr const char* use_fingers = R"(<script>
driver.run(async (page, found) => {
  const {frame, touch, tap_finger} = driver, {camera, walker} = page;
  const pose = () => [...camera.position.toArray(), ...camera.quaternion.toArray()];
  found.hover = await driver.read(0.5, 0.5);
  found.tap = await tap_finger(195, 422);
  found.beside = await tap_finger(8, 422);
  await tap_finger(195, 422);
  found.on_mark = await tap_finger(196, 424);

  found.start = pose();
  touch('down', 1, 155, 422);
  touch('down', 2, 235, 422);
  found.two_down = pose();
  for (let i = 1; i <= 40; ++i) {
    touch('move', 1, 155 - i, 422);
    touch('move', 2, 235 + i, 422);
  }
  found.pinched = pose();
  touch('up', 2, 275, 422);
  found.one_lifted = pose();
  touch('move', 1, 115, 422);
  found.unmoved = pose();
  touch('move', 1, 125, 422);
  found.looked = new Library.Euler().setFromQuaternion(camera.quaternion, 'YXZ').y;
  found.radians_per_pixel = camera.fov * Math.PI / 180 / innerHeight;
  touch('up', 1, 125, 422);
  page.go_to(0);

  const stick = element('stick'), box = stick.getBoundingClientRect();
  const at = {x: box.left + box.width / 2, y: box.top + box.height / 2};
  touch('down', 1, at.x, at.y, stick);
  found.stick_is_shown = box.width > 0;
  found.thumb_at_rest = {...walker.pushed};
  touch('move', 1, at.x, at.y - 60, stick);
  for (let i = 0; i < 30; ++i) walker.advance(1 / 30);
  found.pushed = pose();
  touch('up', 1, at.x, at.y - 60, stick);
  for (let i = 0; i < 60; ++i) walker.advance(1 / 30);
  const rest = pose();
  walker.advance(1);
  found.stops = JSON.stringify(pose()) === JSON.stringify(rest);

  page.go_to(0);
  camera.position.set(1, 0.9, 0.3);
  await frame();
  found.goal = await tap_finger(195, 800);
  for (const kind of ['down', 'up']) touch(kind, 1, 195, 800);
  found.goes = walker.goal !== null;
  for (let i = 0; i < 90; ++i) walker.advance(1 / 30);
  found.arrived = pose();
  found.rests = !walker.advance(1 / 30);
});
</script>)";

/// The camera is 5 m from the wall, in a room 2 m high.
TEST_P(InBrowser, FingersReadLookAndWalk) {
  const Json found =
      run(bake_model(shaded_box(), box_scene()), use_fingers, {.width = 390, .height = 844});
  ASSERT_FALSE(found.is_null());
  ASSERT_FALSE(found.contains("failed")) << found["failed"];
  EXPECT_EQ(found["errors"], Json::array());
  ASSERT_TRUE(found["tap"].contains("illuminance")) << found;
  EXPECT_EQ(found["tap"]["illuminance"], found["hover"]["illuminance"]);
  EXPECT_EQ(found["beside"], Json::object()) << "beside the room a reading is let go";
  EXPECT_EQ(found["on_mark"], Json::object()) << "and on its mark";

  EXPECT_EQ(found["two_down"], found["start"]);
  EXPECT_EQ(found["one_lifted"], found["pinched"]);
  EXPECT_EQ(found["unmoved"], found["pinched"]);
  // Twice as far apart: half as far from the wall. Fingers move in turn, by a pixel each, so the
  // middle goes to and fro by half a pixel, 5 m * 2 tan(38 deg) / 844 / 2 = 5 mm.
  EXPECT_NEAR(found["pinched"][2].get<double>(), -3.0 + 2.5, 1e-6);
  EXPECT_NEAR(found["pinched"][0].get<double>(), 1.0, 5e-3);
  // The first direction has a yaw of half a turn, in either sign.
  const double turned = found["looked"].get<double>(), pi = std::acos(-1.0);
  EXPECT_NEAR(std::remainder(turned - pi, 2.0 * pi),
              10.0 * found["radians_per_pixel"].get<double>(), 1e-9);

  EXPECT_EQ(found["stick_is_shown"], true);
  EXPECT_EQ(found["thumb_at_rest"], (Json{{"forward", 0}, {"right", 0}}));
  // A second in 30 steps, at 0.2 of the diagonal of 2 sqrt(3) m in a second. A share r of what is
  // missing to that speed is left after each step, so that r / (1 - r) steps are lost.
  const double r = std::exp(-1.0 / 30.0 / 0.08), way = 0.4 * std::sqrt(3.0);
  EXPECT_NEAR(found["pushed"][2].get<double>(), -3.0 + way * (1.0 - r / (1.0 - r) / 30.0), 1e-3);
  EXPECT_NEAR(found["pushed"][0].get<double>(), 1.0, 1e-9);
  EXPECT_EQ(found["stops"], true);

  EXPECT_EQ(found["goal"]["surface"], "floor");
  EXPECT_EQ(found["goes"], true);
  EXPECT_EQ(found["rests"], true);
  // To 0.02 of the body's radius of 0.2 m; at its own height.
  EXPECT_NEAR(found["arrived"][0].get<double>(), number(found["goal"]["x"]), 4e-3);
  EXPECT_NEAR(found["arrived"][2].get<double>(), number(found["goal"]["z"]), 4e-3);
  EXPECT_NEAR(found["arrived"][1].get<double>(), 0.9, 1e-6);
}

}  // namespace
}  // namespace lightwell::touch_in_browser_test
