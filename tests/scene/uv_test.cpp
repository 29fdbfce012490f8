// Texture coordinates of readers, masks, and notes on missing texture coordinates.
#include <algorithm>

#include "scene/facet_textures.h"
#include "scene/io/corner_maps.h"
#include "scene/io/mesh_builder.h"
#include "scene/io/placed_mesh.h"
#include "scene/io/polygon.h"
#include "scene/io/polygon_repair.h"
#include "scene/sampling.h"
#include "tests/scene/gltf_text.h"
#include "tests/scene/scene_file_test.h"

namespace lightwell::uv_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const std::filesystem::path data = LIGHTWELL_TEST_DATA "/scene";

// two-pixels.png is white and opaque on its left, black and transparent on its right.
class Pictures : public test::SceneFileTest {
 protected:
  Pictures() { std::filesystem::copy(data / "two-pixels.png", folder / "two pixels.png"); }

  static bool is_noted(const Scene& scene, const std::string& words) {
    return std::ranges::any_of(scene.notes, [&](const std::string& note) {
      return note.find(words) != std::string::npos;
    });
  }
  // Reflectance of the scene's facet 0 at a point, first band.
  static float rho(const Scene& scene, const Vector3d& p) {
    return FacetTextures(scene).reflectance(0, p)[0];
  }
};

TEST(UvMap, IsExactOnTheCornersOfATriangle) {
  for (int i = 0; i < 50; ++i) {
    Loop loop;
    UvLoop uv;
    for (int k = 0; k < 3; ++k) {
      const auto x = [&](int c) { return random_uniform(random_key(i, k, c)); };
      loop.emplace_back(5 * x(0), 5 * x(1), 5 * x(2));
      uv.emplace_back(3 * x(3), x(4));
    }
    if (is_thin(loop)) continue;
    const auto map = uv_map_over(loop, uv);
    ASSERT_TRUE(map);
    for (int k = 0; k < 3; ++k) EXPECT_LT((map->at(loop[k]) - uv[k]).norm(), 1e-9);
    const Vector3d normal = (loop[1] - loop[0]).cross(loop[2] - loop[0]);
    EXPECT_LT((map->gradient * normal.normalized()).norm(), 1e-9) << "constant along the normal";
  }
}

TEST(UvMap, IsNoneWhereCoordinatesAreNotLinear) {
  const Loop square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_TRUE(uv_map_over(square, {{0, 0}, {2, 0}, {2, 1}, {0, 1}}));
  EXPECT_FALSE(uv_map_over(square, {{0, 0}, {2, 0}, {1, 1}, {0, 1}}));
  EXPECT_FALSE(uv_map_over(square, {{0, 0}, {2, 0}, {2, std::nan("")}, {0, 1}}));
}

TEST(UvMap, PolygonsItIsNotLinearOverAreCut) {
  MeshBuilder mesh;
  Repairs repairs;
  const Loop square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const UvLoop uv = {{0, 0}, {2, 0}, {1, 1}, {0, 1}};
  add_repaired(mesh, square, repairs, uv);
  ASSERT_EQ(mesh.mesh().facets.size(), 2u);
  EXPECT_EQ(repairs.split, 0) << "it was planar";
  for (const Facet& facet : mesh.mesh().facets) {
    const UvMap& map = mesh.mesh().uv_maps.at(static_cast<std::size_t>(facet.uv_map));
    for (const int v : facet.boundary) {
      const auto at = std::ranges::find(square, mesh.mesh().vertices[static_cast<std::size_t>(v)]);
      EXPECT_LT((map.at(*at) - uv[static_cast<std::size_t>(at - square.begin())]).norm(), 1e-12);
    }
  }
}

TEST(UvMap, IsSharedByTrianglesOverWhichItGoesOn) {
  MeshBuilder mesh;
  Repairs repairs;
  add_repaired(mesh, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, repairs, {{0, 0}, {1, 0}, {1, 1}});
  add_repaired(mesh, {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}}, repairs, {{0, 0}, {1, 1}, {0, 1}});
  add_repaired(mesh, {{1, 0, 0}, {2, 0, 0}, {2, 1, 0}}, repairs, {{0, 0}, {1, 0}, {1, 1}});
  EXPECT_EQ(mesh.mesh().uv_maps.size(), 2u);
  EXPECT_EQ(mesh.mesh().facets[0].uv_map, mesh.mesh().facets[1].uv_map);
  EXPECT_NE(mesh.mesh().facets[0].uv_map, mesh.mesh().facets[2].uv_map);
}

