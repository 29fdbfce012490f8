// Luminaires in models and pages.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/io/read_scene.h"
#include "tests/viewer/glb_file.h"
#include "tests/viewer/in_browser.h"
#include "tests/viewer/lamp_box.h"
#include "viewer/export/appearance.h"

namespace lightwell::lamps_in_models_test {
namespace {

Scene with_lamp(const Eigen::Vector3d& position) {
  Scene scene = box_scene();
  scene.surfaces.clear();
  scene.lamps = {pendant(position)};
  scene.cameras[0].position = {1, 0.3, 0.3};
  scene.cameras[0].direction = Eigen::Vector3d(0, 0.9, 0.7).normalized();
  scene.cameras[0].up = Eigen::Vector3d(0, 0.7, -0.9).normalized();
  return scene;
}

TEST(LampsInModels, HiddenOnesAreInNoModel) {
  Scene scene = with_lamp({1, 1, 1});
  EXPECT_EQ(bake_model(even_room(), scene).lamp_faces.size(), 7u);
  scene.lamps[0].visible = false;
  EXPECT_TRUE(bake_model(even_room(), scene).lamp_faces.empty());
}

TEST(LampsInModels, ModelsHaveAMeshForEach) {
  Scene scene = with_lamp({0.5, 1, 1});
  scene.lamps.push_back(pendant({1.5, 1, 1}));
  const BakedModel model = bake_model(even_room(), scene);
  const TemporaryFolder folder;
  write_gltf(folder / "room.glb", model);
  const Glb glb = parse_glb(content_of(folder / "room.glb"));
  const std::array names = {"pendant", "pendant 2"};
  for (std::size_t lamp = 0; lamp < 2; ++lamp) {
    const Json& mesh = glb.json["meshes"][6 + lamp];
    EXPECT_EQ(mesh["name"], names[lamp]);
    const Json& primitive = mesh["primitives"][0];
    EXPECT_EQ(glb.json["materials"][primitive["material"].get<int>()]["name"], "luminaires");
    const auto places = floats(glb, primitive["attributes"]["POSITION"], 3);
    for (std::size_t i = 0; i < places.size(); i += 3) {
      EXPECT_NEAR(places[i], scene.lamps[lamp].position.x(), 0.3 + 1e-6);
    }
    const auto colors = floats(glb, primitive["attributes"]["COLOR_0"], 3);
    EXPECT_EQ(*std::ranges::max_element(colors), 1.0f);
  }
  if (has_node()) {
    EXPECT_TRUE(is_valid_gltf(folder, folder / "room.glb"));
  }
  write_obj(folder / "room.obj", model);
  const Scene read = read_scene(folder / "room.obj");
  ASSERT_EQ(read.surfaces.size(), 8u);
  EXPECT_EQ(read.surfaces[7].name, "pendant_2");
  // Six faces of a body and an opening.
  EXPECT_NEAR(surface_area(read.surfaces[7]), 2 * 0.36 + 4 * 0.12 + 0.25, 1e-6);
}

/// A room in which each of two lamps is a channel.
TEST(LampsInModels, ChannelsAddUp) {
  SolvedScene room = even_room();
  Scene scene = with_lamp({0.5, 1, 1});
  scene.lamps.push_back(pendant({1.5, 1, 1}));
  RadiositySolution& s = room.solution;
  s.full_emission = BandArray::Zero(6, 3);
  s.patch_channel.assign(6, -1);
  s.source_channel = {0, 1};
  for (const float share : {0.25f, 0.75f}) {
    LightChannel channel{.name = "lamp", .scale = constant_spectrum(s.bands, 1.0f)};
    channel.direct_irradiance = share * s.direct_irradiance;
    channel.indirect_irradiance = share * s.indirect_irradiance;
    channel.energy = BandEnergy::Zero(4, 3);
    s.channels.push_back(std::move(channel));
  }
  const BakedModel model = bake_model(room, scene);
  ASSERT_EQ(model.lamp_faces.size(), 14u);
  for (const BakedLampFace& face : model.lamp_faces) {
    ASSERT_EQ(face.by_channel.size(), 2u);
    const Eigen::Array3f sum = face.by_channel[0] + face.by_channel[1];
    EXPECT_NEAR(sum[0], face.radiance[0], 1e-5f * face.radiance[0]);
    const bool is_body = face.radiance[0] < 1.0f;
    const float of_first = face.by_channel[0][0] / face.radiance[0];
    EXPECT_NEAR(of_first, is_body ? 0.25f : face.lamp == 0 ? 1.0f : 0.0f, 1e-5f);
  }
}

/// The camera looks up at the opening, 320 times as bright as white, in the middle of the picture.
TEST_P(InBrowser, ThePageShowsLuminaires) {
  constexpr const char* look = R"(<script>
driver.run(async (page, found) => {
  found.lit = driver.pixel(0.5, 0.5);
  page.set_false_colors('luminance');
  found.luminance = driver.pixel(0.5, 0.5);
  page.set_false_colors('illuminance');
  found.illuminance = driver.pixel(0.5, 0.5);
  found.reading = await driver.read(0.5, 0.5);
});
</script>)";
  const Scene scene = with_lamp({1, 1.2, 1});
  const Json found = run(bake_model(even_room(), scene), look);
  ASSERT_FALSE(found.is_null());
  ASSERT_FALSE(found.contains("failed")) << found["failed"];
  EXPECT_EQ(found["errors"], Json::array());
  EXPECT_EQ(found["lit"], (Json{255, 255, 255}));
  // Beyond the scale, the last colour of the palette; through the lamp, 683 lx of 4000.
  EXPECT_EQ(found["luminance"], (Json{255, 237, 84}));
  EXPECT_NE(found["illuminance"], found["luminance"]);
  EXPECT_NEAR(number(found["reading"]["illuminance"]), 683.0, 0.5);
}

}  // namespace
}  // namespace lightwell::lamps_in_models_test
