// The walkthrough page in Chromium and in Firefox. A test is skipped if its browser is missing
// (Debian: apt install chromium firefox-esr).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesh/build_patches.h"
#include "mesh/elements/element_caster.h"
#include "raytrace/readings/probe.h"
#include "tests/viewer/in_browser.h"
#include "tests/viewer/lit_sides.h"
#include "tests/viewer/pictured_wall.h"
#include "viewer/export/appearance.h"

namespace lightwell::walkthrough_test {
namespace {

/// Script that presses keys, moves the mouse, and leaves the state of the page as JSON.
constexpr const char* drive = R"(<script>
driver.run(async (page, found) => {
  const {wait, frame, tap, read, pixel} = driver;
  const key = (type, key, code) => window.dispatchEvent(new KeyboardEvent(type, {key, code}));
  await wait(300);
  found.message_hidden = element('message').hidden;
  found.options = [...element('cameras').options].map((option) => option.text);

  found.probes = [await read(0.5, 0.5), await read(0.45, 0.6), await read(0.5, 0.9)];
  found.outside = await read(0.02, 0.5);
  found.wall_pixel = pixel(0.5, 0.5);
  page.camera.aspect = page.bookmark.aspect;  // of the camera's own picture, not of the window
  page.fit_view();
  found.measured_exposure = page.picture.meter().exposure;
  page.resize();
  tap('+');
  found.brighter_pixel = pixel(0.5, 0.5);
  tap('0');
  tap('v');
  found.legend = !element('legend').hidden && [...document.querySelectorAll('.step')].map((s) => s.textContent);
  found.false_color_pixel = pixel(0.5, 0.5);
  tap('u');
  found.luminance_legend = !element('legend').hidden && element('unit').textContent;
  found.luminance_scale = page.model.about.false_colors.luminance;
  found.luminance_pixel = pixel(0.5, 0.5);
  tap('u');
  found.legend_goes = element('legend').hidden;
  tap('m');
  page.picture.draw();
  tap('m');
  tap('?');
  found.help = !element('help').hidden;
  tap('?');

  // Into the box, to the wall at its end.
  key('keydown', 'w', 'KeyW');
  key('keydown', 'Shift', 'ShiftLeft');
  const start = page.camera.position.z;
  for (let i = 0; i < 9 && page.camera.position.z === start; ++i) await frame();
  found.walks = page.camera.position.z !== start;
  for (let i = 0; i < 300; ++i) page.walker.advance(1 / 30);
  key('keyup', 'w', 'KeyW');
  key('keyup', 'Shift', 'ShiftLeft');
  found.at_wall = page.model.to_scene(page.camera.position);
  tap('1');
  found.back_at = page.model.to_scene(page.camera.position);
  tap('o');
  await wait(100);
  found.orbits = page.mode === 'orbit';
  tap('x');
});
</script>)";

TEST_P(InBrowser, ThePageShowsAndMeasuresTheSolution) {
  const SolvedScene box = shaded_box();
  Scene scene = box_scene();
  scene.surfaces[2].name = "</script><b>wall";
  const BakedModel model = bake_model(box, scene);
  const Json found = run(model, drive);
  ASSERT_FALSE(found.is_null());
  ASSERT_FALSE(found.contains("failed")) << found["failed"];
  EXPECT_EQ(found["errors"], Json::array());
  EXPECT_EQ(found["message_hidden"], true);
  EXPECT_EQ(found["options"], Json::array({"1 front"}));

  // Readings are those of interpolate_irradiance at the same point. Values of corners, and so
  // interpolated ones, have the relative error of half floats, 2^-11; positions have that of single
  // precision at 4 m.
  const ElementCaster caster(box.mesh);
  for (const Json& reading : found["probes"]) {
    ASSERT_TRUE(reading.contains("illuminance")) << reading;
    const Eigen::Vector3d at(number(reading["x"]), number(reading["y"]), number(reading["z"]));
    const bool on_floor = reading["surface"] == "floor";
    const Probe probe{.position = at,
                      .normal = on_floor ? Eigen::Vector3d(0, 1, 0) : Eigen::Vector3d(0, 0, -1)};
    const BandArray E = interpolate_irradiance(caster, box.solution, {&probe, 1});
    const double lux = luminous(rgb_bands(), E.row(0).transpose());
    EXPECT_NEAR(number(reading["illuminance"]), lux, lux * 6e-4) << reading;
    // Reflectance 1: the luminance is E / pi.
    EXPECT_NEAR(number(reading["luminance"]), lux / std::numbers::pi, lux * 2e-4);
  }
  EXPECT_EQ(found["probes"][0]["surface"], "</script><b>wall");
  EXPECT_EQ(found["probes"][2]["surface"], "floor");
  EXPECT_EQ(found["outside"]["text"], "");

  // The colour of a pixel is that of display_colors for the light at the point.
  const Probe middle{.position = {1, 1, 2}, .normal = {0, 0, -1}};
  const BandArray L =
      interpolate_irradiance(caster, box.solution, {&middle, 1}) / std::numbers::pi_v<float>;
  const double scale = model.cameras[0].scale;
  const auto wanted = display_colors(L, rgb_bands(), scale);
  const auto brighter = display_colors(L, rgb_bands(), scale * std::exp2(1.0 / 3.0));
  const double lux = luminous(rgb_bands(), L.row(0).transpose()) * std::numbers::pi;
  const auto in_false_color = false_colors({static_cast<float>(lux)}, {.low = 0.0, .high = 4000.0});
  const Json& scale_of_luminance = found["luminance_scale"];
  const auto in_luminance = false_colors({static_cast<float>(lux / std::numbers::pi)},
                                         {.low = scale_of_luminance["low"].get<double>(),
                                          .high = scale_of_luminance["high"].get<double>()});
  for (std::size_t c = 0; c < 3; ++c) {
    // The light of this wall is linear, so triangles interpolate it exactly, with two roundings.
    EXPECT_NEAR(found["wall_pixel"][c].get<int>(), wanted[c], 2) << c;
    EXPECT_NEAR(found["brighter_pixel"][c].get<int>(), brighter[c], 2) << c;
    EXPECT_NEAR(found["false_color_pixel"][c].get<int>(), in_false_color[c], 2) << c;
    EXPECT_NEAR(found["luminance_pixel"][c].get<int>(), in_luminance[c], 2) << c;
  }
  // Page and window measure the same picture. Pixels on edges, two or three in a hundred, may
  // belong to either of two walls, whose light differs by less than two stops.
  EXPECT_NEAR(std::log2(found["measured_exposure"].get<double>() / scale), 0.0, 0.05);

  ASSERT_TRUE(found["legend"].is_array());
  EXPECT_EQ(found["legend"].front(), "0");
  EXPECT_EQ(found["legend"].back(), "4000");
  EXPECT_EQ(found["luminance_legend"], "cd/m²");
  EXPECT_EQ(found["legend_goes"], true);
  EXPECT_EQ(found["help"], true);
  EXPECT_EQ(found["orbits"], true);

  // The eye stops a body's radius (a tenth of 2 m) before the wall at z = 2, and stands 0.65 of
  // the room's height over its floor.
  EXPECT_EQ(found["walks"], true);
  const Json& eye = found["at_wall"];
  EXPECT_NEAR(eye[0].get<double>(), 1.0, 1e-3);
  EXPECT_NEAR(eye[1].get<double>(), 1.3, 1e-3);
  EXPECT_NEAR(eye[2].get<double>(), 1.8, 1e-2);
  const Json& back = found["back_at"];
  EXPECT_NEAR(back[2].get<double>(), -3.0, 1e-5);
}

/// The page shows the sky above the horizon and the ground below, with the radiance of pictures;
/// dimming their channel dims both.
TEST_P(InBrowser, ThePageShowsTheSky) {
  constexpr const char* look = R"(<script>
driver.run(async (page, found) => {
  const {pixel} = driver;
  found.sky = pixel(0.02, 0.1);
  found.above = pixel(0.02, 0.485);
  found.below = pixel(0.02, 0.515);
  page.camera.lookAt(page.camera.position.clone().add(new Library.Vector3(...page.model.about.sky.sun.direction)));
  found.sun = pixel(0.5, 0.5);
  page.set_false_colors('illuminance');
  found.in_false_colours = pixel(0.5, 0.5);
});
</script>)";
  Scene scene = box_scene();
  scene.sky = Sky{.name = "even",
                  .scale = Eigen::Array3f(0.2f, 0.3f, 0.5f),
                  .ground = Eigen::Array3f(0.1f, 0.1f, 0.05f),
                  .sun = Sun{.direction = Eigen::Vector3d(-1.0, 2.0, -2.0) / 3.0,
                             .irradiance = Eigen::Array3f(2e-4f, 1e-4f, 1e-4f)}};
  const BakedModel model = bake_model(solved_box(), scene);
  const Json found = run(model, look);
  ASSERT_FALSE(found.is_null());
  ASSERT_FALSE(found.contains("failed")) << found["failed"];
  EXPECT_EQ(found["errors"], Json::array());
  const auto expect_shown = [&](const char* what, const Eigen::Array3f& L) {
    const auto wanted = display_colors(L.transpose(), rgb_bands(), model.cameras[0].scale);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(found[what][c].get<int>(), wanted[c], 2) << what << ' ' << c;
    }
  };
  expect_shown("sky", scene.sky->scale);
  expect_shown("above", scene.sky->scale);
  expect_shown("below", scene.sky->ground);
  expect_shown("sun", radiance_outside(*scene.sky, scene.sky->sun->direction));
  EXPECT_EQ(found["in_false_colours"], Json::array({0, 0, 0})) << "no light falls on it";
}

