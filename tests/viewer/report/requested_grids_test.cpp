#include "viewer/report/requested_grids.h"

#include <gtest/gtest.h>

#include "mesh/build_patches.h"
#include "scene/errors.h"

namespace lightwell::requested_grids_test {
namespace {

using Corners = std::vector<Eigen::Vector3d>;

void add_polygon(const std::string& name, int material, const Corners& corners, Scene& scene) {
  PolygonMesh mesh;
  mesh.vertices = corners;
  mesh.facets.emplace_back();
  for (int v = 0; v < static_cast<int>(corners.size()); ++v) {
    mesh.facets.back().boundary.push_back(v);
  }
  scene.surfaces.push_back({.name = name, .material = material, .shape = mesh});
}

// Two storeys of 4 x 3 x 2.5 m, whose floors and ceilings all have their fronts downwards: that of
// a floor faces out of its room, that of a ceiling into it.
Scene two_storeys() {
  Scene scene;
  scene.bands = rgb_bands(683.0);
  Material white;
  white.name = "white";
  white.reflectance = constant_spectrum(scene.bands, 0.5f);
  white.specular = white.emission = constant_spectrum(scene.bands, 0.0f);
  Material grey = white;
  grey.name = "grey carpet";
  scene.materials = {white, grey};
  const auto level = [](double z) { return Corners{{0, 3, z}, {4, 3, z}, {4, 0, z}, {0, 0, z}}; };
  add_polygon("lower floor", 1, level(0.0), scene);
  add_polygon("upper floor", 1, level(2.5), scene);
  add_polygon("ceiling", 0, level(5.0), scene);
  const Corners plan = {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}};
  const Eigen::Vector3d height(0, 0, 5);
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const Eigen::Vector3d &a = plan[i], &b = plan[(i + 1) % plan.size()];
    add_polygon("wall", 0, {b, a, a + height, b + height}, scene);
  }
  return scene;
}

std::vector<LuxGrid> grids(const GridRequest& asked, const Scene& scene) {
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 2.0});
  const ElementCaster caster(mesh);
  return requested_grids(asked, {}, scene, caster, Eigen::Vector3d::UnitZ());
}

GridRequest plane(const std::string& name, double height) {
  return {.planes = {{name, height}}};
}

TEST(RequestedGrids, PlanesLieAboveFloorsWhoseFrontsFaceDown) {
  const Scene scene = two_storeys();
  for (const auto& [name, z] : {std::pair("lower floor", 0.0), std::pair("upper floor", 2.5)}) {
    const std::vector<LuxGrid> found = grids(plane(name, 0.75), scene);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_DOUBLE_EQ(found[0].points[0].position.z(), z + 0.75) << name;
    EXPECT_EQ(found[0].points[0].normal, Eigen::Vector3d::UnitZ()) << name;
  }
}

TEST(RequestedGrids, SurfacesAndPlanesWithoutHeightHaveTheSameSide) {
  const Scene scene = two_storeys();
  EXPECT_EQ(grids(plane("lower floor", 0.0), scene)[0].points[0].normal, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(grids({.surfaces = {"lower floor"}}, scene)[0].points[0].normal,
            Eigen::Vector3d::UnitZ());
  EXPECT_EQ(grids({.surfaces = {"ceiling"}}, scene)[0].points[0].normal,
            Eigen::Vector3d(-Eigen::Vector3d::UnitZ()));
}

// A court whose paving lies just above a slab, with nothing around.
TEST(RequestedGrids, PlanesLieAboveACourtOverASlab) {
  Scene scene = two_storeys();
  scene.surfaces.clear();
  for (const double z : {0.0, -0.02}) {
    add_polygon(z < 0.0 ? "slab" : "paving", 1, {{0, 3, z}, {4, 3, z}, {4, 0, z}, {0, 0, z}},
                scene);
  }
  EXPECT_DOUBLE_EQ(grids(plane("paving", 0.8), scene)[0].points[0].position.z(), 0.8);
}

TEST(RequestedGrids, PlanesLieBelowCeilings) {
  const std::vector<LuxGrid> found = grids(plane("ceiling", 0.5), two_storeys());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_DOUBLE_EQ(found[0].points[0].position.z(), 4.5);
}

TEST(RequestedGrids, OneSidedFloorsKeepTheirFront) {
  Scene scene = two_storeys();
  scene.materials[1].one_sided = true;
  const std::vector<LuxGrid> found = grids(plane("lower floor", 0.75), scene);
  EXPECT_DOUBLE_EQ(found[0].points[0].position.z(), -0.75);
}

TEST(RequestedGrids, PatternsAskForAllSurfacesAndMaterialsThatFit) {
  const Scene scene = two_storeys();
  std::vector<LuxGrid> found = grids(plane("*floor", 0.75), scene);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].name, "lower floor + 0.75 m");
  EXPECT_EQ(found[1].name, "upper floor + 0.75 m");
  EXPECT_EQ(grids(plane("grey*", 0.75), scene).size(), 2u);
  EXPECT_EQ(grids({.surfaces = {"wall"}}, scene).size(), 1u) << "a name goes before patterns";
  // The strip without points leaves some of the walls of 4 m x 5 m, and nothing of the floors.
  GridRequest too_wide = plane("*", 0.75);
  too_wide.margin = 1.6;
  EXPECT_THROW(grids(too_wide, scene), InputError);
}

TEST(RequestedGrids, SurfacesThatAreNotThereAreRefusedBeforeTheWork) {
  const Scene scene = two_storeys();
  EXPECT_NO_THROW(require_surfaces(plane("*floor", 0.75), scene));
  try {
    require_surfaces(plane("lower flor", 0.75), scene);
    FAIL() << "a surface that is not there was found";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'lower floor'"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace lightwell::requested_grids_test
