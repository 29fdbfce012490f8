// Small files do not grow to scenes that fill the memory: copies are counted before they are made.
#include "scene/io/scene_size.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/io/numbered_names.h"
#include "scene/io/text_file.h"
#include "tests/scene/expected_messages.h"
#include "tests/scene/gltf_text.h"
#include "tests/scene/scene_file_test.h"

namespace lightwell::scene_size_test {
namespace {

void refuse(const std::string& sentence) {
  throw LimitError(sentence);
}

// A polygon with many corners amounts to many triangles, and is read quickly.
constexpr int corners = 2000;
constexpr auto one_too_many = static_cast<int>(most_copied_triangles / (corners - 2) + 1);

std::string round_polygon(const std::string& before, const std::string& after) {
  std::string text;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    text += before + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) +
            " 0" + after;
  }
  return text;
}

std::string repeated(const std::string& text, int times) {
  std::string result;
  for (int i = 0; i < times; ++i) result += text;
  return result;
}

class SceneSizes : public test::SceneFileTest {
 protected:
  SceneSizes() {
    std::string face = "f";
    for (int i = 1; i <= corners; ++i) face += " " + std::to_string(i);
    folder.write("round.obj", round_polygon("v ", "\n") + face + "\n");
  }
  void expect_refused(const std::string& name, const std::string& content,
                      const std::string& place = "copies.") const {
    test::expect_message([&] { read_file(name, content); },
                         {place, "brings the scene to", "triangles", "use fewer copies"});
  }
};

TEST(SceneSize, GrowsWithTheBytesOfItsFiles) {
  const TemporaryFolder folder;
  SceneSize alone;
  EXPECT_NO_THROW(alone.add(most_copied_triangles, refuse));
  EXPECT_THROW(alone.add(1, refuse), LimitError);
  const FilesRead read;
  SceneSize with_file;
  constexpr int more = 10;
  require_readable(folder.write("file", std::string(more * bytes_per_triangle, ' ')));
  EXPECT_NO_THROW(with_file.add(most_copied_triangles + more, refuse));
  EXPECT_THROW(with_file.add(1, refuse), LimitError);
}

TEST(SceneSize, CountsAtLeastTheTrianglesOfAPolygon) {
  EXPECT_EQ(triangles_of(3), 1);
  EXPECT_EQ(triangles_of(std::size_t{corners}), corners - 2);
  // A square with a square hole is cut into 8 triangles.
  PolygonMesh mesh;
  mesh.facets.push_back({.boundary = {0, 1, 2, 3}, .holes = {{4, 5, 6, 7}}});
  EXPECT_EQ(triangles_of(mesh), 8);
}

TEST_F(SceneSizes, LimitInstancesOfMitsuba) {
  const std::string shape =
      R"(<shape type="obj"><string name="filename" value="round.obj"/></shape>)";
  const std::string group =
      R"(<shape type="shapegroup" id="g">)" + repeated(shape, 50) + "</shape>";
  expect_refused("copies.xml", "<scene version=\"3.0.0\">" + group +
                                   repeated(R"(<shape type="instance"><ref id="g"/></shape>)",
                                            one_too_many / 50 + 1) +
                                   "</scene>");
}

TEST_F(SceneSizes, LimitMeshesOfToml) {
  std::string content = "[materials.grey]\nreflectance = 0.5\n";
  constexpr int by_size = 50;  // those that the size of the file allows
  for (int i = 0; i < one_too_many + by_size; ++i) {
    content += "[[surfaces]]\nmaterial = 'grey'\nmesh = 'round.obj'\n";
  }
  expect_refused("copies.toml", content);
}

TEST_F(SceneSizes, LimitArraysOfRadiance) {
  folder.write("round.rad", "grey polygon p 0 0 " + std::to_string(3 * corners) + " " +
                                round_polygon(" ", "\n"));
  expect_refused("copies.rad", "void plastic grey 0 0 5 .5 .5 .5 0 0\n!xform -a 100000 round.rad\n",
                 "round.rad:1");
}

// A strip that stays in one place has no area and is dropped, yet takes its time.
TEST_F(SceneSizes, LimitMeshesOfGltf) {
  constexpr int strip = 60'000;
  const std::vector<std::uint16_t> indices(strip, 0);
  std::string nodes;
  for (int i = 0; i < most_copied_triangles / strip + 2; ++i) nodes += R"({"mesh":0},)";
  nodes.pop_back();
  expect_refused("copies.gltf",
                 square_gltf(R"(,"nodes":[)" + nodes + "]", R"(,"mode":5)", indices));
}

TEST_F(SceneSizes, NestedOptionsOfXformAreLimited) {
  folder.write("part.rad", "grey polygon p 0 0 9 0 0 0 1 0 0 0 1 0\n");
  test::expect_message(
      [&] {
        read_file("deep.rad", "void plastic grey 0 0 5 .5 .5 .5 0 0\n!xform " +
                                  repeated("-i 1 ", 200'000) + "part.rad\n");
      },
      {"deep.rad:2", "more than 1000 of the options -i and -a"});
}

TEST(NumberedNames, AreShort) {
  NumberedNames names;
  const std::string name = std::string(249, 'a') + "\xc3\xa9" + std::string(100'000, 'b');
  EXPECT_EQ(names.unique(name), std::string(249, 'a')) << "no half of a character";
  EXPECT_EQ(names.unique(name), std::string(249, 'a') + " 2");
}

}  // namespace
}  // namespace lightwell::scene_size_test
