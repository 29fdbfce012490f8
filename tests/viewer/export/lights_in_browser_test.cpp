// The lights of a walkthrough page in a browser, against relight().
#include <gtest/gtest.h>

#include <cmath>

#include "mesh/elements/element_caster.h"
#include "tests/viewer/channel_room.h"
#include "tests/viewer/in_browser.h"
#include "viewer/export/appearance.h"

namespace lightwell::lights_in_browser_test {
namespace {

/// Script that dims, recolours and switches lamps, and reads the light after each change.
constexpr const char* drive = R"(<script>
driver.run(async (page, found) => {
  const {wait, tap} = driver;
  await wait(300);
  const read = async () => {
    const readings = [];
    for (const [x, y] of [[0.5, 0.5], [0.6, 0.9], [0.3, 0.4], [0.8, 0.3], [0.45, 0.75]]) {
      readings.push(await driver.read(x, y));
    }
    return readings;
  };
  const selectors = {power: '.checkbox', slider: '.slider', colour: '.colour', percent: 'output', name: 'span'};
  const control = (kind, channel) => document.querySelectorAll(`#channels ${selectors[kind]}`)[channel];
  const put = (kind, channel, value) => {
    const input = control(kind, channel);
    if (kind === 'power') input.checked = value; else input.value = value;
    input.dispatchEvent(new Event('input', {bubbles: true}));
  };
  found.names = [0, 1].map((c) => control('name', c).textContent);
  found.percents = [0, 1].map((c) => control('percent', c).value);
  found.sliders = [0, 1].map((c) => control('slider', c).value);
  found.colours = [0, 1].map((c) => control('colour', c).value);
  found.open = !element('lights').hidden;
  tap('t');
  found.closed = element('lights').hidden;
  tap('t');
  const exposure = () => page.picture.uniforms.scale.value[0];
  const before = exposure();
  found.in_force = await read();
  put('slider', 0, 30);
  put('colour', 1, '#ffd9b0');
  found.evening = await read();
  found.exposure_stays = exposure() === before;
  control('slider', 1).dispatchEvent(new MouseEvent('dblclick', {bubbles: true}));
  put('power', 0, false);
  found.panel_alone = await read();
  put('power', 0, true);
  found.kept = control('percent', 0).value;
  put('slider', 0, 200);
  tap('0');  // exposes for the light as it is now, whether or not a frame has been drawn since
  found.brighter_exposure = exposure();
  found.bright = await read();
  put('power', 0, false);
  put('power', 1, false);
  found.off = await read();
  tap('0');
  found.exposure_of_darkness = exposure();
});
</script>)";

/// Expects readings with the light of relight() at the same points, to the precision of half
/// floats, 2^-11, and of positions in single precision.
void expect_light(const Json& readings, const SolvedScene& lit, const Scene& scene) {
  const ElementCaster caster(lit.mesh);
  const BandArray radiance = shown_radiance(lit, scene.materials);
  ASSERT_EQ(readings.size(), 5u);
  for (const Json& reading : readings) {
    ASSERT_TRUE(reading.contains("illuminance")) << reading;
    const Eigen::Vector3d at(number(reading["x"]), number(reading["y"]), number(reading["z"]));
    const Eigen::Vector3d eye = scene.cameras[0].position;
    const Ray ray{.origin = eye, .direction = (at - eye).normalized()};
    ElementHit hit;
    caster.closest_hits({&ray, 1}, {&hit, 1});
    ASSERT_GE(hit.element, 0);
    ASSERT_NEAR(hit.t, (at - eye).norm(), 1e-5);
    const Spectrum E = interpolate(lit.mesh, lit.solution.irradiance(), hit);
    const double lux = luminous(lit.solution.bands, E);
    EXPECT_NEAR(number(reading["illuminance"]), lux, 6e-4 * lux) << reading;
    const double nits = luminous(lit.solution.bands, interpolate(lit.mesh, radiance, hit));
    EXPECT_NEAR(number(reading["luminance"]), nits, 6e-4 * nits) << reading;
  }
}

double exposure_for(const SolvedScene& lit, const Scene& scene) {
  return bake_model(lit, scene).cameras[0].scale;
}

TEST_P(InBrowser, SlidersRelightTheScene) {
  const Scene scene = channel_room();
  const SolvedScene solved = solve_by_channel(scene);
  ASSERT_EQ(solved.solution.channels.size(), 2u);
  const SolvedScene dim = relit(solved, {"2.5", "0.5,#ff8040"});
  const Json found = run(bake_model(dim, scene), drive);
  ASSERT_FALSE(found.is_null());
  ASSERT_FALSE(found.contains("failed")) << found["failed"];
  EXPECT_EQ(found["errors"], Json::array());

  // Controls begin with the scales of the solution.
  EXPECT_EQ(found["names"], Json::array({"desk", "panel"}));
  EXPECT_EQ(found["percents"], Json::array({"250 %", "50 %"}));
  EXPECT_EQ(found["sliders"], Json::array({"250", "50"}));
  EXPECT_EQ(found["colours"], Json::array({"#ffffff", "#ff8040"}));
  EXPECT_EQ(found["open"], true);
  EXPECT_EQ(found["closed"], true);
  EXPECT_EQ(found["kept"], "30 %");

  expect_light(found["in_force"], dim, scene);
  EXPECT_EQ(found["in_force"][0]["surface"], "desk");  // the lamp itself
  expect_light(found["evening"], relit(solved, {"0.3", "0.5,#ffd9b0"}), scene);
  EXPECT_EQ(found["exposure_stays"], true);
  expect_light(found["panel_alone"], relit(solved, {"off", "1,#ffd9b0"}), scene);
  const SolvedScene bright = relit(solved, {"2", "1,#ffd9b0"});
  expect_light(found["bright"], bright, scene);
  expect_light(found["off"], relit(solved, {"off", "off"}), scene);

  // The exposure meter measures the brighter picture. Pixels on edges, a few in a hundred, may
  // belong to either side.
  const double exposure = found["brighter_exposure"];
  EXPECT_NEAR(std::log2(exposure / exposure_for(bright, scene)), 0.0, 0.05);
  EXPECT_EQ(found["exposure_of_darkness"], exposure);  // nothing to expose for
}

}  // namespace
}  // namespace lightwell::lights_in_browser_test
