#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "scene/errors.h"
#include "scene/io/read_scene.h"
#include "tests/temporary_folder.h"

namespace lightwell::read_geometry_test {
namespace {

struct Cube {
  const char* file;
  std::size_t facets;
};

class CubeFile : public testing::TestWithParam<Cube> {};

TEST_P(CubeFile, IsAClosedUnitCubeOfEightVertices) {
  const Scene scene = read_scene(std::string(LIGHTWELL_TEST_DATA "/scene/") + GetParam().file);
  ASSERT_EQ(scene.surfaces.size(), 1u);
  const auto& mesh = std::get<PolygonMesh>(scene.surfaces[0].shape);
  EXPECT_EQ(mesh.vertices.size(), 8u) << "identical vertices are joined";
  EXPECT_EQ(mesh.facets.size(), GetParam().facets);
  double area = 0.0, volume = 0.0;
  for (const Facet& f : mesh.facets) {
    area += facet_area(mesh, f);
    volume += mesh.vertices[static_cast<std::size_t>(f.boundary[0])].dot(facet_normal(mesh, f)) *
              facet_area(mesh, f) / 3.0;
  }
  EXPECT_DOUBLE_EQ(area, 6.0);
  EXPECT_DOUBLE_EQ(volume, 1.0) << "faces outwards";
  EXPECT_TRUE((scene.materials[0].reflectance == 0.5f).all());
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_NE(scene.notes[0].find("0.5"), std::string::npos);
}
INSTANTIATE_TEST_SUITE_P(Formats, CubeFile,
                         testing::Values(Cube{"cube.ply", 6}, Cube{"cube.stl", 12}),
                         [](const auto& p) { return std::string(p.param.file).substr(5); });

TEST(ReadGeometry, MetresPerUnitScales) {
  const Scene scene = read_geometry(LIGHTWELL_TEST_DATA "/scene/cube.ply", 0.001);
  EXPECT_TRUE(scene_bounds(scene).high.isApprox(Eigen::Vector3d::Constant(0.001), 1e-15));
}

// A unit square that faces +z, as its file stores numbers.
std::string square(
    const std::string& format, const std::string& values,
    const std::string& polygons = "element face 1\nproperty list uchar int vertex_index") {
  return "ply\nformat " + format + " 1.0\ncomment a square\nelement vertex 4\nproperty float x\n" +
         "property float y\nproperty float z\nproperty uchar red\n" + polygons + "\nend_header\n" +
         values;
}

template <class Number>
std::string stored(Number number, bool is_big) {
  std::string bytes(reinterpret_cast<const char*>(&number), sizeof number);
  if (is_big) std::ranges::reverse(bytes);
  return bytes;
}

std::string stored_square(bool is_big) {
  std::string values;
  for (const auto& [x, y] : {std::pair{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}}) {
    values += stored(x, is_big) + stored(y, is_big) + stored(0.0f, is_big) + '\xff';
  }
  values += '\4';
  for (const std::int32_t corner : {0, 1, 2, 3}) values += stored(corner, is_big);
  return values;
}

PolygonMesh read_ply(const std::string& content) {
  const TemporaryFolder folder;
  return std::get<PolygonMesh>(read_scene(folder.write("a.ply", content)).surfaces.at(0).shape);
}

void expect_square(const PolygonMesh& mesh, std::size_t facets) {
  ASSERT_EQ(mesh.facets.size(), facets);
  double area = 0.0;
  for (const Facet& facet : mesh.facets) {
    area += facet_area(mesh, facet);
    EXPECT_EQ(facet_normal(mesh, facet), Eigen::Vector3d::UnitZ());
  }
  EXPECT_EQ(area, 1.0);
}

TEST(ReadPly, OfEveryFormatIsTheSame) {
  expect_square(read_ply(square("ascii", "0 0 0 9 1 0 0 9\n1 1 0 9\n0 1 0 9\n4 0 1 2 3\n")), 1);
  expect_square(read_ply(square("binary_little_endian", stored_square(false))), 1);
  expect_square(read_ply(square("binary_big_endian", stored_square(true))), 1);
}

TEST(ReadPly, StripsAreTrianglesOfOneFront) {
  const std::string strips = "element tristrips 1\nproperty list int int vertex_indices";
  const std::string vertices = "0 0 0 9\n1 0 0 9\n0 1 0 9\n1 1 0 9\n";
  expect_square(read_ply(square("ascii", vertices + "4 0 1 2 3\n", strips)), 2);
  expect_square(read_ply(square("ascii", vertices + "7 0 1 2 -1 2 1 3\n", strips)), 2);
}

// Programs write vertices that they could not compute in several ways.
TEST(ReadPly, AVertexWithoutNumbersCostsItsPolygonsAlone) {
  const std::string faces = "element face 2\nproperty list uchar int vertex_index";
  for (const std::string word : {"nan", "-inf", "-nan(ind)", "1.#QNAN", "1e999"}) {
    const std::string vertices = "0 0 0 9\n1 0 0 9\n1 1 0 9\n0 " + word + " 0 9\n";
    const TemporaryFolder folder;
    const Scene scene =
        read_scene(folder.write("a.ply", square("ascii", vertices + "3 0 1 2\n3 0 2 3\n", faces)));
    EXPECT_EQ(std::get<PolygonMesh>(scene.surfaces.at(0).shape).facets.size(), 1u) << word;
    ASSERT_EQ(scene.losses.size(), 1u) << word;
    EXPECT_TRUE(says(scene.losses[0], "1 polygon with a vertex that has no finite coordinates"));
    EXPECT_TRUE(says(scene.losses[0], "a.ply: vertex 3 has"));
  }
}

TEST(ReadPly, AByteOrderMarkIsNoPartOfTheFile) {
  expect_square(
      read_ply("\xef\xbb\xbf" + square("ascii", "0 0 0 9 1 0 0 9\n1 1 0 9\n0 1 0 9\n4 0 1 2 3\n")),
      1);
}

TEST(ReadPly, WrongBodiesAreRefusedWithThePlace) {
  const auto refusal = [](const std::string& polygons) {
    return message_of<InputError>(
        [&] { read_ply(square("ascii", "0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0 9\n" + polygons)); });
  };
  EXPECT_TRUE(says(refusal("4000000000 0 1 2 3\n"), "the file ends within 'face'"));
  EXPECT_TRUE(says(refusal("-1 0 1 2 3\n"), "a 'face' has the number -1"));
  EXPECT_TRUE(says(refusal("4 0 1 two 3\n"), "a 'face' has 'two' in place of a number"));
  EXPECT_TRUE(says(refusal("4 0 1 2 4\n"), "names vertex 4, but there are only 4"));
}

}  // namespace
}  // namespace lightwell::read_geometry_test
