// Pictures of emission of readers, and the cells of pictures on facets.
#include <algorithm>
#include <numbers>

#include "scene/facet_textures.h"
#include "scene/picture_cells.h"
#include "tests/pictures.h"
#include "tests/scene/gltf_text.h"
#include "tests/scene/scene_file_test.h"

namespace lightwell::emission_picture_test {
namespace {

const std::filesystem::path data = LIGHTWELL_TEST_DATA "/scene";
constexpr float pi = std::numbers::pi_v<float>;
const std::string square =
    "[[surfaces]]\nname = 'screen'\nmaterial = 'screen'\n"
    "polygon = [[0,0,0],[2,0,0],[2,1,0],[0,1,0]]\n";
const std::string uv = "uv = [[0,1],[1,1],[1,0],[0,0]]\n";

// two-pixels.png is white on its left, black on its right. bright.hdr has two pixels side by side,
// of 128.5 / 64 and of half as much.
class PicturesOfLight : public test::SceneFileTest {
 protected:
  PicturesOfLight() {
    std::filesystem::copy(data / "two-pixels.png", folder / "two pixels.png");
    folder.write(
        "bright.hdr",
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x80\x80\x82\x80\x80\x80\x81");
  }
  Scene screen(const std::string& material, const std::string& coordinates = uv) const {
    return read_file("a.toml", "materials.screen = { " + material + " }\n" + square + coordinates);
  }
  // Exitance of facet 0 at a point, first band.
  static float exitance(const Scene& scene, const Eigen::Vector3d& at) {
    return FacetTextures(scene).emission(0, at)[0];
  }
};

// Codes of texels are 65535 times the root of a share, rounded by 1/2 at most.
constexpr float rounding = 1.0f / 65535.0f;

TEST_F(PicturesOfLight, OfNativeFilesMultiplyTheEmission) {
  const Scene scene =
      screen("radiance = 3, emission_texture = { file = 'two pixels.png', filter = 'nearest' }");
  EXPECT_NEAR(exitance(scene, {0.5, 0.5, 0}), 3.0f * pi, rounding);
  EXPECT_EQ(exitance(scene, {1.5, 0.5, 0}), 0.0f);
  EXPECT_NEAR(scene.materials[0].emission[0], 1.5f * pi, rounding);
  EXPECT_NEAR(mean_exitance(scene, scene.surfaces[0])[0], 1.5 * pi, rounding);
}

TEST_F(PicturesOfLight, KeepThePowerOrTheLumensOfTheFile) {
  const std::string picture = "emission_texture = 'two pixels.png', ";
  const Scene watts = screen(picture + "power = [1, 2, 3], emits = 'both'");
  const Eigen::ArrayXd sent = 2.0 * 2.0 * mean_exitance(watts, watts.surfaces[0]);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(sent[k], k + 1.0, rounding);  // the picture is grey
  const Scene lumens = screen(picture + "lumens = 500, colour = [1.0, 0.5, 0.25]");
  const Spectrum front = (2.0 * mean_exitance(lumens, lumens.surfaces[0])).cast<float>();
  EXPECT_NEAR(luminous(lumens.bands, front), 500.0, 500.0 * rounding);
  EXPECT_NEAR(front[2] / front[0], 0.25, rounding);
  // A layout that shows the white half alone halves the factor.
  const Scene half = screen(picture + "lumens = 500", "uv = [[0,1],[0.25,1],[0.25,0],[0,0]]\n");
  EXPECT_NEAR(luminous(half.bands, (2.0 * mean_exitance(half, half.surfaces[0])).cast<float>()),
              500.0, 500.0 * rounding);
}

TEST_F(PicturesOfLight, MayBeBrighterThanWhite) {
  const Scene scene =
      screen("exitance = 2, emission_texture = { file = 'bright.hdr', filter = 'nearest' }");
  // Texels are shares of the brightest.
  constexpr float brightest = 2.0f * 128.5f / 64.0f;
  EXPECT_NEAR(exitance(scene, {0.5, 0.5, 0}), brightest, brightest * rounding);
  EXPECT_NEAR(exitance(scene, {1.5, 0.5, 0}), 0.5f * brightest, brightest * rounding);
}

TEST_F(PicturesOfLight, OnSurfacesWithoutCoordinatesCountByTheirMean) {
  const Scene scene = screen("exitance = 2, emission_texture = 'two pixels.png'", "");
  EXPECT_FALSE(FacetTextures(scene).has_emission());
  EXPECT_NEAR(mean_exitance(scene, scene.surfaces[0])[0], 1.0, rounding);
  EXPECT_TRUE(std::ranges::any_of(scene.notes, [](const std::string& note) {
    return note.find("count by their mean colour") != std::string::npos;
  }));
}

TEST_F(PicturesOfLight, ThatCannotBeAreToldWhy) {
  const auto refuses = [&](const std::string& material, const char* words) {
    const std::string message = message_of<InputError>([&] { screen(material); });
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  const std::string picture = "emission_texture = 'two pixels.png'";
  refuses(picture, "multiplies an emission");
  refuses(picture + ", exitance = 1, mask = 'two pixels.png'", "lamps have no holes");
  refuses("exitance = 1, emission_texture = 'none.png'", "there is no such file");
  refuses("exitance = 1, emission_texture = 'a.toml'", "is no PNG, JPEG, EXR or HDR");
  const std::string message = message_of<InputError>([&] {
    read_file("b.toml", "bands = { kind = 'spectral', count = 3 }\nmaterials.screen = { " +
                            picture + ", exitance = 1 }\n" + square);
  });
  EXPECT_NE(message.find("bands are wavelengths"), std::string::npos) << message;
}

TEST_F(PicturesOfLight, OfGltfFilesMultiplyFactorAndStrength) {
  const std::string png = base64(content_of(data / "two-pixels.png"));
  const Scene scene = read_file(
      "a.gltf",
      square_gltf(
          R"(,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"images":[{"uri":"data:image/png;base64,)" +
              png + R"("}],"textures":[{"source":0}],"materials":[{
          "emissiveFactor":[1,0.5,0.25],"emissiveTexture":{"index":0,"extensions":{
          "KHR_texture_transform":{"offset":[0.5,0],"scale":[0.25,1]}}},"extensions":{
          "KHR_materials_emissive_strength":{"emissiveStrength":4}}}])",
          R"(,"material":0)"));
  const Material& material = scene.materials.at(0);
  ASSERT_TRUE(material.emission_texture);
  EXPECT_FLOAT_EQ(material.emission_texture->factor[1], 2.0f * pi);
  EXPECT_NEAR(material.emission[1], pi, rounding);
  EXPECT_DOUBLE_EQ(material.emission_texture->image.placement(0, 0), 0.25);
  EXPECT_DOUBLE_EQ(material.emission_texture->image.placement(0, 2), 0.5);
}

