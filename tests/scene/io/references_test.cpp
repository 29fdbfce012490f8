// Files that a scene names: those outside of its folder are refused where the user asks for that,
// and errors never show what a file that is no part of a scene holds.
#include <gtest/gtest.h>

#include "scene/io/numbered_scene.h"
#include "scene/io/text_file.h"
#include "tests/scene/expected_messages.h"
#include "tests/scene/gltf_text.h"
#include "tests/scene/interchange_text.h"
#include "tests/scene/scene_file_test.h"

namespace lightwell::references_test {
namespace {

namespace fs = std::filesystem;

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string grey = "[materials.grey]\nreflectance = 0.5\n";
const std::string floor_of_grey =
    "[[surfaces]]\nmaterial = 'grey'\npolygon = [[0,0,0],[1,0,0],[0,1,0]]\n";
const std::string mesh_surface = "[[surfaces]]\nmaterial = 'grey'\nmesh = '";
const std::string polygon_of_radiance =
    "void plastic grey 0 0 5 .5 .5 .5 0 0\ngrey polygon p 0 0 9 0 0 0 1 0 0 0 1 0\n";

std::string mitsuba(const std::string& content) {
  return "<scene version=\"3.0.0\"><shape type=\"rectangle\"/>" + content + "</scene>";
}

// Scenes lie in the folder "own", beside the files that they shall not read.
class References : public test::SceneFileTest {
 protected:
  References() {
    fs::create_directory(folder / "own");
    folder.write("outside.obj", triangle);
    folder.write("own/inside.obj", triangle);
    folder.write("own/mirror.obj", "mtllib ../outside.mtl\nusemtl a\n" + triangle);
    folder.write("outside.mtl", "newmtl a\nKd 1 0 0\n");
    folder.write("outside.rad", polygon_of_radiance);
    folder.write("secret", "root:x:0:0\nKEY = hunter2;\n");
    fs::create_symlink("../outside.obj", folder / "own/link.obj");
  }
  void expect_refused(const std::string& name, const std::string& content) const {
    SCOPED_TRACE(name + ": " + content);
    const fs::path scene = folder.write("own/" + name, content);
    test::expect_message([&] { read_scene(scene, lightwell::References::inside_folder); },
                         {"outside of its folder", "--inside-folder"});
  }
};

TEST_F(References, OutsideOfTheFolderAreRefused) {
  expect_refused("mesh.toml", grey + mesh_surface + "../outside.obj'\n");
  expect_refused("link.toml", grey + mesh_surface + "link.obj'\n");
  expect_refused("absolute.toml", grey + mesh_surface + (folder / "outside.obj").string() + "'\n");
  expect_refused("absent.toml", grey + mesh_surface + "../no-such-file.obj'\n");
  expect_refused("picture.toml", "[materials.grey]\ntexture = '../outside.png'\n" + floor_of_grey);
  expect_refused("spectrum.toml",
                 "[materials.grey]\nreflectance = { file = '../a.csv' }\n" + floor_of_grey);
  expect_refused("lamp.toml",
                 grey + floor_of_grey +
                     "[[lamps]]\nposition = [0,0,1]\naim = [0,0,-1]\nfile = '../lamp.ies'\n");
  expect_refused("sky.toml", grey + floor_of_grey + "[sky]\nkind = 'map'\nfile = '../sky.exr'\n");
  expect_refused("library.obj", "mtllib ../outside.mtl\nusemtl a\n" + triangle);
  folder.write("own/picture.mtl", "newmtl a\nmap_Kd ../outside.png\n");
  expect_refused("picture.obj", "mtllib picture.mtl\nusemtl a\n" + triangle);
  expect_refused("include.xml", mitsuba("<include filename=\"../outside.xml\"/>"));
  expect_refused("mesh.xml", mitsuba("<shape type=\"obj\"><string name=\"filename\" "
                                     "value=\"../outside.obj\"/></shape>"));
  expect_refused("sky.xml", mitsuba("<emitter type=\"envmap\"><string name=\"filename\" "
                                    "value=\"../sky.exr\"/></emitter>"));
  expect_refused("cat.rad", polygon_of_radiance + "!cat ../outside.rad\n");
  expect_refused("xform.rad", polygon_of_radiance + "!xform -a 2 /etc/passwd\n");
  expect_refused("prism.rad", polygon_of_radiance + "!genprism grey p ../secret\n");
  expect_refused("formula.rad", polygon_of_radiance + "!genrev grey p t 1 4 -f ../secret\n");
  expect_refused("mesh.rad", polygon_of_radiance + "grey mesh m 1 ../outside.rtm 0 0\n");
  expect_refused("project.rif", "scene = ../outside.rad\n");
  expect_refused("buffer.gltf",
                 square_gltf(R"(,"nodes":[{"mesh":0}],"images":[{"uri":"../outside.png"}],)"
                             R"("textures":[{"source":0}],"materials":[{"pbrMetallicRoughness":)"
                             R"({"baseColorTexture":{"index":0}}}])",
                             R"(,"material":0)"));
  expect_refused("include.mgf", "v a =\nsph a 1\ni ../outside.mgf\n");
  expect_refused("include.pov", "sphere { 0, 1 }\n#include \"../outside.inc\"\n");
  expect_refused("mesh_of_fbx.toml", grey + mesh_surface + "../outside.fbx'\n");
  expect_refused(
      "picture.dae",
      square_dae({.effect = R"(<diffuse><texture texture="i" texcoord="UV"/></diffuse>)",
                  .libraries = R"(<library_images><image id="i"><init_from>../outside.png)"
                               R"(</init_from></image></library_images>)"}));
}

TEST_F(References, WithinTheFolderAreRead) {
  const auto reads = [&](const std::string& name, const std::string& content) {
    const fs::path scene = folder.write("own/" + name, content);
    return read_scene(scene, lightwell::References::inside_folder).surfaces.size();
  };
  EXPECT_EQ(reads("mesh.toml", grey + mesh_surface + "inside.obj'\n"), 1u);
  EXPECT_EQ(reads("round.toml", grey + mesh_surface + "../own/inside.obj'\n"), 1u);
  fs::create_directory(folder / "own/parts");
  folder.write("own/parts/part.rad", "!cat ../base.rad\n");
  folder.write("own/base.rad", polygon_of_radiance);
  EXPECT_EQ(reads("main.rad", "!cat parts/part.rad\n"), 1u);
  // The scene itself may be a link: who names it wants it.
  fs::create_symlink("../outside.rad", folder / "own/linked.rad");
  EXPECT_EQ(
      read_scene(folder / "own/linked.rad", lightwell::References::inside_folder).surfaces.size(),
      1u);
}

TEST_F(References, OutsideAreReadUnlessForbidden) {
  const fs::path scene = folder.write("own/mesh.toml", grey + mesh_surface + "../outside.obj'\n");
  EXPECT_EQ(read_scene(scene).surfaces.size(), 1u);
  test::expect_message([&] { read_numbered_scene(scene, lightwell::References::inside_folder); },
                       {"outside of its folder"});
}

// glTF 2.0, 3.6.1.1: URIs are data or relative paths.
TEST_F(References, OfGltfAreRelative) {
  const auto notes_of = [&](const std::string& uri) {
    const Scene scene = read_file(
        "own/scene.gltf",
        square_gltf(R"(,"nodes":[{"mesh":0}],"images":[{"uri":")" + uri +
                        R"("}],)"
                        R"("textures":[{"source":0}],"materials":[{"pbrMetallicRoughness":)"
                        R"({"baseColorTexture":{"index":0}}}])",
                    R"(,"material":0)"));
    std::string all;
    for (const std::string& note : scene.notes) all += note + "\n";
    return all;
  };
  for (const char* uri : {"/etc/passwd", "file:///etc/passwd", "%2Fetc/passwd", "C:/a.png"}) {
    EXPECT_TRUE(says(notes_of(uri), "glTF allows no absolute names")) << uri;
  }
  EXPECT_TRUE(says(notes_of("../a.png"), "there is no such file"));
}

