#include "radiosity/solution/emitter_channels.h"

#include <gtest/gtest.h>

#include "scene/errors.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::emitter_channels_test {
namespace {

using Patterns = std::vector<ChannelPattern>;
using Names = std::vector<std::string>;

// Emitters: "desk 1", "desk 2" (material "bulb"), "panel" (material "tube"). "desk top" is dark.
Scene office() {
  Scene scene;
  const int dark = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  const std::vector<Eigen::Vector3d> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const auto emitting = [&](const char* name) {
    Material material = test::diffuse(scene.bands, 0.0f, 1.0f);
    material.name = name;
    return test::add_material(scene, material);
  };
  const int bulb = emitting("bulb"), tube = emitting("tube");
  test::add_polygon(scene, "desk top", dark, square);
  test::add_polygon(scene, "desk 1", bulb, square);
  test::add_polygon(scene, "panel", tube, square);
  test::add_polygon(scene, "desk 2", bulb, square);
  return scene;
}

std::string refusal(const Patterns& patterns) {
  try {
    channels_by_pattern(office(), patterns);
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing is wrong";
}

TEST(EmitterChannels, PatternsMatchSurfacesAndMaterialsThatEmit) {
  const EmitterChannels by_surface =
      channels_by_pattern(office(), Patterns{{"up", "panel"}, {"desk", "desk ?"}});
  EXPECT_EQ(by_surface.names, (Names{"up", "desk"}));
  EXPECT_EQ(by_surface.of_surface, (std::vector<int>{-1, 1, 0, 1}));
  const EmitterChannels by_material = channels_by_pattern(office(), Patterns{{"a", "bul*"}});
  EXPECT_EQ(by_material.names, (Names{"a", "rest"}));
  EXPECT_EQ(by_material.of_surface, (std::vector<int>{-1, 0, 1, 0}));
}

TEST(EmitterChannels, SeveralPatternsMayMakeOneChannel) {
  const EmitterChannels channels =
      channels_by_pattern(office(), Patterns{{"a", "desk 1"}, {"a", "panel"}, {"a", "pan*"}});
  EXPECT_EQ(channels.names, (Names{"a", "rest"}));
  EXPECT_EQ(channels.of_surface, (std::vector<int>{-1, 0, 0, 1}));
}

TEST(EmitterChannels, WhatIsClaimedByHandIsNoRest) {
  EXPECT_EQ(channels_by_pattern(office(), Patterns{{"all", "*"}}).names, (Names{"all"}));
}

TEST(EmitterChannels, PerLuminaireThereIsOneForEachName) {
  const EmitterChannels channels = channels_per_luminaire(office());
  EXPECT_EQ(channels.names, (Names{"desk 1", "panel", "desk 2"}));
  EXPECT_EQ(channels.of_surface, (std::vector<int>{-1, 0, 1, 2}));
}

TEST(EmitterChannels, ByKindThereIsOneForSkySunAndElectricLight) {
  Scene scene = office();
  EXPECT_TRUE(channels_by_kind(scene).empty())
      << "electric light alone has nothing to be apart from";
  scene.lamps.push_back({.name = "spot"});
  scene.sky = Sky{.scale = constant_spectrum(scene.bands, 1.0f)};
  const EmitterChannels two = channels_by_kind(scene);
  EXPECT_EQ(two.names, (Names{"sky", "electric"}));
  EXPECT_EQ(two.of_surface, (std::vector<int>{-1, 1, 1, 1}));
  EXPECT_EQ(two.of_source, (std::vector<int>{1, 0}));
  scene.sky->sun = Sun{.irradiance = constant_spectrum(scene.bands, 1.0f)};
  const EmitterChannels three = channels_by_kind(scene);
  EXPECT_EQ(three.names, (Names{"sun", "sky", "electric"}));
  EXPECT_EQ(three.of_source, (std::vector<int>{2, 1, 0}));
}

TEST(EmitterChannels, APatternWithoutEmitterIsRefusedWithTheNearestName) {
  const std::string what = refusal({{"desk", "desk 3"}});
  EXPECT_NE(what.find("'desk 3' matches the name of no emitter"), std::string::npos) << what;
  EXPECT_NE(what.find("Did you mean 'desk 1'?"), std::string::npos) << what;
  const std::string dark = refusal({{"desk", "desk t*"}});
  EXPECT_NE(dark.find("'desk top', which emits no light"), std::string::npos) << dark;
}

TEST(EmitterChannels, AnEmitterInTwoChannelsIsRefused) {
  const std::string what = refusal({{"a", "desk*"}, {"b", "*1"}});
  EXPECT_NE(what.find("emitter 'desk 1' would be in two channels: 'desk*' puts it into 'a' and "
                      "'*1' into 'b'"),
            std::string::npos)
      << what;
}

TEST(EmitterChannels, TooManyAreRefused) {
  Scene scene = office();
  for (int i = 0; i <= most_channels; ++i) {
    test::add_polygon(scene, "lamp " + std::to_string(i), scene.surfaces[1].material,
                      {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}});
  }
  EXPECT_THROW(channels_per_luminaire(scene), InputError);
  EXPECT_EQ(channels_by_pattern(scene, Patterns{{"a", "lamp *"}}).names, (Names{"a", "rest"}));
}

}  // namespace
}  // namespace lightwell::emitter_channels_test
