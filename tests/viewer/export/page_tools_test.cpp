// Tools of the walkthrough page in a browser: plan, measuring, isolux lines, ranges, white balance,
// languages.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/elements/element_caster.h"
#include "raytrace/display/light_meter.h"
#include "tests/viewer/in_browser.h"
#include "tests/viewer/lit_sides.h"
#include "viewer/export/appearance.h"

namespace lightwell::page_tools_test {
namespace {

/// From a place in the plan, 1 m along x and half a metre along z, in pixels.
constexpr const char* use_plan = R"(<script>
driver.run(async (page, found) => {
  const {tap_finger, tap} = driver, canvas = element('view');
  tap('p');
  page.draw(0);
  const pixel = 1 / page.plan.metres_per_pixel(canvas.clientHeight);
  const start = on_canvas(new Library.Vector3(0.5, 0, 0.75), page.picture.camera, canvas);
  for (const k of ['x', 'y']) start[k] = Math.round(start[k]);  // wheels turn at whole pixels
  found.metres_per_pixel = 1 / pixel;
  found.readings = [await tap_finger(start.x, start.y), await tap_finger(start.x + pixel, start.y + pixel / 2)];
  found.pressed = element('plan').getAttribute('aria-pressed');
  tap('g');
  await tap_finger(start.x, start.y);
  await tap_finger(start.x + pixel, start.y + pixel / 2);
  found.distance = {...element('distance').dataset};
  tap('g');
  canvas.dispatchEvent(new WheelEvent('wheel', {deltaY: -Math.log(2) / Math.log(wheel_step), clientX: start.x, clientY: start.y}));
  found.scaled = await tap_finger(start.x, start.y);
  found.larger = 1 / page.plan.metres_per_pixel(canvas.clientHeight) / pixel;
  tap('p');
  found.back = page.mode;
});
</script>)";

TEST_P(InBrowser, ThePlanIsToScaleAndIsRead) {
  const Json found = run(bake_model(shaded_box(), box_scene()), use_plan);
  ASSERT_FALSE(found.is_null());
  ASSERT_FALSE(found.contains("failed")) << found["failed"];
  EXPECT_EQ(found["errors"], Json::array());
  EXPECT_EQ(found["pressed"], "true");
  EXPECT_EQ(found["back"], "walk");
  const auto expect_at = [](const Json& reading, double x, double z) {
    ASSERT_EQ(reading["surface"], "floor") << "the ceiling is cut off";
    // Positions have single precision and 21 bits.
    EXPECT_NEAR(number(reading["x"]), x, 1e-5);
    EXPECT_NEAR(number(reading["z"]), z, 1e-5);
    const double lux = 683.0 * (1.0 + 0.5 * x + 0.1 * z * x);      // shaded_box(), on the floor
    EXPECT_NEAR(number(reading["illuminance"]), lux, 6e-4 * lux);  // half floats
  };
  const Json& first = found["readings"][0];
  ASSERT_TRUE(first.contains("x")) << found;
  const double x = number(first["x"]), z = number(first["z"]);
  const double pixel = found["metres_per_pixel"];
  EXPECT_NEAR(x, 0.5, pixel);
  EXPECT_NEAR(z, 0.75, pixel);
  expect_at(first, x, z);
  expect_at(found["readings"][1], x + 1.0, z + 0.5);
  expect_at(found["scaled"], x, z);
  EXPECT_NEAR(found["larger"].get<double>(), 2.0, 1e-9);
  const Json& distance = found["distance"];
  ASSERT_TRUE(distance.contains("distance")) << found;
  EXPECT_NEAR(number(distance["distance"]), std::sqrt(1.25), 1e-5);
  EXPECT_NEAR(number(distance["dx"]), 1.0, 1e-5);
  EXPECT_NEAR(number(distance["dy"]), 0.0, 1e-5);
  EXPECT_NEAR(number(distance["dz"]), 0.5, 1e-5);
}

/// Looks along a row of the screen's pixels on the far wall for the whitest one, and reads there.
constexpr const char* find_lines = R"(<script>
driver.run(async (page, found) => {
  const {read, tap} = driver;
  const gl = page.picture.renderer.getContext(), width = gl.drawingBufferWidth, height = gl.drawingBufferHeight;
  const first = Math.floor(0.45 * width), count = Math.floor(0.1 * width);
  const row = () => {
    const bytes = new Uint8Array(4 * count);
    page.picture.draw();
    gl.readPixels(first, Math.floor(height / 2), count, 1, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    return Array.from({length: count}, (_, i) => [...bytes.subarray(4 * i, 4 * i + 3)]);
  };
  const read_at = (i) => read((first + i + 0.5) / width, 1 - (Math.floor(height / 2) + 0.5) / height);
  page.set_false_colors('illuminance');  // no colour of the scale is white
  const plain = row();
  tap('i');
  const lined = row();
  found.levels = page.levels;
  const whiteness = lined.map((rgb) => Math.min(...rgb));
  const at = whiteness.indexOf(Math.max(...whiteness));
  found.whitest = lined[at];
  found.on_line = await read_at(at);
  found.beside = await read_at(at + 1);
  found.changed = lined.filter((rgb, i) => rgb.some((c, k) => c !== plain[i][k])).length;
  found.pixel_ratio = page.picture.renderer.getPixelRatio();
  await driver.wait(400);
  found.labels = [...document.querySelectorAll('#labels span')].map((label) => label.textContent);
  tap('i');
  found.gone = row().every((rgb, i) => rgb.every((c, k) => c === plain[i][k]));
});
</script>)";

TEST_P(InBrowser, IsoluxLinesLieWhereTheLevelIs) {
  // 1366 (1.2 + 0.7 x) lx on the far wall at half its height: 2000 lx at x = 0.377, 2595 lx in the
  // middle. The light is made less, so that 2000 lx is near the middle.
  SolvedScene box = shaded_box();
  box.solution.direct_irradiance *= 2000.0f / 2600.0f;
  const Json found = run(bake_model(box, box_scene()), find_lines);
  ASSERT_FALSE(found.is_null());
  ASSERT_FALSE(found.contains("failed")) << found["failed"];
  EXPECT_EQ(found["errors"], Json::array());
  EXPECT_NE(std::ranges::find(found["levels"], Json(2000)), found["levels"].end());
  for (int c = 0; c < 3; ++c) EXPECT_GT(found["whitest"][c].get<int>(), 240);
  // The line is 1.6 pixels wide, so a pixel of it is within a pixel of the level; the rim ends
  // 2.6 pixels from it. Pixels are of the screen, and there may be several to one of the page.
  const double lux = number(found["on_line"]["illuminance"]);
  const double step = std::abs(number(found["beside"]["illuminance"]) - lux);
  const double ratio = found["pixel_ratio"];
  EXPECT_NEAR(lux, 2000.0, ratio * step);
  EXPECT_GE(found["changed"].get<int>(), 2);
  EXPECT_LE(found["changed"].get<int>(), 2.0 * 2.6 * ratio + 1.0);
  EXPECT_EQ(found["gone"], true);
  EXPECT_NE(std::ranges::find(found["labels"], Json("2000")), found["labels"].end())
      << found["labels"];
}

/// The ends of the scale are typed; an impossible range is not taken.
TEST_P(InBrowser, TheRangeOfFalseColoursIsSet) {
  constexpr const char* type = R"(<script>
driver.run(async (page, found) => {
  const put = (id, value) => {
    element(id).value = value;
    element(id).dispatchEvent(new Event('change'));
  };
  page.set_false_colors('illuminance');
  put('low', '1000');
  put('high', '3000');
  found.linear = driver.pixel(0.5, 0.5);
  put('range-scale', 'logarithmic');
  found.logarithmic = driver.pixel(0.5, 0.5);
  found.steps = [...document.querySelectorAll('.step')].map((step) => step.textContent);
  put('high', '10');
  found.refused = page.ranges.illuminance;
  put('range-scale', 'linear');
  put('low', '0');
  put('range-scale', 'logarithmic');
  found.from_zero = page.ranges.illuminance;
  element('reset').click();
  found.reset = page.ranges.illuminance;
});
</script>)";
  const BakedModel model = bake_model(solved_box(), box_scene());
  const Json found = run(model, type);
  ASSERT_FALSE(found.is_null());
  ASSERT_FALSE(found.contains("failed")) << found["failed"];
  EXPECT_EQ(found["errors"], Json::array());
  // The white wall has 1366 lx everywhere.
  const auto linear = false_colors({366.0f}, {.low = 0.0, .high = 2000.0});
  const auto logarithmic = false_colors({1366.0f}, {.low = 1000.0, .high = 3000.0});
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(found["linear"][c].get<int>(), linear[c], 2) << c;  // two roundings
    EXPECT_NEAR(found["logarithmic"][c].get<int>(), logarithmic[c], 2) << c;
  }
  EXPECT_EQ(found["steps"], Json::array({"1000", "2000"}));
  EXPECT_EQ(found["refused"], (Json{{"low", 1000}, {"high", 3000}, {"logarithmic", true}}));
  EXPECT_EQ(found["from_zero"], (Json{{"low", 3}, {"high", 3000}, {"logarithmic", true}}));
  EXPECT_EQ(found["reset"], (Json{{"low", 0}, {"high", 4000}, {"logarithmic", false}}));
}

