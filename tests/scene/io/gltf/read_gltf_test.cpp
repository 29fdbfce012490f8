#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/coat.h"
#include "scene/optics.h"
#include "tests/scene/gltf_text.h"
#include "tests/scene/scene_file_test.h"
#include "tests/scene/scene_questions.h"

namespace lightwell::read_gltf_test {
namespace {

using test::area_of;
using test::has_loss;
using test::has_note;
using test::material_called;
using test::mesh_of;
using test::normal_of;
using test::notes_of;

constexpr float pi = std::numbers::pi_v<float>;
const std::string one_node = R"(,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}])";

class Gltf : public test::SceneFileTest {
 protected:
  Scene read(const std::string& text) const { return read_file("it.gltf", text); }
  Material material(const std::string& json) const {
    const Scene scene =
        read(square_gltf(one_node + R"(,"materials":[)" + json + "]", R"(,"material":0)"));
    return scene.materials.at(0);
  }
  void expect_error(const std::string& text, std::initializer_list<const char*> parts) const {
    const std::string message = message_of<InputError>([&] { read(text); });
    EXPECT_NE(message, "") << "nothing was refused";
    for (const char* part : parts) {
      EXPECT_NE(message.find(part), std::string::npos) << part << " is not in: " << message;
    }
  }
};

TEST(GltfFile, StrengthMultipliesEmissionInBothMaterialModels) {
  const Scene scene = read_scene(LIGHTWELL_TEST_DATA "/scene/gltf/14_emission_strength.gltf");
  EXPECT_EQ(scene.surfaces.size(), 18u);
  EXPECT_TRUE(scene.relative_units);
  for (const std::string model : {"pbr", "SpecGloss"}) {
    const Spectrum weak = material_called(scene, model + "EmissiveGray").emission;
    const Spectrum strong = material_called(scene, model + "EmissiveGrayStrength").emission;
    const float factor = model == "pbr" ? 0.9f : 0.3f;
    EXPECT_NEAR(weak[0], pi * factor, 1e-6f);
    EXPECT_NEAR(strong[2], pi * 0.9f * 5.0f, 1e-5f);
    // The picture dims both materials alike.
    const float dim = material_called(scene, model + "EmissiveGrayTexture").emission[0];
    EXPECT_GT(dim, 0.0f);
    EXPECT_LT(dim, pi * 0.9f);
    EXPECT_NEAR(material_called(scene, model + "EmissiveGrayStrengthTexture").emission[0],
                5.0f * dim, 1e-5f * dim * 5.0f);
  }
}

TEST(GltfFile, ClosedBodiesOfClearMaterialKeepTheirIndex) {
  const Scene scene = read_scene(LIGHTWELL_TEST_DATA "/scene/gltf/17_ior.gltf");
  EXPECT_EQ(scene.surfaces.size(), 5u);
  EXPECT_FALSE(material_called(scene, "ior_2_no_transmission").dielectric.has_value());
  ASSERT_TRUE(material_called(scene, "ior_2").dielectric.has_value());
  EXPECT_FLOAT_EQ(material_called(scene, "ior_2").dielectric->index_of_refraction, 2.0f);
  EXPECT_FLOAT_EQ(material_called(scene, "ior_1.45").dielectric->index_of_refraction, 1.45f);
  EXPECT_NEAR(material_called(scene, "ior_2").dielectric->tint[0], 0.8f, 1e-6f);
}

TEST_F(Gltf, NodesPlaceTheirChildren) {
  // The child is scaled by 2, turned by 90 degrees about z, then moved by its parent.
  const Scene scene = read(square_gltf(
      R"(,"scenes":[{"nodes":[0]}],"nodes":[{"translation":[10,0,0],"children":[1,2]},
      {"mesh":0,"name":"turned","rotation":[0,0,0.70710678118654752,0.70710678118654752],"scale":[2,2,2]},
      {"mesh":0,"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,7,1]}])"));
  ASSERT_EQ(scene.surfaces.size(), 2u);
  EXPECT_EQ(scene.surfaces[0].name, "turned");
  EXPECT_LT((mesh_of(scene).vertices.at(1) - Eigen::Vector3d(10, 2, 0)).norm(), 1e-12);
  EXPECT_NEAR(area_of(mesh_of(scene)), 4.0, 1e-12);
  EXPECT_LT((mesh_of(scene, 1).vertices.at(0) - Eigen::Vector3d(10, 0, 7)).norm(), 1e-12);
}

TEST_F(Gltf, MirroredNodesKeepTheirFront) {
  const Scene scene =
      read(square_gltf(R"(,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"scale":[-1,1,1]}])"));
  EXPECT_EQ(normal_of(scene).z(), 1.0);
}

TEST_F(Gltf, StripsAndFansAndPlainCornersAreOneSquare) {
  for (const auto& [primitive, indices] :
       std::vector<std::pair<std::string, std::vector<std::uint16_t>>>{
           {"", {0, 1, 2, 0, 2, 3}},
           {R"(,"mode":5)", {0, 1, 3, 2}},
           {R"(,"mode":6)", {0, 1, 2, 3}}}) {
    const Scene scene = read(square_gltf(one_node, primitive, indices));
    EXPECT_EQ(mesh_of(scene).facets.size(), 2u) << primitive;
    EXPECT_NEAR(area_of(mesh_of(scene)), 1.0, 1e-12) << primitive;
    for (const Facet& facet : mesh_of(scene).facets) {
      EXPECT_EQ(facet_normal(mesh_of(scene), facet).z(), 1.0) << primitive;
    }
  }
}

TEST_F(Gltf, BinaryFilesSayTheSame) {
  const std::string json = square_gltf(one_node);
  const Scene text = read(json);
  EXPECT_EQ(scene_hash(read_scene(folder.write("it.glb", glb(json)))), scene_hash(text));
}

// The GGX parameter alpha is the square of glTF's roughness.
TEST_F(Gltf, MetalsAreGlossyAndOnlyTheRoughestDiffuse) {
  const Material smooth = material(
      R"({"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.6,0.7,1],"metallicFactor":1,"roughnessFactor":0.1}})");
  EXPECT_FLOAT_EQ(smooth.specular[0], 0.5f);
  EXPECT_FLOAT_EQ(smooth.reflectance[0], 0.0f);
  EXPECT_FLOAT_EQ(smooth.specular_roughness, 0.01f);
  const Material rough = material(
      R"({"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.6,0.7,1],"metallicFactor":1,"roughnessFactor":0.9}})");
  EXPECT_FLOAT_EQ(rough.reflectance[2], 0.7f);
  EXPECT_FALSE(rough.is_specular());
}

