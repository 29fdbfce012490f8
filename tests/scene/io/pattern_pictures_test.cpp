// Pictures of roughness, metal, coat and opacity of readers.
#include <filesystem>
#include <limits>

#include "scene/coat.h"
#include "scene/facet_textures.h"
#include "scene/material_at.h"
#include "tests/scene/gltf_text.h"
#include "tests/scene/scene_file_test.h"

namespace lightwell::pattern_pictures_test {
namespace {

const std::filesystem::path data = LIGHTWELL_TEST_DATA "/scene";

// Products of a few floats up to 1. Texels of 0 and 1 are exact.
constexpr float rounding = 4 * std::numeric_limits<float>::epsilon();

// two-pixels.png is white on its left, black on its right.
class PatternPictures : public test::SceneFileTest {
 protected:
  PatternPictures() {
    for (const char* name : {"two-pixels.png", "gauze.png"}) {
      std::filesystem::copy(data / name, folder / name);
    }
  }
  Scene plate(const std::string& material) const {
    return read_file("a.toml", "materials.plate = { " + material +
                                   " }\n[[surfaces]]\nname = 'plate'\nmaterial = 'plate'\n"
                                   "polygon = [[0,0,0],[2,0,0],[2,1,0],[0,1,0]]\n"
                                   "uv = [[0,1],[1,1],[1,0],[0,0]]\n");
  }
  // The material of facet 0 at the left or the right of a plate 2 m wide.
  static Material left(const Scene& scene) {
    return FacetTextures(scene).material(0, {0.5, 0.5, 0.0});
  }
  static Material right(const Scene& scene) {
    return FacetTextures(scene).material(0, {1.5, 0.5, 0.0});
  }
  Scene gltf(const std::string& material, const char* picture = "two-pixels.png") const {
    const std::string png = content_of(data / picture);
    const std::string uv = bytes_of<float>({0, 0, 1, 0, 1, 1, 0, 1});
    return read_file("a.gltf",
                     square_gltf(R"(,"scenes":[{"nodes":[0]}],"scene":0,"nodes":[{"mesh":0}],
        "images":[{"uri":"data:image/png;base64,)" +
                                     base64(png) +
                                     R"("}],"samplers":[{"magFilter":9728}],
        "textures":[{"source":0,"sampler":0}],"materials":[)" +
                                     material + "]",
                                 R"(,"material":0)"));
  }
};

TEST_F(PatternPictures, OfNativeFilesWearACoatDownToMetal) {
  const Scene scene = plate(
      "reflectance = 0.4, coat = { ior = 1.5, roughness = 0.2 }, "
      "metal_texture = { file = 'two-pixels.png', filter = 'nearest', reflectance = [0.9, 0.6, "
      "0.3] }");
  const Material metal = left(scene), paint = right(scene);
  EXPECT_EQ(metal.reflectance[0], 0.0f);
  EXPECT_NEAR(metal.coat->bare[2], 0.3f, rounding);
  EXPECT_NEAR(paint.reflectance[0], 0.4f, rounding);
  EXPECT_EQ(paint.coat->bare[0], 0.0f);
  EXPECT_FLOAT_EQ(paint.specular[0], 1.0f);
  EXPECT_FLOAT_EQ(scene.materials[0].coat->bare[0], 0.45f);  // the mean
}

TEST_F(PatternPictures, OfNativeFilesVaryRoughnessCoatAndOpacity) {
  const Scene rough = plate(
      "specular = 0.8, roughness = 0.4, "
      "roughness_texture = { file = 'two-pixels.png', filter = 'nearest' }");
  EXPECT_FLOAT_EQ(left(rough).specular_roughness, 0.4f);
  EXPECT_EQ(right(rough).specular_roughness, 0.0f);
  EXPECT_FLOAT_EQ(left(rough).specular[0], 0.8f);
  const Scene coated = plate(
      "coat = { ior = 1.5, base = 0.5 }, "
      "coat_texture = { file = 'two-pixels.png', filter = 'nearest' }");
  EXPECT_FLOAT_EQ(left(coated).coat->cover, 1.0f);
  EXPECT_EQ(right(coated).specular[0], 0.0f);
  const Scene net =
      plate("reflectance = 0.6, opacity_texture = { file = 'two-pixels.png', filter = 'nearest' }");
  EXPECT_FLOAT_EQ(left(net).reflectance[0], 0.6f);
  EXPECT_FLOAT_EQ(right(net).regular_transmittance[0], 1.0f);
  const Scene glass =
      plate("glass = { ior = 1.5, roughness = 0.3 }, roughness_texture = 'two-pixels.png'");
  ASSERT_TRUE(glass.materials[0].dielectric);
  EXPECT_NEAR(glass.materials[0].dielectric->roughness, 0.15f, rounding);
}

TEST_F(PatternPictures, OfNativeFilesAreRefusedWhereNothingVaries) {
  const auto refused = [&](const std::string& material, const char* why) {
    const std::string message = message_of<InputError>([&] { plate(material); });
    EXPECT_NE(message.find(why), std::string::npos) << message;
  };
  refused("reflectance = 0.5, roughness_texture = 'two-pixels.png'", "spreads what");
  refused("specular = 0.5, metal_texture = 'two-pixels.png'", "bare metal");
  refused("reflectance = 0.5, coat_texture = 'two-pixels.png'", "where a coat lies");
  refused("reflectance = 0.5, translucent_texture = 'two-pixels.png'", "multiplies 'translucent'");
  refused("sides = 'one', opacity_texture = 'two-pixels.png'", "sides is 'one'");
  refused("lumens = 5, opacity_texture = 'two-pixels.png'", "lamps let no light");
  refused("glass = { ior = 1.5 }, coat_texture = 'two-pixels.png'", "where a coat lies");
  refused("glass = { ior = 1.5 }, opacity_texture = 'two-pixels.png'", "contradicts 'glass'");
}

// White texels are metal of roughness 0.5 times the factor, black ones smooth paint.
TEST_F(PatternPictures, OfGltfAreMetalAndPaintUnderACoat) {
  const Scene scene = gltf(R"({"pbrMetallicRoughness":{"baseColorFactor":[0.8,0.4,0.2,1],
      "roughnessFactor":0.5,"metallicRoughnessTexture":{"index":0}}})");
  const Material& m = scene.materials.at(0);
  ASSERT_TRUE(m.pattern);
  const Material metal = material_at(m, values_at(m, {0.25, 0.5}));
  EXPECT_EQ(metal.reflectance[0], 0.0f);
  EXPECT_FLOAT_EQ(metal.coat->bare[1], 0.4f);
  EXPECT_FLOAT_EQ(metal.specular_roughness, 0.25f);
  const Material paint = material_at(m, values_at(m, {0.75, 0.5}));
  const auto mirrored = static_cast<float>(CoatedBase(paint).mean_mirrored());
  EXPECT_NEAR(paint.reflectance[0], 0.8f * (1.0f - mirrored), rounding);
  EXPECT_EQ(paint.specular_roughness, 0.0f);
  // All of it rough: nothing varies that is not diffuse.
  EXPECT_FALSE(gltf(R"({"pbrMetallicRoughness":{"metallicFactor":0,
      "baseColorTexture":{"index":0}}})")
                   .materials.at(0)
                   .pattern);
}