TEST_F(PicturesOfLight, OfMitsubaFilesAreTheRadianceOfAnAreaEmitter) {
  const auto read = [&](const std::string& radiance) {
    return read_file(
        "a.xml", "<scene version='3.0.0'><shape type='rectangle'><emitter type='area'>" + radiance +
                     "</emitter></shape></scene>");
  };
  const Scene scaled = read(
      "<texture type='scale' name='radiance'><float name='scale' value='6'/>"
      "<texture type='bitmap'><string name='filename' value='two pixels.png'/>"
      "<string name='filter_type' value='nearest'/></texture></texture>");
  EXPECT_NEAR(exitance(scaled, {-0.5, 0.5, 0}), 6.0f * pi, 6.0f * pi * rounding);
  EXPECT_EQ(exitance(scaled, {0.5, 0.5, 0}), 0.0f);
  const Scene board = read(
      "<texture type='checkerboard' name='radiance'><rgb name='color0' value='4'/>"
      "<rgb name='color1' value='1'/></texture>");
  EXPECT_NEAR(first_material(board).emission[0], 2.5f * pi, 2.5f * pi * rounding);
  const Scene bright = read(
      "<texture type='bitmap' name='radiance'><string name='filename' value='bright.hdr'/>"
      "</texture>");
  EXPECT_NEAR(first_material(bright).emission[0], 0.75f * 128.5f / 64.0f * pi, 5.0f * rounding);
}

TEST_F(PicturesOfLight, OfObjFilesMultiplyKe) {
  const std::string corners =
      "mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
      "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
  folder.write("a.mtl", "newmtl m\nKe 2 2 2\nmap_Ke two pixels.png\n");
  EXPECT_NEAR(exitance(read_file("a.obj", corners), {0.25, 0.5, 0}), 2.0f * pi, 7.0f * rounding);
  folder.write("a.mtl", "newmtl m\nmap_Ke two pixels.png\n");
  EXPECT_NEAR(exitance(read_file("a.obj", corners), {0.25, 0.5, 0}), pi, 7.0f * rounding);
}

// A triangle over half of a picture of three by three texels. Cells at its slope count by their
// area within.
TEST(PictureCells, OfATriangleHaveItsAreaAndTheMeanOfItsTexels) {
  PolygonMesh mesh{.vertices = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}},
                   .facets = {{.boundary = {0, 1, 2}}}};
  UvMap map;
  map.gradient << 1.0 / 3.0, 0, 0, 0, 1.0 / 3.0, 0;
  const SurfaceTexture picture = picture_of(3, 3, {1, 1, 0, 1, 0, 0, 0, 0, 1});
  for (const int across : {4, 16, 128}) {
    const PictureCells cells = picture_cells(picture, map, mesh, mesh.facets[0], across);
    double area = 0.0;
    for (const double of_cell : cells.area) area += of_cell;
    EXPECT_NEAR(area, 4.5, 1e-12);
    // Three whole white texels; the slope halves a black and two black ones.
    EXPECT_NEAR(mean_of(cells)[0], 3.0 / 4.5, rounding) << across;
  }
}

// Coordinates that are the same all over give one cell.
TEST(PictureCells, OfCoordinatesWithoutAreaAreOne) {
  PolygonMesh mesh{.vertices = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}},
                   .facets = {{.boundary = {0, 1, 2}}}};
  UvMap map;
  map.offset = Eigen::Vector2d(0.25, 0.5);
  const PictureCells cells =
      picture_cells(picture_of(2, 1, {0.5f, 1.0f}), map, mesh, mesh.facets[0], 64);
  EXPECT_EQ(cells.area.size(), 1u);
  EXPECT_NEAR(mean_of(cells)[0], 0.5, rounding);
}

}  // namespace
}  // namespace lightwell::emission_picture_test