// A dielectric mirrors ((n - 1) / (n + 1))^2 of steep light and keeps the rest for its base.
TEST_F(Gltf, DielectricsHaveACoatUnlessTheyAreRough) {
  const std::string base = R"({"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.5,0.5,1],
      "metallicFactor":0,"roughnessFactor":)";
  const Material tile = material(base + R"(0.3},"extensions":{"KHR_materials_ior":{"ior":1.4},
      "KHR_materials_specular":{"specularFactor":0.5}}})");
  ASSERT_TRUE(tile.coat);
  EXPECT_FLOAT_EQ(tile.coat->index_of_refraction, 1.4f);
  EXPECT_FLOAT_EQ(tile.specular[0], 0.5f);
  EXPECT_FLOAT_EQ(tile.specular_roughness, 0.09f);
  EXPECT_NEAR(tile.reflectance[0], 0.5 * (1.0 - 0.5 * CoatedBase(tile).mean_mirrored()), 1e-6);
  const Material plaster = material(base + "0.9}}");
  EXPECT_FALSE(plaster.coat);
  EXPECT_FLOAT_EQ(plaster.reflectance[0], 0.5f);
  const Material lacquer = material(base + R"(0.9},"extensions":{"KHR_materials_clearcoat":
      {"clearcoatFactor":1,"clearcoatRoughnessFactor":0.1}}})");
  ASSERT_TRUE(lacquer.coat);
  EXPECT_FLOAT_EQ(lacquer.specular_roughness, 0.01f);
}