TEST(UvMap, MovesWithItsMesh) {
  const UvLoop uv = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  Repairs repairs;
  const PolygonMesh mesh =
      placed_loops(rectangle_loops(), Eigen::Affine3d::Identity(), false, repairs, {uv});
  Eigen::Affine3d turned = Eigen::Affine3d::Identity();
  turned.translate(Vector3d(3, 1, 2))
      .rotate(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()));
  Eigen::Affine3d mirrored = turned, sheared = turned;
  mirrored.scale(Vector3d(-2, 2, 2));
  sheared.scale(Vector3d(1, 3, 0));  // the square is flat along z already
  for (const Eigen::Affine3d& place : {turned, mirrored, sheared}) {
    const PolygonMesh placed = placed_mesh(mesh, place, false, true, repairs);
    ASSERT_EQ(placed.facets.size(), 1u);
    const UvMap& map = placed.uv_maps.at(static_cast<std::size_t>(placed.facets[0].uv_map));
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_LT((map.at(place * rectangle_loops()[0][i]) - uv[i]).norm(), 1e-12);
    }
  }
}

const std::string toml_square = R"(
[[surfaces]]
name = "rug"
material = "rug"
polygon = [[0,0,0],[2,0,0],[2,1,0],[0,1,0]]
)";

TEST_F(Pictures, OfNativeFilesMultiplyTheReflectance) {
  const Scene scene = read_file("a.toml", R"(
materials.rug = { reflectance = [0.8, 0.4, 0.2], texture = { file = "two pixels.png", filter = "nearest" } }
)" + toml_square + "uv = [[0,0],[1,0],[1,1],[0,1]]\n");
  const Material& rug = first_material(scene);
  EXPECT_FLOAT_EQ(rug.reflectance[0], 0.4f) << "half of the picture is white";
  EXPECT_NEAR(rho(scene, {0.5, 0.5, 0}), 0.8f, 1e-5f);
  EXPECT_NEAR(rho(scene, {1.5, 0.5, 0}), 0.0f, 1e-5f);
  EXPECT_NEAR(FacetTextures(scene).reflectance(0, {0.5, 0.5, 0})[2], 0.2f, 1e-5f);
}

// Pixels that a mask cuts out have no part in the mean, nor in filters that reach beyond the cut.
TEST_F(Pictures, ThatAreCutShowTheColourOfWhatIsCovered) {
  const std::string square = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
  folder.write("leaf.mtl",
               "newmtl leaf\nKd .8 .8 .8\nmap_Kd two pixels.png\nmap_d two pixels.png\n");
  const std::string laid = "uv = [[0,0],[1,0],[1,1],[0,1]]\n";
  for (const Scene& scene :
       {read_file("leaf.toml",
                  "[materials.rug]\nreflectance = 0.8\ntexture = 'two pixels.png'\n"
                  "mask = 'two pixels.png'\n" +
                      toml_square + laid),
        read_file("leaf.obj", "mtllib leaf.mtl\nusemtl leaf\n" + square + "f 1/1 2/2 3/3 4/4\n")}) {
    EXPECT_FLOAT_EQ(first_material(scene).reflectance[0], 0.8f);
    for (const double x : {0.5, 1.0, 1.5}) {
      EXPECT_FLOAT_EQ(rho(scene, {x, 0.5, 0}), 0.8f) << x << ": sums of white are exact";
    }
    EXPECT_TRUE(FacetTextures(scene).is_hole(0, {1.5, 0.5, 0}));
    EXPECT_FALSE(FacetTextures(scene).is_hole(0, {0.5, 0.5, 0}));
  }
}

TEST_F(Pictures, WithoutCoordinatesCountByTheirMean) {
  const Scene scene =
      read_file("a.toml", "materials.rug = { texture = 'two pixels.png' }\n" + toml_square);
  EXPECT_TRUE(FacetTextures(scene).is_empty());
  EXPECT_FLOAT_EQ(first_material(scene).reflectance[0], 0.5f);
  EXPECT_TRUE(is_noted(scene, "without texture coordinates count by their mean colour: 'rug'"));
}

TEST_F(Pictures, OfNativeFilesAreRefusedBySentences) {
  const auto expect_refused = [&](const std::string& material, const std::string& uv,
                                  const std::string& words) {
    try {
      read_file("bad.toml", "materials.rug = " + material + "\n" + toml_square + uv);
      ADD_FAILURE() << "was read: " << material << uv;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("rug"), std::string::npos) << error.what();
    }
  };
  const std::string good = "{ texture = 'two pixels.png' }";
  expect_refused("{ texture = 'none.png' }", "", "there is no such file");
  expect_refused("{ texture = 'bad.toml' }", "", "is no PNG or JPEG");
  expect_refused(good, "uv = [[0,0],[1,0]]", "has 2 places for a polygon of 4 vertices");
  expect_refused(good, "uv = [[0,0],[1,0],[1,1],[0]]", "two numbers [u, v]");
  expect_refused("{ texture = 'two pixels.png', glass = { ior = 1.5 } }", "",
                 "contradicts 'glass'");
  expect_refused("{ mask = 'two pixels.png', radiance = 1 }", "", "lamps have no holes");
  expect_refused("{ texture = { file = 'two pixels.png', wrap = 'round' } }", "", "'mirror'");
  folder.write("cut.png", content_of(data / "two-pixels.png").substr(0, 50));
  expect_refused("{ texture = 'cut.png' }", "", "no picture that can be decoded");
}