TEST_F(PatternPictures, OfGltfThatHaveOtherCoordinatesCountByTheirMean) {
  const Scene scene = gltf(R"({"pbrMetallicRoughness":{"roughnessFactor":0.5,"metallicFactor":0,
      "baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":0,"texCoord":1}}})");
  EXPECT_FALSE(scene.materials.at(0).pattern);
  EXPECT_FLOAT_EQ(scene.materials.at(0).specular_roughness, 0.0625f);
}

TEST_F(PatternPictures, OfGltfsClearCoatAndBlendedAlpha) {
  const Scene coated = gltf(R"({"pbrMetallicRoughness":{"metallicFactor":0},
      "extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatTexture":{"index":0}}}})");
  const Material& m = coated.materials.at(0);
  ASSERT_TRUE(m.pattern);
  EXPECT_FLOAT_EQ(material_at(m, values_at(m, {0.25, 0.5})).specular[0], 1.0f);
  EXPECT_EQ(material_at(m, values_at(m, {0.75, 0.5})).specular[0], 0.0f);
  // Texels of alpha 0.2 and 0.6, times 0.5.
  const Scene gauze = gltf(R"({"alphaMode":"BLEND","pbrMetallicRoughness":{"metallicFactor":0,
      "baseColorFactor":[1,1,1,0.5],"baseColorTexture":{"index":0}}})",
                           "gauze.png");
  const Material& g = gauze.materials.at(0);
  ASSERT_TRUE(g.pattern && g.pattern->opacity);
  const float one = material_at(g, values_at(g, {0.25, 0.5})).regular_transmittance[0];
  const float other = material_at(g, values_at(g, {0.75, 0.5})).regular_transmittance[0];
  // The square-root code is off by half a step, sqrt(0.6) / 65535, or less where texels are darker.
  constexpr float of_texels = 0.5f * 0.7746f / 65535;  // 5.9e-6
  EXPECT_NEAR(std::min(one, other), 0.7f, of_texels + rounding);
  EXPECT_NEAR(std::max(one, other), 0.9f, of_texels + rounding);
}

TEST_F(PatternPictures, OfMitsubaVaryAlphaMetallicAndOpacity) {
  const auto read = [&](const std::string& bsdf) {
    return read_file("a.xml",
                     "<scene version='3.0.0'><shape type='rectangle'>" + bsdf + "</shape></scene>");
  };
  const std::string bitmap =
      "<string name='filename' value='two-pixels.png'/>"
      "<boolean name='raw' value='true'/></texture>";
  const Scene metal = read(
      "<bsdf type='roughconductor'><string name='material' value='Au'/>"
      "<texture type='bitmap' name='alpha'>" +
      bitmap + "</bsdf>");
  ASSERT_TRUE(metal.materials.at(0).pattern && metal.materials[0].pattern->roughness);
  const Scene worn = read(
      "<bsdf type='principled'><float name='roughness' value='0.4'/>"
      "<texture type='bitmap' name='metallic'>" +
      bitmap + "</bsdf>");
  const Material& m = worn.materials.at(0);
  ASSERT_TRUE(m.pattern && m.pattern->metal);
  EXPECT_NEAR(m.coat->bare[0], 0.25f, rounding);  // half of the base colour 0.5
  EXPECT_NEAR(m.specular_roughness, 0.16f, rounding);
}

TEST_F(PatternPictures, OfMtlFilesVaryRoughnessMetalAndOpacity) {
  folder.write(
      "a.mtl",
      "newmtl plate\nKd 0.5 0.5 0.5\nPr 0.5\nmap_Pm two-pixels.png\nmap_Pr two-pixels.png\n");
  const Scene scene =
      read_file("a.obj",
                "mtllib a.mtl\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                "usemtl plate\nf 1/1 2/2 3/3 4/4\n");
  const Material& m = scene.materials.at(0);
  ASSERT_TRUE(m.pattern && m.pattern->metal && m.pattern->roughness);
  EXPECT_FLOAT_EQ(m.pattern->roughness->factor, 0.25f);
  EXPECT_NEAR(m.coat->bare[0], 0.25f, rounding);
}

}  // namespace
}  // namespace lightwell::pattern_pictures_test