// glTF 2.0, B.3.5 and KHR_materials_specular: f = (1 - s F) base / pi + s F at the mirror's angle,
// so that the albedo for light from one direction is base + s F (1 - base), F by Fresnel's
// equations of a smooth surface. Spectra are floats.
TEST_F(Gltf, AlbedosOfDielectricsAreThoseOfTheSpecification) {
  for (const float s : {1.0f, 0.3f}) {
    const Material tile = material(R"({"pbrMetallicRoughness":{"baseColorFactor":[0.5,1,0.1,1],
        "metallicFactor":0,"roughnessFactor":0},"extensions":{"KHR_materials_specular":
        {"specularFactor":)" + std::to_string(s) +
                                   "}}}");
    const CoatedBase coated(tile);
    for (const double cosine : {1.0, 0.6, 0.1}) {
      const double F = fresnel_reflectance(cosine, 1.5);
      for (const int band : {0, 1, 2}) {
        const double base = std::array{0.5, 1.0, 0.1}[static_cast<std::size_t>(band)];
        const double albedo = double{tile.reflectance[band]} * coated.factor(cosine) +
                              double{tile.specular[band]} * F;
        EXPECT_NEAR(albedo, base + double{s} * F * (1.0 - base), 1e-6) << s << " " << cosine;
      }
    }
  }
}

TEST_F(Gltf, SheetsShineToBothSidesWhereTheyAreDoubleSided) {
  const std::string shines = R"("emissiveFactor":[1,1,1])";
  EXPECT_TRUE(material("{\"doubleSided\":true," + shines + "}").emits_both_sides);
  const Material front = material("{" + shines + "}");
  EXPECT_FALSE(front.emits_both_sides);
  EXPECT_TRUE(front.one_sided);
  EXPECT_FLOAT_EQ(front.emission[0], pi);
}

TEST_F(Gltf, ClearSheetsAreThinPanesUnlessTheyHaveAThickness) {
  const std::string base =
      R"({"pbrMetallicRoughness":{"baseColorFactor":[0.5,1,1,1],"metallicFactor":0,"roughnessFactor":0},
      "extensions":{"KHR_materials_transmission":{"transmissionFactor":1})";
  const Material pane = material(base + "}}");
  ASSERT_TRUE(pane.dielectric.has_value());
  EXPECT_TRUE(pane.dielectric->thin);
  EXPECT_FLOAT_EQ(pane.dielectric->index_of_refraction, 1.5f);
  EXPECT_FLOAT_EQ(pane.dielectric->tint[0], 0.5f);
  // Transmittance is 1/2 after 1 m and 1/4 after 2 m, so 1/2 for each crossing.
  const Material solid = material(base + R"(,"KHR_materials_ior":{"ior":1.3},"KHR_materials_volume":
      {"thicknessFactor":2,"attenuationDistance":1,"attenuationColor":[0.5,0.5,0.5]}}})");
  ASSERT_TRUE(solid.dielectric.has_value());
  EXPECT_FALSE(solid.dielectric->thin);
  EXPECT_FLOAT_EQ(solid.dielectric->index_of_refraction, 1.3f);
  EXPECT_NEAR(solid.dielectric->tint[1], 0.5, 1e-6);
  EXPECT_NEAR(solid.dielectric->tint[0], 0.25, 1e-6);
}