// Everything that readers say of a file that is no part of a scene.
TEST_F(References, ToOtherFilesAreNotQuoted) {
  const auto said = [&](const std::string& name, const std::string& content) {
    std::string all;
    try {
      const Scene scene = read_file("own/" + name, content);
      for (const std::string& note : scene.notes) all += note + "\n";
      for (const std::string& loss : scene.losses) all += loss + "\n";
    } catch (const InputError& error) {
      all = error.what();
    }
    return all;
  };
  const std::vector<std::pair<std::string, std::string>> scenes = {
      {"cat.rad", polygon_of_radiance + "!cat ../secret\n"},
      {"prism.rad", polygon_of_radiance + "!genprism grey p ../secret\n"},
      {"formula.rad", polygon_of_radiance + "!genrev grey p KEY 1 4 -f ../secret\n"},
      {"definition.rad", polygon_of_radiance + "!genrev grey p t 1 4 -f ../secret\n"},
      {"project.rif", "scene = ../secret\n"},
      {"library.obj", "mtllib ../secret\nusemtl a\n" + triangle},
      {"spectrum.toml", "[materials.grey]\nreflectance = { file = '../secret' }\n" + floor_of_grey},
      {"lamp.toml", grey + floor_of_grey +
                        "[[lamps]]\nposition = [0,0,1]\naim = [0,0,-1]\nfile = '../secret'\n"},
      {"include.xml", mitsuba("<include filename=\"../secret\"/>")}};
  for (const auto& [name, content] : scenes) {
    const std::string all = said(name, content);
    EXPECT_EQ(all.find("hunter2"), std::string::npos) << name << ": " << all;
    EXPECT_EQ(all.find("root"), std::string::npos) << name << ": " << all;
  }
  EXPECT_TRUE(says(said("cat.rad", scenes[0].second), "secret:1: this is no primitive"));
}

TEST_F(References, ToFilesAreInputsOfTheScene) {
  folder.write("own/sky.hdr", "#?RADIANCE\n");
  const FilesRead read;
  EXPECT_THROW(
      read_file("own/sky.toml", grey + floor_of_grey + "[sky]\nkind = 'map'\nfile = 'sky.hdr'\n"),
      InputError);
  EXPECT_EQ(read.files().size(), 2u);
}

TEST(Excerpt, IsShort) {
  EXPECT_EQ(excerpt("word"), "word");
  EXPECT_EQ(excerpt(std::string(1000, 'a')), std::string(40, 'a') + "...");
}

}  // namespace
}  // namespace lightwell::references_test
