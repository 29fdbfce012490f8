// Meshes of other files in a TOML scene, and whose materials they have.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "scene/io/read_scene.h"
#include "tests/temporary_folder.h"

namespace lightwell::read_meshes_test {
namespace {

TEST(ReadTomlMeshes, MaterialsOfMeshesAreMissingOnlyWhereTheSceneHasNone) {
  const TemporaryFolder folder;
  const std::string triangles =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl wood\nf 1 2 3\nusemtl cloth\nf 1 3 2\n";
  folder.write("plain.obj", triangles);
  folder.write("gone.obj", "mtllib gone.mtl\n" + triangles);
  const std::string wood = "[materials.wood]\nreflectance = 0.3\n";
  const std::string cloth = "[materials.cloth]\nreflectance = 0.4\n";
  for (const std::string mesh : {"plain.obj", "gone.obj"}) {
    const std::string surfaces = "[[surfaces]]\nmesh = \"" + mesh + "\"\n";
    const Scene whole = read_scene(folder.write("whole.toml", wood + cloth + surfaces));
    EXPECT_TRUE(whole.losses.empty()) << whole.losses.front();
    EXPECT_TRUE(whole.notes.empty()) << whole.notes.front();
    EXPECT_EQ(whole.materials[static_cast<std::size_t>(whole.surfaces[1].material)].name, "cloth");

    const Scene half = read_scene(folder.write("half.toml", wood + surfaces));
    ASSERT_EQ(half.losses.size(), mesh == "gone.obj" ? 2u : 1u);
    EXPECT_EQ(half.losses.front().find("gone.mtl") != std::string::npos, mesh == "gone.obj");
    EXPECT_NE(half.losses.back().find("0.5: 'cloth'."), std::string::npos) << half.losses.back();
  }
}

TEST(ReadTomlMeshes, PicturesOfReplacedMaterialsAreNotMissed) {
  const TemporaryFolder folder;
  folder.write("mesh.mtl", "newmtl wood\nmap_Kd gone.png\nnewmtl unused\nKd nan\n");
  folder.write("mesh.obj", "mtllib mesh.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl wood\nf 1 2 3\n");
  const std::string surfaces = "[[surfaces]]\nmesh = \"mesh.obj\"\n";
  const Scene replaced =
      read_scene(folder.write("replaced.toml", "[materials.wood]\nreflectance = 0.3\n" + surfaces));
  EXPECT_TRUE(replaced.notes.empty()) << replaced.notes.front();
  EXPECT_FLOAT_EQ(replaced.materials.at(0).reflectance[0], 0.3f);
  EXPECT_EQ(read_scene(folder.write("kept.toml", surfaces)).losses.size(), 1u);
}

TEST(ReadTomlMeshes, MaterialsOfTheSceneShowPicturesOnMeshes) {
  const TemporaryFolder folder;
  std::filesystem::copy(LIGHTWELL_TEST_DATA "/scene/two-pixels.png", folder / "print.png");
  folder.write("mesh.obj",
               "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
               "usemtl wood\nf 1/1 2/2 3/3\nusemtl plain\nf 1/1 3/3 2/2\n");
  const Scene scene = read_scene(folder.write(
      "scene.toml",
      "[materials.wood]\ntexture = \"print.png\"\n[materials.plain]\nreflectance = 0.3\n"
      "[[surfaces]]\nname = \"mesh\"\nmesh = \"mesh.obj\"\n"));
  EXPECT_TRUE(scene.notes.empty()) << scene.notes.front();
  ASSERT_EQ(scene.surfaces.size(), 2u);
  for (const Surface& surface : scene.surfaces) {
    const auto& polygons = std::get<PolygonMesh>(surface.shape);
    if (surface.name == "mesh/mesh (wood)") {
      EXPECT_GE(polygons.facets.at(0).uv_map, 0);
    } else {
      EXPECT_EQ(surface.name, "mesh/mesh (plain)");
      EXPECT_TRUE(polygons.uv_maps.empty());
    }
  }
}

}  // namespace
}  // namespace lightwell::read_meshes_test
