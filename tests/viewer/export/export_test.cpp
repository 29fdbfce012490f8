// Exported files, read back.
#include "viewer/export/export.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <algorithm>
#include <array>

#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <sstream>

#include "radiosity/refine/illuminance_bound.h"
#include "scene/io/read_scene.h"
#include "tests/temporary_folder.h"
#include "tests/viewer/glb_file.h"
#include "tests/viewer/lit_sides.h"
#include "tests/viewer/pictured_wall.h"

namespace lightwell::export_test {
namespace {

using Json = nlohmann::json;

class Export : public testing::Test {
 protected:
  TemporaryFolder folder;
};

double area_of(const Scene& scene) {
  double area = 0.0;
  for (const Surface& surface : scene.surfaces) area += surface_area(surface);
  return area;
}

std::set<std::string> names_of(const Scene& scene) {
  std::set<std::string> names;
  for (const Surface& surface : scene.surfaces) names.insert(surface.name);
  return names;
}

/// Five walls of 2 m x 2 m; single precision holds their corners exactly.
constexpr double box_area = 5 * 4.0;

TEST_F(Export, OurReaderFindsTheRoomInTheGltf) {
  write_gltf(folder / "box.glb", bake_model(solved_box(), box_scene()));
  const Scene scene = read_scene(folder / "box.glb");
  EXPECT_EQ(names_of(scene), (std::set<std::string>{"left", "right", "wall", "floor", "ceiling"}));
  EXPECT_NEAR(area_of(scene), box_area, 1e-12);
  const Bounds bounds = scene_bounds(scene);
  EXPECT_EQ(bounds.low, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(bounds.high, Eigen::Vector3d(2, 2, 2));
  ASSERT_EQ(scene.cameras.size(), 1u);
  const Camera &camera = scene.cameras[0], wanted = box_camera();
  EXPECT_EQ(camera.name, "front");
  // The round trip of doubles through text, a matrix and two tangents has errors of some 2^-52.
  EXPECT_LT((camera.position - wanted.position).norm(), 1e-14);
  EXPECT_LT((camera.direction - wanted.direction).norm(), 1e-14);
  EXPECT_LT((camera.up - wanted.up).norm(), 1e-14);
  EXPECT_NEAR(camera.fov_degrees, wanted.fov_degrees, 1e-12);
}

/// Facets keep their orientation: the walls of the box face inwards.
TEST_F(Export, WindingIsKept) {
  write_gltf(folder / "box.glb", bake_model(solved_box(), box_scene()));
  for (const Surface& surface : read_scene(folder / "box.glb").surfaces) {
    const auto& mesh = std::get<PolygonMesh>(surface.shape);
    for (const Facet& facet : mesh.facets) {
      const Eigen::Vector3d inwards =
          Eigen::Vector3d(1, 1, 1) - mesh.vertices[facet.boundary.front()];
      EXPECT_GT(facet_normal(mesh, facet).dot(inwards), 0.0) << surface.name;
    }
  }
}

/// COLOR_0 times `radiosity_of_color_1` is B, and clipped vertices are counted.
TEST_F(Export, GltfColorsStandForRadiosity) {
  const BakedModel model = bake_model(solved_box(), box_scene(), -1.0);
  write_gltf(folder / "box.glb", model);
  const Glb glb = parse_glb(content_of(folder / "box.glb"));
  const Json& extras = glb.json["asset"]["extras"];
  const double factor = extras["radiosity_of_color_1"];
  EXPECT_EQ(extras["clipped_vertices"],
            0);  // a stop below automatic: nothing is five times typical
  for (std::size_t m = 0; m < 5; ++m) {
    const Json& primitive = glb.json["meshes"][m]["primitives"][0];
    const std::vector<float> colors = floats(glb, primitive["attributes"]["COLOR_0"], 3);
    const std::vector<float> lux = floats(glb, primitive["attributes"]["_ILLUMINANCE"], 1);
    const int first = model.parts[m].first_vertex;
    ASSERT_EQ(colors.size(), 12u);
    for (int i = 0; i < 12; ++i) {
      const float B = model.radiosity(first + i / 3, i % 3);
      EXPECT_NEAR(factor * colors[i], B, B * 4e-7);  // three roundings of 2^-24
    }
    for (int i = 0; i < 4; ++i) EXPECT_EQ(lux[i], model.illuminance[first + i]);
  }
  EXPECT_EQ(glb.json["materials"][0]["extensions"].count("KHR_materials_unlit"), 1u);

  write_gltf(folder / "bright.glb", bake_model(solved_box(), box_scene(), 10.0));
  const Glb bright = parse_glb(content_of(folder / "bright.glb"));
  EXPECT_EQ(bright.json["asset"]["extras"]["clipped_vertices"], 20);
  for (const float c :
       floats(bright, bright.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"], 3)) {
    EXPECT_EQ(c, 1.0f);
  }
}

/// Bounds of elements: twice the error of interpolation, relative to the mean irradiance or more.
TEST_F(Export, BoundsOfIlluminanceAreInModelAndGltf) {
  SolvedScene box = solved_box();
  EXPECT_TRUE(bake_model(box, box_scene()).lux_within.empty());
  constexpr float error = 0.1f;
  box.solution.interpolation_error = Eigen::ArrayXf::Constant(box.mesh.element_count(), error);
  box.solution.gather_noise = Eigen::ArrayXf::Zero(box.mesh.element_count());
  const BakedModel model = bake_model(box, box_scene());
  const Eigen::ArrayXf bounds = illuminance_bounds(box.mesh, box.solution);
  ASSERT_EQ(model.lux_within.size(), model.faces.size());
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    EXPECT_EQ(model.lux_within[f], bounds[model.element[f]]);
    EXPECT_GT(model.lux_within[f], 0.0f);
  }
  write_gltf(folder / "bounds.glb", model);
  const Glb glb = parse_glb(content_of(folder / "bounds.glb"));
  for (std::size_t m = 0; m < 5; ++m) {
    const Json& primitive = glb.json["meshes"][m]["primitives"][0];
    for (const float within : floats(glb, primitive["attributes"]["_ILLUMINANCE_WITHIN"], 1)) {
      EXPECT_EQ(within, model.lux_within[static_cast<std::size_t>(model.parts[m].first_face)]);
    }
  }
}

TEST_F(Export, BothLitSidesAreInTheGltfOfOneSurface) {
  write_gltf(folder / "square.glb", bake_model(square_of_two_sides(white, red), {}));
  const Glb glb = parse_glb(content_of(folder / "square.glb"));
  ASSERT_EQ(glb.json["meshes"].size(), 1u);
  EXPECT_EQ(glb.json["meshes"][0]["primitives"].size(), 2u);
  EXPECT_EQ(glb.json.count("cameras"), 0u);  // one that we made up is no part of the model
}

TEST_F(Export, AnyNameIsWrittenAsValidText) {
  Scene scene = box_scene();
  scene.surfaces[0].name = "quote \" brace } newline \n";
  scene.surfaces[1].name = "not UTF-8: \xff";
  const BakedModel model = bake_model(solved_box(), scene);
  write_gltf(folder / "box.glb", model);
  const Glb glb = parse_glb(content_of(folder / "box.glb"));
  EXPECT_EQ(glb.json["nodes"][0]["name"], scene.surfaces[0].name);
  write_obj(folder / "box.obj", model);
  EXPECT_NEAR(area_of(read_scene(folder / "box.obj")), box_area, 1e-12);
  write_ply(folder / "box.ply", model);
  EXPECT_NEAR(area_of(read_scene(folder / "box.ply")), box_area, 1e-12);
}

/// A viewer multiplies COLOR_0 with the picture; the product is the radiosity of the texel.
TEST_F(Export, PicturesAreBaseColours) {
  const PicturedBox box;
  const BakedModel model = bake_model(box.solved, box.scene);
  write_gltf(folder / "box.glb", model);
  const Glb glb = parse_glb(content_of(folder / "box.glb"));
  ASSERT_EQ(glb.json["images"].size(), 1u);
  EXPECT_EQ(glb.json["samplers"][0]["magFilter"], 9728) << "flat squares";
  int pictured = 0;
  for (const auto& mesh : glb.json["meshes"]) {
    const auto& primitive = mesh["primitives"][0];
    const auto& material = glb.json["materials"][primitive["material"].get<int>()];
    const auto& attributes = primitive["attributes"];
    EXPECT_EQ(attributes.contains("TEXCOORD_0"),
              material["pbrMetallicRoughness"].contains("baseColorTexture"));
    if (!attributes.contains("TEXCOORD_0")) continue;
    ++pictured;
    EXPECT_EQ(material["name"], "wall paint with a picture");
    const auto scale = glb.json["asset"]["extras"]["exposure"].get<float>();
    // B = rho E with rho of the bright half and E of a white wall.
    const float wanted = scale * bright_half * white[0] / std::numbers::pi_v<float>;
    for (const float c : floats(glb, attributes["COLOR_0"], 3)) {
      EXPECT_NEAR(c, std::min(wanted, 1.0f), 1e-4f);
    }
    const auto places = floats(glb, attributes["TEXCOORD_0"], 2);
    EXPECT_EQ(*std::ranges::max_element(places), 1.0f);
    EXPECT_EQ(*std::ranges::min_element(places), 0.0f);
  }
  EXPECT_EQ(pictured, 1);
}

TEST_F(Export, KhronosValidatorHasNothingToSay) {
  if (!has_node())
    GTEST_SKIP() << "no node here to run the validator; on Debian: apt install nodejs";
  Scene scene = box_scene();
  scene.materials[0].dielectric = Dielectric{.tint = Spectrum::Ones(3)};
  write_gltf(folder / "box.glb", bake_model(solved_box(), scene));
  write_gltf(folder / "square.glb", bake_model(square_of_two_sides(white, red), {}));
  EXPECT_TRUE(is_valid_gltf(folder, folder / "box.glb"));
  EXPECT_TRUE(is_valid_gltf(folder, folder / "square.glb"));
  PicturedBox pictured;
  pictured.scene.materials.back().mask = Mask{.image = picture_of(2, 1, {1.0f, 0.0f})};
  write_gltf(folder / "pictured.glb", bake_model(pictured.solved, pictured.scene));
  EXPECT_TRUE(is_valid_gltf(folder, folder / "pictured.glb"));
}

TEST_F(Export, OurReaderFindsTheRoomInThePly) {
  write_ply(folder / "box.ply", bake_model(solved_box(), box_scene()));
  const Scene scene = read_scene(folder / "box.ply");
  EXPECT_NEAR(area_of(scene), box_area, 1e-12);
  EXPECT_EQ(scene_bounds(scene).high, Eigen::Vector3d(2, 2, 2));
}

/// The rows of vertices are compared byte for byte.
TEST_F(Export, PlyHoldsTheLightOfEveryVertex) {
  const BakedModel model = bake_model(solved_box(), box_scene());
  write_ply(folder / "box.ply", model);
  const std::string text = content_of(folder / "box.ply");
  EXPECT_TRUE(says(text, "element vertex 20\nproperty float x\n"));
  EXPECT_TRUE(says(text, "property float radiosity_r\nproperty float radiosity_g\n"));
  EXPECT_TRUE(says(text, "comment surface 2 wall\n"));
  EXPECT_TRUE(says(text, "element face 10\n"));
  const std::string mark = "end_header\n";
  const char* row = text.data() + text.find(mark) + mark.size();
  constexpr std::size_t row_size = 12 + 3 + 4 * 7;
  const auto bytes = srgb_colors(model);
  for (int v = 0; v < model.vertex_count(); ++v, row += row_size) {
    std::array<float, 3> p{};
    std::array<float, 7> light{};
    std::memcpy(p.data(), row, 12);
    std::memcpy(light.data(), row + 15, 28);
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(p[c], model.position[v][c]);
      EXPECT_EQ(static_cast<std::uint8_t>(row[12 + c]), bytes[3 * v + c]);
      EXPECT_EQ(light[c], model.radiosity(v, c));
      EXPECT_EQ(light[3 + c], model.irradiance(v, c));
    }
    EXPECT_EQ(light[6], model.illuminance[v]);
  }
  constexpr std::size_t face_size = 1 + 12 + 8;
  EXPECT_EQ(static_cast<std::size_t>(text.data() + text.size() - row), 10 * face_size);
}

TEST_F(Export, OurReaderFindsTheRoomInTheObj) {
  const BakedModel model = bake_model(solved_box(), box_scene());
  write_obj(folder / "box.obj", model);
  const Scene scene = read_scene(folder / "box.obj");
  EXPECT_NEAR(area_of(scene), box_area, 1e-12);
  ASSERT_EQ(scene.surfaces.size(), 5u);
  EXPECT_TRUE(says(scene.surfaces[2].name, "wall"));
  ASSERT_EQ(scene.materials.size(), 5u);
  EXPECT_EQ(scene.materials[2].name, "2_wall_paint");

  // Every vertex has coordinates and colours.
  std::istringstream text(content_of(folder / "box.obj"));
  const auto bytes = srgb_colors(model);
  int v = 0;
  for (std::string line; std::getline(text, line);) {
    if (!line.starts_with("v ")) continue;
    std::istringstream words(line.substr(2));
    for (int c = 0; c < 6; ++c) {
      double value = -1.0;
      words >> value;
      if (c < 3) {
        EXPECT_EQ(value, model.position[v][c]);
      } else {
        EXPECT_NEAR(255.0 * value, bytes[3 * v + c - 3], 255.0 * 5e-5);  // four digits
      }
    }
    ++v;
  }
  EXPECT_EQ(v, 20);
}

TEST_F(Export, AFileThatCannotBeWrittenIsNamedAndLeavesNothing) {
  const BakedModel model = bake_model(solved_box(), box_scene());
  const auto fails = [&](void (*write)(const std::filesystem::path&, const BakedModel&),
                         const char* name) {
    const auto path = folder / "nowhere" / name;
    // An OBJ export writes box.mtl first.
    EXPECT_TRUE(says(message_of<std::runtime_error>([&] { write(path, model); }),
                     path.parent_path() / path.stem()));
  };
  fails(&write_gltf, "box.glb");
  fails(&write_ply, "box.ply");
  fails(&write_obj, "box.obj");
  fails([](const std::filesystem::path& path, const BakedModel& m) { write_walkthrough(path, m); },
        "box.html");
  EXPECT_EQ(folder.file_count(), 0);
}

}  // namespace
}  // namespace lightwell::export_test