// Half of the light that the base scatters leaves the back, in the colour of the transmission.
TEST_F(Gltf, SheetsPassLightDiffusely) {
  const std::string paper = R"({"pbrMetallicRoughness":{"baseColorFactor":[0.8,0.6,0.4,1],
      "metallicFactor":0,"roughnessFactor":1},"extensions":{"KHR_materials_diffuse_transmission":
      {"diffuseTransmissionFactor":0.5,"diffuseTransmissionColorFactor":[1,0.5,0.25]}}})";
  const Material sheet = material(paper);
  EXPECT_FLOAT_EQ(sheet.reflectance[0], 0.4f);
  EXPECT_FLOAT_EQ(sheet.reflectance[2], 0.2f);
  EXPECT_FLOAT_EQ(sheet.transmittance[0], 0.5f);
  EXPECT_FLOAT_EQ(sheet.transmittance[2], 0.125f);
  EXPECT_FALSE(sheet.one_sided || sheet.passes_straight());
  EXPECT_FALSE(material(R"({"pbrMetallicRoughness":{"metallicFactor":1},
      "extensions":{"KHR_materials_diffuse_transmission":{"diffuseTransmissionFactor":0.5}}})")
                   .is_translucent());
}

// Two fifths of the light pass a sheet of the base colour; the coat takes its share of all.
TEST_F(Gltf, SheetsThatArePartlyClearKeepTheirShare) {
  const auto sheet = [&](const std::string& roughness) {
    return material(
        R"({"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.5,0.5,1],"metallicFactor":0,
        "roughnessFactor":)" +
        roughness + R"(},"extensions":{"KHR_materials_transmission":{"transmissionFactor":0.4}}})");
  };
  const Material foil = sheet("0.2"), frosted = sheet("0.9");
  ASSERT_TRUE(foil.coat);
  const auto kept = static_cast<float>(1.0 - CoatedBase(foil).mean_mirrored());
  EXPECT_FLOAT_EQ(foil.regular_transmittance[0], kept * 0.2f);
  EXPECT_FLOAT_EQ(foil.reflectance[0], kept * 0.3f);
  EXPECT_FLOAT_EQ(frosted.transmittance[0], 0.2f);
  EXPECT_FALSE(frosted.passes_straight());
}

TEST_F(Gltf, BlendedAlphaLetsTheRestThrough) {
  const auto base = [](const std::string& mode, double alpha) {
    return R"({"alphaMode":")" + mode + R"(","emissiveFactor":[0,0,0],"pbrMetallicRoughness":{
        "metallicFactor":0,"baseColorFactor":[0.8,0.8,0.8,)" +
           std::to_string(alpha) + "]}}";
  };
  const Material gauze = material(base("BLEND", 0.25));
  EXPECT_FLOAT_EQ(gauze.reflectance[0], 0.2f);
  EXPECT_FLOAT_EQ(gauze.regular_transmittance[0], 0.75f);
  EXPECT_FALSE(gauze.one_sided);
  EXPECT_FALSE(material(base("BLEND", 1.0)).passes_straight());
  EXPECT_FALSE(material(base("OPAQUE", 0.25)).passes_straight());
  EXPECT_FALSE(material(base("MASK", 0.75)).passes_straight());
  EXPECT_FLOAT_EQ(material(base("MASK", 0.25)).regular_transmittance[0], 1.0f);  // below the cutoff
  const Material lamp = material(
      R"({"alphaMode":"BLEND","emissiveFactor":[1,1,1],"pbrMetallicRoughness":{
      "baseColorFactor":[1,1,1,0.5]}})");
  EXPECT_FLOAT_EQ(lamp.emission[0], 0.5f * pi);
  EXPECT_FALSE(lamp.passes_straight());
}

// A square of blended alpha 0.5 times that of a picture of the tests' data.
std::string blended_gltf(const char* picture) {
  const std::string png = content_of(std::string(LIGHTWELL_TEST_DATA "/scene/") + picture);
  return square_gltf(one_node + R"(,"images":[{"uri":"data:image/png;base64,)" + base64(png) +
                         R"("}],"textures":[{"source":0}],"materials":[{"alphaMode":"BLEND",
          "pbrMetallicRoughness":{"metallicFactor":0,"baseColorTexture":{"index":0},
          "baseColorFactor":[0.8,0.8,0.8,0.5]}}])",
                     R"(,"material":0)");
}