/// White walls under a black body of 2700 K.
class WarmBox {
 public:
  const Eigen::Array3f colour = colour_of_black_body(2700.0);
  Scene scene = box_scene();
  SolvedScene solved = solved_box();

  WarmBox() { solved.solution.direct_irradiance.rowwise() = (2.0f * colour).transpose(); }
};

TEST_P(InBrowser, WhiteBalanceMakesWarmWallsGrey) {
  constexpr const char* choose = R"(<script>
driver.run(async (page, found) => {
  const choose = (value) => {
    element('white').value = value;
    element('white').dispatchEvent(new Event('change'));
    return driver.pixel(0.5, 0.5);
  };
  found.first = driver.pixel(0.5, 0.5);
  found.first_choice = element('white').value;
  for (const value of ['as-lit', 'auto', '2700', '5000']) found[value] = choose(value);
});
</script>)";
  const WarmBox box;
  const BakedModel model = bake_model(box.solved, box.scene);
  const WhitePoint first{.kind = WhitePoint::Kind::black_body, .kelvin = 2850.0};
  const Json found = run(model, choose, {.white = first});
  ASSERT_FALSE(found.is_null());
  ASSERT_FALSE(found.contains("failed")) << found["failed"];
  EXPECT_EQ(found["errors"], Json::array());
  EXPECT_EQ(found["first_choice"], "2850");
  const auto expect_balanced = [&](const char* which, const Eigen::Array3f& balance) {
    const BandArray L = (2.0f * box.colour * balance).transpose() / std::numbers::pi_v<float>;
    const auto wanted = display_colors(L, rgb_bands(), model.cameras[0].scale);
    for (std::size_t c = 0; c < 3; ++c) {
      // Blue is a twentieth of red: half floats, and two roundings.
      EXPECT_NEAR(found[which][c].get<int>(), wanted[c], 2) << which << ' ' << c;
    }
  };
  expect_balanced("as-lit", Eigen::Array3f::Ones());
  expect_balanced("auto", white_balance(box.colour));
  expect_balanced("2700", white_balance(colour_of_black_body(2700.0)));
  expect_balanced("5000", white_balance(colour_of_black_body(5000.0)));
  expect_balanced("first", white_balance(colour_of_black_body(2850.0)));
  const std::vector<int> grey = found["2700"];
  EXPECT_LE(std::ranges::max(grey) - std::ranges::min(grey), 2);
  EXPECT_GT(found["as-lit"][0].get<int>(), found["as-lit"][2].get<int>() + 50) << "warm as lit";
}