TEST_F(Pictures, MasksOfNativeFilesCutHoles) {
  const Scene scene =
      read_file("a.toml",
                "materials.rug = { reflectance = 0.5, mask = { file = 'two pixels.png', "
                "filter = 'nearest' } }\n" +
                    toml_square + "uv = [[0,0],[1,0],[1,1],[0,1]]\n");
  const FacetTextures textures(scene);
  ASSERT_TRUE(textures.has_holes(0));
  EXPECT_FALSE(textures.is_textured(0));
  EXPECT_FALSE(textures.is_hole(0, {0.5, 0.5, 0}));
  EXPECT_TRUE(textures.is_hole(0, {1.5, 0.5, 0}));
}

// The first row of a picture is at the largest v in OBJ files.
TEST_F(Pictures, OfObjFilesStandOnTheirFeet) {
  folder.write("a.mtl", "newmtl m\nKd 0.5 0.5 0.5\nmap_Kd -s 1 1 1 two pixels.png\n");
  const Scene scene = read_file("a.obj",
                                "mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
  const auto& mesh = std::get<PolygonMesh>(scene.surfaces[0].shape);
  ASSERT_EQ(mesh.facets.size(), 1u);
  EXPECT_LT((mesh.uv_maps.at(0).at({0.3, 0.2, 0}) - Vector2d(0.3, 0.8)).norm(), 1e-12);
  EXPECT_NEAR(rho(scene, {0.25, 0.5, 0}), 0.5f, 1e-5f);
  EXPECT_FLOAT_EQ(scene.materials[0].reflectance[0], 0.25f);
}

TEST_F(Pictures, OfObjFilesThatAreMissingAreNamed) {
  folder.write("a.mtl", "newmtl brick\nKd 0.5 0.5 0.5\nmap_Kd wall\\brick.png\n");
  const Scene scene =
      read_file("a.obj", "mtllib a.mtl\nusemtl brick\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  EXPECT_FLOAT_EQ(scene.materials[0].reflectance[0], 0.5f);
  EXPECT_TRUE(is_noted(scene, "a.mtl: pictures that are missing were left out: '"));
  EXPECT_TRUE(is_noted(scene, "wall/brick.png'"));
}

TEST_F(Pictures, OfGltfFilesAreLaidAndWrappedAsTheySay) {
  const std::string png = base64(content_of(data / "two-pixels.png"));
  const std::string uv = base64(bytes_of<float>({0, 0, 1, 0, 1, 1, 0, 1}));
  const auto read = [&](const std::string& material, const std::string& info) {
    std::string text = square_gltf(
        R"(,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"images":[{"uri":"data:image/png;base64,)" +
            png + R"("}],"samplers":[{"wrapS":33071,"magFilter":9728}],"textures":[{"source":0,
            "sampler":0}],"materials":[{)" +
            material +
            R"("pbrMetallicRoughness":{"metallicFactor":0.25,"roughnessFactor":0.2,"baseColorFactor":
            [0.8,0.8,0.8,1],"baseColorTexture":{"index":0)" +
            info + "}}}]",
        R"(,"material":0)");
    const auto put = [&](const std::string& after, const std::string& more) {
      text.insert(text.find(after) + after.size(), more);
    };
    put(R"("buffers":[)",
        R"({"byteLength":32,"uri":"data:application/octet-stream;base64,)" + uv + R"("},)");
    // The square's buffer becomes the second one.
    for (std::size_t at = 0; (at = text.find(R"({"buffer":0,)", at)) != std::string::npos; ++at) {
      text[at + 10] = '1';
    }
    put(R"("bufferViews":[)", R"({"buffer":0,"byteLength":32},)");
    text.replace(text.find(R"({"bufferView":1,)"), 16, R"({"bufferView":2,)");
    text.replace(text.find(R"({"bufferView":0,)"), 16, R"({"bufferView":1,)");
    put(R"("type":"SCALAR"})", R"(,{"bufferView":0,"componentType":5126,"count":4,"type":"VEC2"})");
    put(R"("POSITION":0)", R"(,"TEXCOORD_1":2)");
    return read_file("a.gltf", text);
  };
  // Three quarters of the base colour are diffuse, a quarter is metallic.
  const Scene scene = read("", R"(,"texCoord":1)");
  EXPECT_NEAR(rho(scene, {0.25, 0.5, 0}), 0.6f, 1e-5f);
  EXPECT_NEAR(rho(scene, {0.75, 0.5, 0}), 0.0f, 1e-5f);
  EXPECT_NEAR(scene.materials[0].reflectance[0] + scene.materials[0].specular[0], 0.4f, 1e-5f);
  const std::string moved = R"(,"texCoord":1,"extensions":{"KHR_texture_transform":
      {"offset":[0.5,0],"scale":[0.25,1]}})";
  EXPECT_NEAR(rho(read("", moved), {0.25, 0.5, 0}), 0.0f, 1e-5f) << "u is 0.56";
  const std::string turned = R"(,"texCoord":1,"extensions":{"KHR_texture_transform":
      {"rotation":1.5707963267948966}})";  // u' = v
  EXPECT_NEAR(rho(read("", turned), {0.9, 0.2, 0}), 0.6f, 1e-5f);
  EXPECT_NEAR(rho(read("", turned), {0.1, 0.8, 0}), 0.0f, 1e-5f);
  const Scene masked = read(R"("alphaMode":"MASK","alphaCutoff":0.4,)", R"(,"texCoord":1)");
  EXPECT_FALSE(FacetTextures(masked).is_hole(0, {0.25, 0.5, 0}));
  EXPECT_TRUE(FacetTextures(masked).is_hole(0, {0.75, 0.5, 0}));
  EXPECT_FALSE(is_noted(masked, "Transparency by alpha was left out"));
  EXPECT_TRUE(is_noted(read("", ""), "without texture coordinates")) << "there is no TEXCOORD_0";
}

