// Exported glTF with lightmaps, and their EXR files, read back.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/errors.h"
#include "scene/io/read_scene.h"
#include "tests/viewer/channel_room.h"
#include "tests/viewer/glb_file.h"
#include "tests/viewer/lit_sides.h"
#include "viewer/export/export.h"

namespace lightwell::export_lightmap_test {
namespace {

using Json = nlohmann::json;

class ExportLightmap : public testing::Test {
 protected:
  LightmapReport write(const SolvedScene& solved, const Scene& scene,
                       const LightmapOptions& options) const {
    return write_lightmapped_gltf(folder / "room.glb", bake_model(solved, scene), solved, scene,
                                  options);
  }
  TemporaryFolder folder;
};

TEST_F(ExportLightmap, OurReaderFindsTheRoom) {
  write(solved_box(), box_scene(), {.size = 64});
  const Scene scene = read_scene(folder / "room.glb");
  double area = 0.0;
  for (const Surface& surface : scene.surfaces) area += surface_area(surface);
  EXPECT_NEAR(area, 5 * 4.0, 1e-12);
  EXPECT_EQ(scene.cameras.size(), 1u);
}

/// Half floats have 11 binary digits.
TEST_F(ExportLightmap, TheDataAreTheAtlas) {
  const SolvedScene solved = solved_box();
  const Scene scene = box_scene();
  const LightmapOptions options{.size = 64};
  const LightmapReport made = write(solved, scene, options);
  ASSERT_EQ(made.files, lightmap_files(folder / "room.glb", 1));
  EXPECT_EQ(made.files[0].filename(), "room-lightmap-1.exr");
  EXPECT_EQ(made.charts, 5);
  const BakedModel model = bake_model(solved, scene);
  const LightmapLayout layout = lay_out_lightmap(model, solved.mesh, options);
  const LightmapAtlas atlas = paint_atlas(layout, 0, model, solved, scene, options);
  EXPECT_EQ(made.coverage, static_cast<double>(atlas.covered) / (64 * 64));
  const Image read = read_exr(made.files[0], ExrChannels::all);
  EXPECT_TRUE(((read.radiance - atlas.irradiance).abs() <= 0x1p-11f * atlas.irradiance).all());
  const std::vector<std::string> layers = {"illuminance.Y", "radiosity.B", "radiosity.G",
                                           "radiosity.R"};
  ASSERT_EQ(read.layers.names, layers);
  for (Eigen::Index i = 0; i < atlas.irradiance.rows(); ++i) {
    const double lux = luminous(rgb_bands(), atlas.irradiance.row(i).transpose());
    EXPECT_NEAR(read.layers.values(i, 0), lux, 1e-5 * lux);
    EXPECT_NEAR(read.layers.values(i, 3), atlas.radiosity(i, 0), 0x1p-11 * atlas.radiosity(i, 0));
  }
}

/// Light beyond the range of half floats is written as 32-bit floats.
TEST_F(ExportLightmap, VeryBrightLightIsWrittenInFull) {
  SolvedScene solved = solved_box();
  solved.solution.direct_irradiance *= 1e5f;
  const LightmapReport made = write(solved, box_scene(), {.size = 64});
  EXPECT_GT(read_exr(made.files[0]).radiance.maxCoeff(), 2e5f);
}

/// The texture coordinates of a face's corners lie in the face's chart and span the chart.
/// TEXCOORD_0 exists because glTF numbers the sets from 0.
TEST_F(ExportLightmap, CoordinatesLeadIntoTheTexture) {
  write(solved_box(), box_scene(), {.size = 64});
  const Glb glb = parse_glb(content_of(folder / "room.glb"));
  for (const Json& mesh : glb.json["meshes"]) {
    const Json& primitive = mesh["primitives"][0];
    const Json& attributes = primitive["attributes"];
    EXPECT_EQ(attributes["TEXCOORD_0"], attributes["TEXCOORD_1"]);
    EXPECT_EQ(attributes.count("COLOR_0"), 0u);  // it would darken the texture
    const std::vector<float> uv = floats(glb, attributes["TEXCOORD_1"], 2);
    ASSERT_EQ(uv.size(), 8u);
    const Json& material = glb.json["materials"][primitive["material"].get<int>()];
    const Json& texture = material["pbrMetallicRoughness"]["baseColorTexture"];
    EXPECT_EQ(texture["texCoord"], 1);
    EXPECT_EQ(texture["index"], 0);
    // Corners of a wall lie on texel boundaries.
    for (const float x : uv) EXPECT_EQ(64 * x, std::round(64 * x));
  }
  const Json& view = glb.json["bufferViews"][glb.json["images"][0]["bufferView"].get<int>()];
  EXPECT_EQ(glb.binary.substr(view["byteOffset"].get<std::size_t>(), 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(glb.json["asset"]["extras"]["lightmap"]["files"][0], "room-lightmap-1.exr");
}

/// The files of the channels have the light of each lamp at scale 1 in the same charts, so that an
/// engine can dim lamps. The sum of channels times scales is the lightmap, to the precision of
/// float sums and of half floats in files.
TEST_F(ExportLightmap, ChannelsAddUpToAllLight) {
  const Scene scene = channel_room();
  const SolvedScene solved = relit(solve_by_channel(scene), {"0.5", "off"});
  for (const Pass pass : {Pass::interpolate, Pass::direct}) {
    const LightmapReport made =
        write(solved, scene, {.size = 64, .pass = pass, .per_channel = true});
    ASSERT_EQ(made.files.size(), 3u);
    EXPECT_EQ(made.files[1].filename(), "room-lightmap-1-desk.exr");
    EXPECT_EQ(made.files[2].filename(), "room-lightmap-1-panel.exr");
    const BandArray all = read_exr(made.files[0]).radiance;
    const BandArray desk = read_exr(made.files[1]).radiance;
    EXPECT_GT(read_exr(made.files[2]).radiance.maxCoeff(), 0.0f) << "off, and there all the same";
    EXPECT_LT((all - 0.5f * desk).abs().maxCoeff(), 2e-3f * all.maxCoeff());
    const Json extras =
        parse_glb(content_of(folder / "room.glb")).json["asset"]["extras"]["lightmap"]["channels"];
    EXPECT_EQ(extras[0]["name"], "desk");
    EXPECT_EQ(extras[0]["scale"], Json::array({0.5, 0.5, 0.5}));
    EXPECT_EQ(extras[1]["files"], Json::array({"room-lightmap-1-panel.exr"}));
  }
}

TEST_F(ExportLightmap, ChannelsThatThereAreNotAreAskedFor) {
  const std::string message = message_of<InputError>(
      [&] { write(solved_box(), box_scene(), {.size = 64, .per_channel = true}); });
  EXPECT_TRUE(says(message, "--channels per-luminaire"));
  EXPECT_EQ(folder.file_count(), 0);
}

TEST_F(ExportLightmap, FilesOfChannelsHaveNamesOfTheirOwn) {
  const std::vector<std::string> names = {"desk lamp", "desk/lamp", "Decke-2"};
  const auto file = [&](int c) {
    return channel_lightmap_files("a/room.glb", names, c, 1).front().generic_string();
  };
  EXPECT_EQ(file(0), "a/room-lightmap-1-desk_lamp_1.exr");
  EXPECT_EQ(file(1), "a/room-lightmap-1-desk_lamp_2.exr");
  EXPECT_EQ(file(2), "a/room-lightmap-1-Decke-2.exr");
}

TEST_F(ExportLightmap, KhronosValidatorHasNothingToSay) {
  if (!has_node())
    GTEST_SKIP() << "no node here to run the validator; on Debian: apt install nodejs";
  Scene scene = box_scene();
  scene.materials[0].dielectric = Dielectric{.tint = Spectrum::Ones(3)};
  write(solved_box(), scene, {.size = 64});
  EXPECT_TRUE(is_valid_gltf(folder, folder / "room.glb"));
  const LightmapReport several = write(solved_box(), scene, {.size = 64, .texels_per_metre = 25});
  EXPECT_GT(several.atlases, 1);
  EXPECT_TRUE(is_valid_gltf(folder, folder / "room.glb"));
}

TEST_F(ExportLightmap, AFileThatCannotBeWrittenIsNamedAndLeavesNothing) {
  const BakedModel model = bake_model(solved_box(), box_scene());
  const auto path = folder / "nowhere" / "room.glb";
  EXPECT_TRUE(says(message_of<std::runtime_error>([&] {
                     write_lightmapped_gltf(path, model, solved_box(), box_scene(), {.size = 64});
                   }),
                   (folder / "nowhere" / "room-lightmap-1.exr").string()));
  EXPECT_EQ(folder.file_count(), 0);
}

}  // namespace
}  // namespace lightwell::export_lightmap_test