TEST_F(Gltf, PicturesOfBlendedAlphaCutHoles) {
  const Scene scene = read(blended_gltf("two-pixels.png"));
  const Material& leaf = scene.materials.at(0);
  ASSERT_TRUE(leaf.mask);
  EXPECT_FLOAT_EQ(leaf.mask->cutoff, 0.5f);
  EXPECT_FLOAT_EQ(leaf.regular_transmittance[0], 0.5f);
  EXPECT_FLOAT_EQ(leaf.texture.value().factor[0], 0.4f);
}

// square_gltf() has no texture coordinates, which leaves the material's relief as it is.
TEST_F(Gltf, NormalMapsAreRelief) {
  const auto relief = [&](const char* picture, const std::string& use) {
    const std::string png = content_of(std::string(LIGHTWELL_TEST_DATA "/scene/") + picture);
    return read(square_gltf(one_node + R"(,"images":[{"uri":"data:image/png;base64,)" +
                                base64(png) + R"("}],"textures":[{"source":0}],"materials":[{
          "pbrMetallicRoughness":{"metallicFactor":0},"normalTexture":{"index":0)" +
                                use + "}}]",
                            R"(,"material":0)"));
  };
  const Scene scene = relief("normals.png", R"(,"scale":0.5,"extensions":{
          "KHR_texture_transform":{"scale":[2,3]}})");
  ASSERT_TRUE(scene.materials.at(0).relief);
  EXPECT_EQ(scene.materials[0].relief->scale, 0.5);
  EXPECT_NEAR(scene.materials[0].relief->steepest, 76.0 / 102.0, 1e-4);
  EXPECT_EQ(scene.materials[0].relief->slopes.placement(1, 1), 3.0);
  EXPECT_FALSE(relief("heights.png", "").materials.at(0).relief);
  EXPECT_FALSE(relief("normals.png", R"(,"scale":1e9)").materials.at(0).relief);
}

// Two texels of alpha 0.2 and 0.6: neither clear nor opaque.
TEST_F(Gltf, PicturesOfGauzeCountByTheirMeanAlpha) {
  const Scene scene = read(blended_gltf("gauze.png"));
  const Material& gauze = scene.materials.at(0);
  EXPECT_FALSE(gauze.mask);
  // Texels have 16 bits, of the square root: steps of 2e-5 here.
  EXPECT_NEAR(gauze.regular_transmittance[0], 1.0f - 0.5f * 0.4f, 2e-5f);
}

TEST_F(Gltf, PicturesWithinTheFileBecomeTheirMean) {
  const std::string png = content_of(LIGHTWELL_TEST_DATA "/scene/two-pixels.png");
  const auto color = [&](const char* mode) {
    const Scene scene = read(square_gltf(
        one_node + R"(,"images":[{"uri":"data:image/png;base64,)" + base64(png) +
            R"("}],"textures":[{"source":0}],"materials":[{"alphaMode":")" + mode +
            R"(","pbrMetallicRoughness":{"metallicFactor":0,"baseColorTexture":{"index":0},
            "baseColorFactor":[0.8,0.8,0.8,1]}}])",
        R"(,"material":0)"));
    return scene.materials.at(0).reflectance[0];
  };
  EXPECT_FLOAT_EQ(color("OPAQUE"), 0.4f);
  EXPECT_FLOAT_EQ(color("MASK"), 0.8f);  // the black half is transparent
}

// tan(h/2) = aspect tan(v/2)
TEST_F(Gltf, CamerasLookAlongTheirMinusZ) {
  const Scene scene = read(square_gltf(
      R"(,"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0},{"camera":0,"translation":[1,2,3]}],
      "cameras":[{"name":"a/b","type":"perspective","perspective":{"yfov":1.0,"aspectRatio":2,"znear":0.1}}])"));
  ASSERT_EQ(scene.cameras.size(), 1u);
  const Camera& camera = scene.cameras[0];
  EXPECT_EQ(camera.name, "a_b");
  EXPECT_NEAR(std::tan(camera.fov_degrees * std::numbers::pi / 360), 2 * std::tan(0.5), 1e-12);
  EXPECT_EQ(camera.width, 2 * camera.height);
  EXPECT_LT((camera.direction - Eigen::Vector3d(0, 0, -1)).norm(), 1e-12);
  EXPECT_LT((camera.position - Eigen::Vector3d(1, 2, 3)).norm(), 1e-12);
}