TEST_P(InBrowser, WithoutWebGlThePageSaysWhatToDo) {
  const Json found = run(bake_model(solved_box(), box_scene()),
                         "<script>report({message: element('message').textContent})</script>",
                         {.with_webgl = false});
  ASSERT_FALSE(found.is_null());
  EXPECT_TRUE(says(found["message"], "This browser shows no WebGL 2")) << found;
}

/// The halves of a textured wall have the colours of their reflectances, to one rounding more than
/// plain walls.
TEST_P(InBrowser, ThePageShowsPictures) {
  constexpr const char* look = R"(<script>
driver.run(async (page, found) => {
  const {wait, read, pixel} = driver;
  for (let i = 0; i < 200 && !page.picture.with_pictures[0].uniforms.is_there.value; ++i) await wait(50);
  found.halves = [pixel(0.45, 0.5), pixel(0.55, 0.5)];
  found.read = [await read(0.45, 0.5), await read(0.55, 0.5)];
});
</script>)";
  PicturedBox box;
  const BakedModel whole = bake_model(box.solved, box.scene);
  const Json found = run(whole, look);
  ASSERT_FALSE(found.is_null());
  ASSERT_FALSE(found.contains("failed")) << found["failed"];
  EXPECT_EQ(found["errors"], Json::array());
  for (int half = 0; half < 2; ++half) {
    const float rho = half == 0 ? bright_half : dark_half;
    const BandArray L = rho * white.transpose() / std::numbers::pi_v<float>;
    const auto wanted = display_colors(L, rgb_bands(), whole.cameras[0].scale);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(found["halves"][half][c].get<int>(), wanted[c], 3) << half << ' ' << c;
    }
    // The reading has the reflectance of the texel, whose 8 bits are exact to 1 % there.
    const double lux = luminous(rgb_bands(), Spectrum(white));
    const double luminance = rho * lux / std::numbers::pi;
    EXPECT_NEAR(number(found["read"][half]["luminance"]), luminance, 0.01 * luminance);
    EXPECT_NEAR(number(found["read"][half]["illuminance"]), lux, 1e-3 * lux);
  }
  box.scene.materials.back().mask = Mask{.image = picture_of(2, 1, {1.0f, 0.0f})};
  const Json with_hole = run(bake_model(box.solved, box.scene), look);
  ASSERT_FALSE(with_hole.is_null());
  EXPECT_EQ(with_hole["errors"], Json::array());
  EXPECT_GT(with_hole["halves"][0][1].get<int>(), 100);
  EXPECT_LT(with_hole["halves"][1][1].get<int>(), 60) << "the page's own ground";
}

