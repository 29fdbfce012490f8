#include <gtest/gtest.h>

#include "scene/io/read_scene.h"

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

}  // namespace
}  // namespace lightwell::read_geometry_test