TEST_F(Gltf, OrthographicCamerasHaveTheirWidth) {
  const Scene scene = read(square_gltf(
      R"(,"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0},{"camera":0,"scale":[2,2,2]}],
      "cameras":[{"name":"plan","type":"orthographic","orthographic":{"xmag":3,"ymag":2,
      "znear":0.5,"zfar":100}}])"));
  const Camera& camera = scene.cameras.at(0);
  EXPECT_EQ(camera.projection, Projection::orthographic);
  EXPECT_DOUBLE_EQ(camera.view_width, 12.0);  // 2 xmag, scaled
  EXPECT_DOUBLE_EQ(camera.near_distance, 1.0);
  EXPECT_EQ(camera.width, 768);
  EXPECT_EQ(camera.height, 512);
}

TEST_F(Gltf, PicturesAreNotMirrored) {
  const auto with_scale = [&](const std::string& scale) {
    return read(
        square_gltf(R"(,"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0},{"camera":0,"scale":)" +
                    scale + R"(}],"cameras":[{"name":"eye","type":"perspective",
                            "perspective":{"yfov":1.0,"znear":0.1}}])"));
  };
  const Scene mirrored = with_scale("[-1,1,1]");
  EXPECT_LT((mirrored.cameras.at(0).up - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_TRUE(has_note(mirrored, "turned the right way round: 'eye'"));
  EXPECT_FALSE(has_note(with_scale("[1,1,1]"), "turned the right way round"));
}

TEST_F(Gltf, SurfacesOfOneNameAreNumbered) {
  const Scene scene = read(square_gltf(R"(,"scenes":[{"nodes":[0,1,2]}],"nodes":[
      {"mesh":0,"name":"lamp"},{"mesh":0,"name":"lamp 2"},{"mesh":0,"name":"lamp"}])"));
  std::vector<std::string> names;
  for (const Surface& surface : scene.surfaces) names.push_back(surface.name);
  EXPECT_EQ(names, (std::vector<std::string>{"lamp", "lamp 2", "lamp 3"}));
}

TEST_F(Gltf, WhatIsNotUsedIsNamed) {
  const Scene scene = read(square_gltf(
      one_node +
      R"(,"extensionsUsed":["KHR_lights_punctual","ACME_fur"],"animations":[{"name":"spin"}],
      "extensions":{"KHR_lights_punctual":{"lights":[{"name":"bulb","type":"point"}]}})"));
  for (const char* name : {"'bulb'", "'ACME_fur'", "'spin'", "the scene is dark"}) {
    EXPECT_TRUE(has_note(scene, name)) << name;
  }
}

// The square's fourth vertex, which its second triangle alone has, begins at byte 36.
TEST_F(Gltf, AVertexWithoutNumbersCostsItsTrianglesAlone) {
  std::string nan = square_gltf(one_node);
  nan.replace(nan.find("base64,") + 7 + 36 / 3 * 4, 6, "AADAf/");  // a quiet nan, 0x7fc00000
  const Scene scene = read_file("it.gltf", nan);
  EXPECT_EQ(std::get<PolygonMesh>(scene.surfaces.at(0).shape).facets.size(), 1u);
  ASSERT_EQ(scene.losses.size(), 1u);
  EXPECT_NE(scene.losses[0].find("vertex 3 of meshes[0].primitives[0]"), std::string::npos)
      << scene.losses[0];
}

TEST_F(Gltf, MistakesAreToldWithTheirPlace) {
  expect_error("{\n\"asset\":{\"version\":\"2.0\"},\n\"nodes\":[}", {"it.gltf:3:", "JSON"});
  expect_error(R"({"asset":{"version":"1.0"}})", {"version '1.0'"});
  expect_error(square_gltf(R"(,"scenes":[{"nodes":[4]}],"nodes":[{"mesh":0}])"),
               {"nodes[4]", "only 1"});
  expect_error(square_gltf(R"(,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":9}])"),
               {"nodes[0]", "meshes[9]"});
  expect_error(square_gltf(one_node, "", {0, 1, 4}),
               {"accessors[1]", "index 2 is 4", "4 vertices"});
  expect_error(square_gltf(one_node, "", {0, 1}), {"no multiple of three"});
  expect_error(square_gltf(one_node, R"(,"mode":9)"), {"mode 9"});
  expect_error(
      square_gltf(R"(,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"scale":[1e308,1e308,1e308]}])"),
      {"it.gltf"});
  expect_error(square_gltf(R"(,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"scale":[1,1]}])"),
               {"nodes[0]", "'scale' has 2 numbers"});
  expect_error(square_gltf(one_node, R"(,"extensions":{"KHR_draco_mesh_compression":{}})"),
               {"KHR_draco_mesh_compression", "lacks 'bufferView'"});
  std::string huge = square_gltf(one_node);
  huge.replace(huge.find("\"count\":4"), 9, "\"count\":9007199254740991");
  expect_error(huge, {"accessors[0]", "do not fit"});
  std::string nan = square_gltf(one_node);
  nan.replace(nan.find("base64,") + 7, 6, "AADAf/");  // the first float becomes 0x7fc00000
  expect_error(nan, {"meshes[0].primitives[0]", "finite"});
  std::string gone = square_gltf(one_node);
  const std::size_t data = gone.find("data:");
  gone.replace(data, gone.find('"', data) - data, "gone%20away.bin");
  expect_error(gone, {"buffers[0]", "gone away.bin", "no such file"});
  expect_error(std::string(200000, '['), {"JSON"});
  expect_error("glTF", {"cut off"});
}