/// A ball of a few large elements is split until it is round: the corners of all drawn triangles
/// lie on the ball, the triangles face outwards, and their area is less than the ball's by a share
/// of (2.8 degrees)^2 / 6 = 4e-4. Readings are those of its elements; the difference between chord
/// and arc is less than 1 % of the variation of light over an element of 60 degrees, here a half.
TEST_P(InBrowser, ThePageShowsRoundSpheres) {
  constexpr const char* look = R"(<script>
driver.run(async (page, found) => {
  const {model} = page, {sphere} = model.about.parts[0], center = new Library.Vector3(...sphere.center);
  Object.assign(found, {area: 0, off: 0, inwards: 0});
  for (let t = 0; t < model.triangles.length; t += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => new Library.Vector3().fromArray(model.positions, 3 * model.triangles[t + k]));
    const normal = b.clone().sub(a).cross(c.clone().sub(a));
    found.area += normal.length() / 2;
    for (const p of [a, b, c]) found.off = Math.max(found.off, Math.abs(p.distanceTo(center) - sphere.radius));
    if (normal.dot(a.clone().sub(center)) < 0) ++found.inwards;
  }
  found.elements = model.about.element_count;
  found.outlines = page.picture.make_outlines().geometry.index.count / 2;
  found.read = await driver.read(0.47, 0.46);
  page.picture.show_outlines(true);
  page.picture.draw();
});
</script>)";
  Scene scene = box_scene();
  const Sphere ball{.center = {1.0, 2.0, 3.0}, .radius = 0.5};
  scene.surfaces = {{.name = "ball", .material = 0, .shape = ball}};
  scene.bands = rgb_bands();
  scene.materials.resize(1);
  scene.materials[0].one_sided = true;
  scene.cameras[0].position = {1.0, 2.0, 1.0};
  SolvedScene solved{.mesh = build_patches(scene, {.max_patch_size = 0.5}), .solution = {}};
  RadiositySolution& solution = solved.solution;
  solution.bands = scene.bands;
  solution.patch_radiosity = BandArray::Zero(solved.mesh.patch_count(), 3);
  solution.direct_irradiance = BandArray::Ones(solved.mesh.vertex_count(), 3);
  solution.indirect_irradiance = BandArray::Zero(solved.mesh.vertex_count(), 3);
  for (int v = 0; v < solved.mesh.vertex_count(); ++v) {
    solution.direct_irradiance.row(v) += static_cast<float>(solved.mesh.position(v).y() - 2.0);
  }
  const Json found = run(bake_model(solved, scene), look);
  ASSERT_FALSE(found.is_null());
  ASSERT_FALSE(found.contains("failed")) << found["failed"];
  EXPECT_EQ(found["errors"], Json::array());
  EXPECT_EQ(found["elements"], solved.mesh.element_count());
  EXPECT_EQ(found["inwards"], 0);
  EXPECT_LT(found["off"].get<double>(),
            1e-6);  // single precision of 1 m, and half a step of 21 bits
  const double area = 4.0 * std::numbers::pi * 0.25;
  EXPECT_LT(found["area"].get<double>(), area);
  EXPECT_GT(found["area"].get<double>(), area * (1.0 - 1e-3));
  EXPECT_GT(found["outlines"].get<int>(), 2 * solved.mesh.element_count());

  const Json& reading = found["read"];
  ASSERT_TRUE(reading.contains("illuminance")) << found;
  const Eigen::Vector3d at(number(reading["x"]), number(reading["y"]), number(reading["z"]));
  const ElementCaster caster(solved.mesh);
  const Ray ray{.origin = scene.cameras[0].position, .direction = at - scene.cameras[0].position};
  ElementHit hit;
  caster.closest_hits({&ray, 1}, {&hit, 1});
  ASSERT_GE(hit.element, 0);
  const double lux =
      luminous(scene.bands, interpolate(solved.mesh, solution.direct_irradiance, hit));
  // The page's faces lie up to 1e-3 of the radius below the sphere; light varies by a half over one
  // radius.
  EXPECT_NEAR(number(reading["illuminance"]), lux, 0.002 * lux);
}

INSTANTIATE_TEST_SUITE_P(Pages, InBrowser,
                         testing::Values(BrowserKind::chromium, BrowserKind::firefox),
                         name_of_browser);

}  // namespace
}  // namespace lightwell::walkthrough_test
