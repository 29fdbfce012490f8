#include "radiosity/solution/cues.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>

#include "radiosity/solution/channel_settings.h"
#include "scene/errors.h"

namespace lightwell::cues_test {
namespace {

// Channels without light on surfaces: scales depend on the flux of emitters alone.
RadiositySolution stage() {
  RadiositySolution s;
  s.bands = rgb_bands();
  for (const char* const name : {"row 1", "row 2", "desk"}) {
    LightChannel channel{.name = name, .scale = Spectrum::Constant(3, 1.0f)};
    channel.energy = BandEnergy::Zero(4, 3);
    channel.energy.row(0) << 10.0, 12.0, 5.0;
    s.channels.push_back(std::move(channel));
  }
  return s;
}

WordedLevel level(const char* channels, const char* value) {
  return {channels, value, std::string("cues.toml:1:1: level '") + channels + "' of cue 'a'"};
}

// Factors of all channels whose scale is the same in every band.
std::vector<float> factors(const std::vector<Spectrum>& scales) {
  std::vector<float> result;
  for (const Spectrum& scale : scales) {
    EXPECT_TRUE((scale == scale[0]).all());
    result.push_back(scale[0]);
  }
  return result;
}

using Factors = std::vector<float>;

/// A channel without a level keeps that of the cue before; `others` ends the tracking.
TEST(Cues, ChannelsWithoutALevelTrack) {
  RadiositySolution s = stage();
  s.channels[2].scale *= 0.25f;  // the solution was relit before
  const WordedCue worded[] = {
      {.name = "one", .levels = {level("row 1", "0.5")}},
      {.name = "two", .levels = {level("row 2", "off")}},
      {.name = "three", .levels = {level("row 1", "2")}, .others = level("*", "0.125")},
      {.name = "four", .levels = {level("desk", "on")}}};
  const std::vector<Cue> cues = cues_for(s, worded);
  ASSERT_EQ(cues.size(), 4u);
  EXPECT_EQ(factors(cues[0].scales), (Factors{0.5f, 1.0f, 0.25f}));
  EXPECT_EQ(factors(cues[1].scales), (Factors{0.5f, 0.0f, 0.25f}));
  EXPECT_EQ(factors(cues[2].scales), (Factors{2.0f, 0.125f, 0.125f}));
  EXPECT_EQ(factors(cues[3].scales), (Factors{2.0f, 0.125f, 1.0f}));
}

/// A name comes before a pattern, in whatever order they stand.
TEST(ChannelSettings, NamesComeBeforePatterns) {
  const RadiositySolution s = stage();
  const NamedSetting pattern{"row*", {.factor = 0.5}, "here"}, name{"row 2", {.factor = 2}, "here"};
  const std::vector<NamedSetting> forth = {pattern, name}, back = {name, pattern};
  for (const auto& settings : {forth, back}) {
    EXPECT_EQ(factors(apply_settings(s, settings, effective_scales(s))),
              (Factors{0.5f, 2.0f, 1.0f}));
  }
}

/// A channel whose name looks like a pattern is found by that name alone.
TEST(ChannelSettings, ANameMayLookLikeAPattern) {
  RadiositySolution s = stage();
  s.channels[0].name = "row ?";
  const NamedSetting settings[] = {{"row ?", {.factor = 0.5}, "here"}};
  EXPECT_EQ(factors(apply_settings(s, settings, effective_scales(s))), (Factors{0.5f, 1.0f, 1.0f}));
}

std::string refusal(const RadiositySolution& s, std::vector<WordedLevel> levels) {
  const WordedCue cue{.name = "a", .levels = std::move(levels)};
  try {
    cues_for(s, {&cue, 1});
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was refused";
}

TEST(Cues, FaultsAreNamedWithTheirPlace) {
  const RadiositySolution s = stage();
  EXPECT_EQ(refusal(s, {level("dsk", "1")}),
            "cues.toml:1:1: level 'dsk' of cue 'a': there is no channel 'dsk'; the solution has: "
            "row 1, row 2, desk. Did you mean 'desk'?");
  EXPECT_NE(refusal(s, {level("row*", "1"), level("*1", "0")})
                .find("level '*1' of cue 'a': channel 'row 1' would have two settings, by 'row*' "
                      "and by '*1'"),
            std::string::npos);
  for (const char* const senseless : {"-0.5", "bright", "1e7", "#12", "#000000", "", "0.5,"}) {
    EXPECT_NE(refusal(s, {level("desk", senseless)}).find("cues.toml:1:1: level 'desk' of cue 'a'"),
              std::string::npos)
        << senseless;
  }
}

/// Light rises by fade_up and falls by fade_down, both linear and after the wait.
TEST(CueFade, RisesAndFallsInTheirOwnTimes) {
  const RadiositySolution s = stage();
  Cue cue{.name = "a",
          .scales = {Spectrum::Constant(3, 3.0f), Spectrum::Constant(3, 0.0f),
                     Spectrum::Constant(3, 1.0f)},
          .fade_up = 2.0,
          .fade_down = 8.0,
          .wait = 1.0};
  const CueFade fade = fade_to(s, effective_scales(s), cue);
  EXPECT_EQ(fade.seconds, 9.0);
  // Sums by hand; all numbers are exact in binary.
  EXPECT_EQ(factors(scales_at(fade, 0.0)), (Factors{1.0f, 1.0f, 1.0f}));
  EXPECT_EQ(factors(scales_at(fade, 1.0)), (Factors{1.0f, 1.0f, 1.0f}));
  EXPECT_EQ(factors(scales_at(fade, 1.5)), (Factors{1.5f, 0.9375f, 1.0f}));
  EXPECT_EQ(factors(scales_at(fade, 3.0)), (Factors{3.0f, 0.75f, 1.0f}));
  EXPECT_EQ(factors(scales_at(fade, 5.0)), (Factors{3.0f, 0.5f, 1.0f}));
  EXPECT_EQ(factors(scales_at(fade, 9.0)), (Factors{3.0f, 0.0f, 1.0f}));
}

/// A cue that only rises does not last as long as its fade_down.
TEST(CueFade, LastsAsLongAsWhatChanges) {
  const RadiositySolution s = stage();
  Cue cue{.name = "a", .scales = effective_scales(s), .fade_up = 2.0, .fade_down = 8.0};
  EXPECT_EQ(fade_to(s, effective_scales(s), cue).seconds, 0.0);
  cue.scales[0] *= 2.0f;
  EXPECT_EQ(fade_to(s, effective_scales(s), cue).seconds, 2.0);
}

/// A colour keeps the luminous flux to the rounding of floats, and fades as rising light does.
TEST(CueFade, ColoursTakeTheTimeOfRisingLight) {
  const RadiositySolution s = stage();
  for (const char* const colour : {"#ff8040", "#4080ff", "#ffd9b0", "#10ff33"}) {
    const WordedCue worded{.name = "a",
                           .levels = {level("*", colour)},
                           .others = {},
                           .fade_up = 2.0,
                           .fade_down = 8.0};
    const std::vector<Cue> cues = cues_for(s, {&worded, 1});
    EXPECT_EQ(fade_to(s, effective_scales(s), cues[0]).seconds, 2.0) << colour;
  }
}

/// A fade may begin while another is under way: it goes on from the light of that moment.
TEST(CueFade, BeginsWithWhateverIsThere) {
  const RadiositySolution s = stage();
  const Cue dark{
      .name = "dark", .scales = std::vector<Spectrum>(3, Spectrum::Zero(3)), .fade_down = 4.0};
  const CueFade down = fade_to(s, effective_scales(s), dark);
  const CueFade up = fade_to(s, scales_at(down, 2.0),
                             {.name = "full", .scales = effective_scales(s), .fade_up = 2.0});
  EXPECT_EQ(factors(scales_at(up, 0.0)), (Factors{0.5f, 0.5f, 0.5f}));
  EXPECT_EQ(factors(scales_at(up, 1.0)), (Factors{0.75f, 0.75f, 0.75f}));
}

/// At the end of a cue the scales are its own to the last bit.
/// Rising and falling light takes its own time, so that a moment is a mean of three states, which
/// are the same throughout the fade.
TEST(CueFade, MomentsAreMeansOfItsStates) {
  CueFade fade;
  for (const auto& [from, to] : {std::pair(0.0f, 1.0f), {1.0f, 0.25f}, {0.5f, 0.5f}}) {
    fade.from.push_back(Spectrum::Constant(3, from));
    fade.to.push_back(Spectrum::Constant(3, to));
  }
  fade.fade = {2.0, 4.0, 9.0};
  fade.wait = 1.0;
  fade.seconds = 5.0;
  std::set<Factors> states;
  for (const double second : {0.0, 1.0, 1.5, 2.9, 3.0, 4.0, 4.999, 5.0, 7.0}) {
    const std::vector<FadeShare> shares = shares_at(fade, second);
    const std::vector<Spectrum> expected = scales_at(fade, second);
    double sum = 0.0;
    std::vector<Spectrum> mean(3, Spectrum::Zero(3));
    for (const FadeShare& each : shares) {
      EXPECT_GT(each.share, 0.0) << second;
      sum += each.share;
      states.insert(factors(each.scales));
      for (std::size_t c = 0; c < 3; ++c) {
        mean[c] += static_cast<float>(each.share) * each.scales[c];
      }
    }
    EXPECT_NEAR(sum, 1.0, 3.0 * 0x1p-53) << second;  // three roundings below 1
    for (std::size_t c = 0; c < 3; ++c) {
      // Six roundings of floats of at most 1.
      EXPECT_LT((mean[c] - expected[c]).abs().maxCoeff(), 6 * 0x1p-24f) << second;
    }
  }
  EXPECT_EQ(states,
            (std::set<Factors>{{0.0f, 1.0f, 0.5f}, {1.0f, 1.0f, 0.5f}, {1.0f, 0.25f, 0.5f}}));
}

TEST(CueSequence, CuesFollowEachOtherAfterFadeAndHold) {
  const RadiositySolution s = stage();
  const auto all = [](float factor) {
    return std::vector<Spectrum>(3, Spectrum::Constant(3, factor));
  };
  const Cue cues[] = {{.name = "a", .scales = all(0.1f), .fade_down = 4.0, .hold = 1.0},
                      {.name = "b", .scales = all(0.7f), .fade_up = 2.0, .wait = 3.0},
                      {.name = "c", .scales = all(0.0f)}};
  const CueSequence sequence(s, cues);
  EXPECT_EQ(sequence.seconds(), 10.0);
  EXPECT_EQ(factors(sequence.at(0.0)), (Factors{1.0f, 1.0f, 1.0f}));
  for (const double second : {4.0, 5.0, 8.0}) {
    EXPECT_EQ(factors(sequence.at(second)), (Factors{0.1f, 0.1f, 0.1f})) << second;
  }
  // Half of the way from 0.1 to 0.7, each with a rounding of 2^-25 relative, and two of the sum.
  EXPECT_NEAR(sequence.at(9.0)[0][0], 0.4f, 4 * std::exp2(-25.0));
  EXPECT_EQ(factors(sequence.at(10.0)), (Factors{0.0f, 0.0f, 0.0f}));
  EXPECT_EQ(factors(sequence.at(11.0)), (Factors{0.0f, 0.0f, 0.0f}));
}

}  // namespace
}  // namespace lightwell::cues_test
