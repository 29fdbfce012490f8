// Lighting cues of a walkthrough page in a browser, against scales_at().
#include <gtest/gtest.h>

#include "scene/errors.h"
#include "tests/viewer/channel_room.h"
#include "tests/viewer/in_browser.h"
#include "viewer/export/baked_channels.h"

namespace lightwell::cues_in_browser_test {
namespace {

/// Script that steps through the cues. Time is the script's own, so that no frame adds to it.
constexpr const char* drive = R"(<script>
driver.run(async (page, found) => {
  const {wait, tap} = driver, {cues, lights} = page;
  const pass = cues.advance.bind(cues);
  cues.advance = () => {};
  await wait(300);
  const control = (kind, channel) => document.querySelectorAll(`#channels ${kind}`)[channel];
  const list = element('cues');
  found.shown = !element('cue-row').hidden;
  found.names = [...list.options].filter(({hidden}) => !hidden).map(({text}) => text);
  found.at_first = list.value;
  tap('.');
  found.chosen = list.selectedOptions[0].text;
  found.fade = [];
  for (const step of [0.5, 0.5, 1, 1, 5]) {
    pass(step);
    found.fade.push(lights.weights());
  }
  found.percents = [0, 1].map((c) => control('output', c).value);
  found.colour = control('.colour', 1).value;
  element('cue-go').click();
  pass(10);
  found.dark = await driver.read(0.3, 0.4);
  found.off = lights.weights();
  tap(',');
  pass(0);
  found.back = lights.weights();
  // From the second cue on: its fade of 1 s, a hold of 2 s, and half of the last fade of 4 s.
  tap(';');
  found.playing = element('cue-play').getAttribute('aria-pressed');
  for (let i = 0; i < 10; ++i) pass(0.5);
  found.midway = lights.weights();
  found.last = list.selectedOptions[0].text;
  const slider = control('.slider', 0);
  slider.value = 150;
  slider.dispatchEvent(new Event('input', {bubbles: true}));
  found.stopped = element('cue-play').getAttribute('aria-pressed');
  pass(10);
  found.by_hand = lights.weights();
  list.value = 0;
  list.dispatchEvent(new Event('change', {bubbles: true}));
  pass(10);
  found.from_list = lights.weights();
});
</script>)";

/// Expects weights, channel by channel, that are the scales to the rounding of floats: JSON has
/// their shortest digits, and the script has doubles.
void expect_weights(const Json& weights, const std::vector<Spectrum>& scales) {
  ASSERT_EQ(weights.size(), scales.size());
  for (std::size_t c = 0; c < scales.size(); ++c) {
    for (int k = 0; k < 3; ++k) {
      // Three operations of scales_at() on floats: a difference, a product and a sum.
      EXPECT_NEAR(weights[c][k].get<double>(), scales[c][k], 3 * 6e-8 * 2.0) << c;
    }
  }
}

TEST_P(InBrowser, CuesFadeAsOnAConsole) {
  const Scene scene = channel_room();
  const SolvedScene solved = solve_by_channel(scene);
  const RadiositySolution& s = solved.solution;
  const WordedCue worded[] = {
      {.name = "<dusk>",
       .levels = {{"desk", "0.5", "here"}, {"panel", "1.5,#ff8040", "here"}},
       .others = {},
       .fade_up = 2.0,
       .fade_down = 1.0,
       .wait = 0.5},
      {.name = "off",
       .levels = {},
       .others = WordedLevel{"*", "off", "here"},
       .fade_down = 1.0,
       .hold = 2.0},
      {.name = "full", .levels = {{"*", "on", "here"}}, .others = {}, .fade_up = 4.0}};
  const std::vector<Cue> cues = cues_for(s, worded);
  BakedModel model = bake_model(solved, scene);
  model.cues = bake_cues(s, cues);
  const Json found = run(model, drive);
  ASSERT_FALSE(found.is_null());
  ASSERT_FALSE(found.contains("failed")) << found["failed"];
  EXPECT_EQ(found["errors"], Json::array());

  EXPECT_EQ(found["shown"], true);
  EXPECT_EQ(found["names"], Json::array({"<dusk>", "off", "full"}));
  EXPECT_EQ(found["at_first"], "-1");
  EXPECT_EQ(found["chosen"], "<dusk>");
  const CueFade fade = fade_to(s, effective_scales(s), cues[0]);
  const double seconds[] = {0.5, 1.0, 2.0, 3.0, 8.0};
  for (std::size_t i = 0; i < std::size(seconds); ++i) {
    expect_weights(found["fade"][i], scales_at(fade, seconds[i]));
  }
  EXPECT_EQ(found["percents"], Json::array({"50 %", "150 %"}));
  EXPECT_EQ(found["colour"], "#ff8040");
  expect_weights(found["off"], cues[1].scales);
  EXPECT_EQ(found["dark"]["illuminance"], "0") << found["dark"];
  expect_weights(found["back"], cues[0].scales);
  EXPECT_EQ(found["playing"], "true");
  EXPECT_EQ(found["last"], "full");
  expect_weights(found["midway"], scales_at(fade_to(s, cues[1].scales, cues[2]), 2.0));
  EXPECT_EQ(found["stopped"], "false");
  expect_weights(found["by_hand"], {Spectrum::Constant(3, 1.5f), Spectrum::Constant(3, 0.5f)});
  expect_weights(found["from_list"], cues[0].scales);
}

/// A solution of which a page holds one spectrum for each channel has no cue of another.
TEST(BakeCues, RefuseAnotherSpectrumThanTheSolutionHas) {
  RadiositySolution s;
  s.bands = spectral_bands(420.0, 680.0, 4);
  LightChannel lamp{.name = "lamp", .scale = Spectrum::Constant(4, 0.5f)};
  lamp.scale[0] = 0.25f;
  lamp.energy = BandEnergy::Ones(4, 4);
  s.channels.push_back(lamp);
  const Cue dimmed{.name = "dimmed", .scales = {0.5f * lamp.scale}};
  const std::vector<BakedCue> baked = bake_cues(s, {dimmed});
  EXPECT_TRUE((baked[0].weights[0] == 0.25f).all());
  const Cue even{.name = "even", .scales = {Spectrum::Constant(4, 1.0f)}};
  EXPECT_THROW(bake_cues(s, {even}), InputError);
}

}  // namespace
}  // namespace lightwell::cues_in_browser_test