TEST_F(Gltf, PartsThatCannotBeUsedAreLeftOutWithTheirPlace) {
  const auto noted = [&](const std::string& text, std::initializer_list<const char*> parts) {
    const Scene scene = read(text);
    EXPECT_EQ(scene.surfaces.size(), 1u);
    for (const char* part : parts) {
      EXPECT_TRUE(says(notes_of(scene), part));
      EXPECT_TRUE(has_loss(scene, part));
    }
  };
  noted(square_gltf(
            R"(,"scenes":[{"nodes":[0]}],"nodes":[{"children":[1]},{"mesh":0,"children":[0]}])"),
        {"nodes[0]", "tree"});
  noted(square_gltf(
            R"(,"scenes":[{"nodes":[0,1,7,2]}],"nodes":[{"mesh":0},{"mesh":9},{"camera":3}])"),
        {"nodes[7]", "meshes[9]", "cameras[3]"});
  noted(square_gltf(one_node, R"(,"material":3)"), {"materials[3]"});
  noted(square_gltf(one_node + R"(,"materials":[{"emissiveFactor":[-1,0,0]}])", R"(,"material":0)"),
        {"materials[0]", "negative"});
  for (const std::string uri : {"gone.png", "data:image/png;base64,iVBORw0KGgo="}) {
    noted(square_gltf(one_node + R"(,"images":[{"uri":")" + uri +
                          R"("}],"textures":[{"source":0}],"materials":[{"name":"cloth",
              "pbrMetallicRoughness":{"metallicFactor":0,"baseColorTexture":{"index":0}}}])",
                      R"(,"material":0)"),
          {"Pictures that are missing or damaged became a grey of 0.5: 'cloth'", "images[0]"});
  }
  // A second mesh whose accessor has no data, as one of a compressed file.
  std::string half = square_gltf(R"(,"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0},{"mesh":1}])");
  half.replace(half.find("\"meshes\":["), 10,
               "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"extensions\":"
               "{\"KHR_draco_mesh_compression\":{}}}]},");
  noted(half, {"Meshes that cannot be read were left out: 'meshes[0].primitives[0]'"});
}

}  // namespace
}  // namespace lightwell::read_gltf_test