TEST_F(Pictures, OfMitsubaFilesLieOnRectanglesAndMeshes) {
  folder.write("a.obj",
               "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
               "f 1/1 2/2 3/3 4/4\n");
  const auto read = [&](const std::string& shape, const std::string& before,
                        const std::string& after) {
    return read_file("a.xml", "<scene version='0.6.0'>" + shape + before +
                                  R"(<bsdf type="diffuse"><texture type="bitmap" name="reflectance">
      <string name="filename" value="two pixels.png"/><string name="filterType" value="nearest"/>
      </texture></bsdf>)" + after +
                                  "</shape></scene>");
  };
  const std::string rectangle = "<shape type='rectangle'>";
  EXPECT_NEAR(rho(read(rectangle, "", ""), {-0.5, 0.5, 0}), 1.0f, 1e-5f);
  EXPECT_NEAR(rho(read(rectangle, "", ""), {0.5, 0.5, 0}), 0.0f, 1e-5f);
  const Scene mesh = read("<shape type='obj'><string name='filename' value='a.obj'/>", "", "");
  const auto v_at_top = [](const Scene& scene) {
    const auto& polygons = std::get<PolygonMesh>(scene.surfaces[0].shape);
    return polygons.uv_maps.at(0).at({0.5, 1.0, 0.0})[1];
  };
  EXPECT_NEAR(v_at_top(mesh), 0.0, 1e-12) << "the picture's first row is at the top";
  EXPECT_NEAR(v_at_top(read("<shape type='obj'><string name='filename' value='a.obj'/>"
                            "<boolean name='flipTexCoords' value='false'/>",
                            "", "")),
              1.0, 1e-12);
  const Scene masked = read(rectangle,
                            R"(<bsdf type="mask"><texture type="bitmap" name="opacity">
      <string name="filename" value="two pixels.png"/></texture>)",
                            "</bsdf>");
  EXPECT_FALSE(FacetTextures(masked).is_hole(0, {-0.9, 0.5, 0}));
  EXPECT_TRUE(FacetTextures(masked).is_hole(0, {0.5, 0.5, 0}));
  EXPECT_TRUE(is_noted(read("<shape type='sphere'>", "", ""), "count by their mean colour"));
}

TEST_F(Pictures, DecideTheLight) {
  const auto hash = [&](const std::string& material, const std::string& uv) {
    return scene_hash(read_file("a.toml", "materials.rug = " + material + "\n" + toml_square + uv));
  };
  const std::string uv = "uv = [[0,0],[1,0],[1,1],[0,1]]\n",
                    two = "uv = [[0,0],[2,0],[2,1],[0,1]]\n";
  const std::string picture = "{ texture = 'two pixels.png' }";
  EXPECT_EQ(hash(picture, uv), hash(picture, uv));
  EXPECT_NE(hash(picture, uv), hash(picture, two));
  EXPECT_NE(hash(picture, uv), hash("{ reflectance = 0.5 }", uv));
  EXPECT_EQ(hash("{ reflectance = 0.5 }", uv), hash("{ reflectance = 0.5 }", two));
  EXPECT_NE(hash("{ reflectance = 0.5, mask = 'two pixels.png' }", uv),
            hash("{ reflectance = 0.5 }", uv));
}

}  // namespace
}  // namespace lightwell::uv_test
