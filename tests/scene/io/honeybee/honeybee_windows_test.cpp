#include <gtest/gtest.h>

#include <string>

#include "scene/errors.h"
#include "scene/io/window_states.h"
#include "tests/scene/io/honeybee/honeybee_models.h"

namespace lightwell::honeybee_windows_test {
namespace {

using namespace honeybee_models;

TEST(HoneybeeWindows, OpeningsWithStatesAreOperatedTogether) {
  json of = model();
  const auto glass = [](const char* name, double t) {
    return json{{"type", "Glass"},
                {"identifier", name},
                {"r_transmissivity", t},
                {"g_transmissivity", t},
                {"b_transmissivity", t}};
  };
  of["properties"]["radiance"]["modifiers"] = {glass("clear", 0.9), glass("tinted", 0.1)};
  const json states = {{"dynamic_group_identifier", "panes"},
                       {"states", {{{"modifier", "clear"}}, {{"modifier", "tinted"}}}}};
  json& south = of["rooms"][0]["faces"][0];
  south["apertures"][0]["properties"]["radiance"] = states;
  south["doors"][0]["properties"]["radiance"] = states;
  const TemporaryFolder folder;
  const Scene scene = read_scene(folder.write("model.hbjson", of.dump()));
  EXPECT_EQ(material_of(scene, "window").name, "clear");
  const OperatedWindows windows = read_windows(scene);
  ASSERT_EQ(windows.groups.size(), 1u);
  const WindowGroup& group = windows.groups[0];
  EXPECT_EQ(group.name, "panes");
  EXPECT_EQ(group.surfaces.size(), 2u);
  ASSERT_EQ(group.states.size(), 2u);
  EXPECT_FALSE(group.states[0].material.has_value());
  ASSERT_TRUE(group.states[1].material.has_value());
  const Material& tinted = windows.materials[static_cast<std::size_t>(*group.states[1].material)];
  EXPECT_EQ(tinted.dielectric->transmissivity[0], 0.1f);
}

TEST(HoneybeeWindows, StatesWithoutModifierHaveThatOfTheirOpening) {
  json of = model();
  of["properties"]["radiance"]["modifiers"] =
      json::array({{{"type", "Plastic"}, {"identifier", "shutter"}, {"r_reflectance", 0.4}}});
  json& window = of["rooms"][0]["faces"][0]["apertures"][0];
  window["properties"]["radiance"] = {
      {"dynamic_group_identifier", "shutters"},
      {"states", {{{"modifier", nullptr}}, {{"modifier", "shutter"}}}}};
  const TemporaryFolder folder;
  Scene scene = read_scene(folder.write("model.hbjson", of.dump()));
  EXPECT_EQ(material_of(scene, "window").name, "generic_exterior_window_vis_0.64");
  OperatedWindows windows = read_windows(scene);
  ASSERT_EQ(windows.groups.size(), 1u);
  EXPECT_EQ(windows.materials.at(0).reflectance[0], 0.4f);
  // The other way round: open with a modifier of the state, closed with that of the opening.
  window["properties"]["radiance"]["modifier"] = "shutter";
  window["properties"]["radiance"]["states"] =
      json::array({{{"modifier", "generic_exterior_window_vis_0.64"}}, {{"modifier", nullptr}}});
  scene = read_scene(folder.write("model.hbjson", of.dump()));
  EXPECT_TRUE(material_of(scene, "window").dielectric.has_value());
  windows = read_windows(scene);
  ASSERT_TRUE(windows.groups.at(0).states.at(1).material.has_value());
  EXPECT_EQ(windows.materials.at(0).reflectance[0], 0.4f);
}

TEST(HoneybeeWindows, StatesOfUndefinedModifiersAreRefused) {
  json of = model();
  of["rooms"][0]["faces"][0]["apertures"][0]["properties"]["radiance"] = {
      {"dynamic_group_identifier", "panes"},
      {"states", {{{"modifier", "generic_exterior_window_vis_0.64"}}, {{"modifier", "misspelt"}}}}};
  const TemporaryFolder folder;
  const Scene scene = read_scene(folder.write("model.hbjson", of.dump()));
  try {
    read_windows(scene);
    FAIL() << "a state of no material was read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("windows 'panes' has the modifier 'misspelt'"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace lightwell::honeybee_windows_test