/// Automatic white of a room of coloured walls is metered as for pictures. Pixels on edges, two or
/// three in a hundred, may belong to either of two walls, whose colours differ by a factor
/// below 10.
TEST_P(InBrowser, ThePageMetersTheColourOfTheLight) {
  constexpr const char* meter = R"(<script>
driver.run(async (page, found) => { found.colour = page.light_colour; });
</script>)";
  const SolvedScene box = shaded_box();
  const Scene scene = box_scene();
  const Json found =
      run(bake_model(box, scene), meter, {.white = {.kind = WhitePoint::Kind::automatic}});
  ASSERT_FALSE(found.is_null());
  ASSERT_FALSE(found.contains("failed")) << found["failed"];
  const ElementCaster caster(box.mesh);
  const auto light =
      meter_incident_light(caster, box.solution.irradiance(), {}, rgb_bands(), scene.cameras[0]);
  ASSERT_TRUE(light.has_value());
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(found["colour"][c].get<double>(), light->colour[c], 0.03 * light->colour[c]);
  }
}

/// Every language has every text, and the page shows it; every control has a name.
TEST_P(InBrowser, EveryLanguageHasEveryText) {
  constexpr const char* speak = R"(<script>
driver.run(async (page, found) => {
  found.keys = {};
  found.placeholders = {};
  found.unnamed = [];
  found.spoken = {};
  for (const [code, words] of Object.entries(texts)) {
    found.keys[code] = Object.keys(words).filter((key) => words[key].length > 0).sort();
    found.placeholders[code] = Object.keys(words).sort().map((key) => (words[key].match(/\{\w+\}/g) ?? []).sort());
    element('language').value = code;
    element('language').dispatchEvent(new Event('change'));
    const name = (part) => part.getAttribute('aria-label') || part.textContent || part.labels?.[0]?.textContent;
    for (const part of document.querySelectorAll('button, select, input, canvas[tabindex]')) {
      if (!name(part)) found.unnamed.push(`${code}: ${part.id}`);
    }
    found.spoken[code] = [element('illuminance').getAttribute('aria-label'), document.documentElement.lang];
  }
  found.chosen = [['de-AT', 'en'], ['pt', 'fr-CA'], ['ja']].map(language_for);
  const used = [...document.querySelectorAll('[data-text], [data-title]')].flatMap(({dataset: {text, title}}) => [text, title]);
  found.unknown = [...used, ...[...finger_help, ...key_help].flat().flatMap((words) => words.match(/(key|help)_\w+/g) ?? [])]
    .filter((key) => key && !(key in texts.en));
});
</script>)";
  const Json found = run(bake_model(solved_box(), box_scene()), speak);
  ASSERT_FALSE(found.is_null());
  ASSERT_FALSE(found.contains("failed")) << found["failed"];
  ASSERT_EQ(found["keys"].size(), 4u);
  // English tells that there are placeholders to compare: a text for each of them.
  ASSERT_EQ(found["placeholders"].size(), 4u);
  ASSERT_EQ(found["placeholders"]["en"].size(), found["keys"]["en"].size());
  EXPECT_FALSE(std::ranges::all_of(found["placeholders"]["en"],
                                   [](const Json& names) { return names.empty(); }));
  for (const auto& [code, keys] : found["keys"].items()) {
    EXPECT_EQ(keys, found["keys"]["en"]) << code;
    EXPECT_EQ(found["placeholders"][code], found["placeholders"]["en"]) << code;
  }
  EXPECT_EQ(found["unnamed"], Json::array());
  EXPECT_EQ(found["unknown"], Json::array());
  EXPECT_EQ(found["chosen"], Json::array({"de", "fr", "en"}));
  EXPECT_TRUE(says(found["spoken"]["de"][0], "Beleuchtungsstärke"));
  EXPECT_TRUE(says(found["spoken"]["fr"][0], "Éclairement"));
  EXPECT_TRUE(says(found["spoken"]["es"][0], "Iluminancia"));
  EXPECT_EQ(found["spoken"]["es"][1], "es");
}

}  // namespace
}  // namespace lightwell::page_tools_test
