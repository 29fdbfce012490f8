#include "scene/io/round_facets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/round_shape.h"

namespace lightwell::round_facets_test {
namespace {

using Eigen::Vector3d;

TEST(RoundFacets, HaveTheAreaAndTheFrontOfTheShape) {
  const Vector3d axis = Vector3d(1, -2, 2);
  for (const bool inward : {false, true}) {
    for (const double height : {0.0, 0.7}) {
      for (const double top : {0.0, 0.2, 0.9}) {
        const Frustum f = frustum_about({1, 2, 3}, axis, height, 0.5, top, inward);
        const PolygonMesh mesh = facets_of(f);
        const Surface surface{.shape = mesh};
        // Edges of 32 facets, less than 3 m around each, shift by two roundings of coordinates
        // below 4 m.
        constexpr double rounding = 32 * 3.0 * 2 * 0x1p-53 * 4.0;  // 8.5e-14 m^2
        EXPECT_NEAR(surface_area(surface), area(f), rounding);
        for (const Facet& facet : mesh.facets) {
          Vector3d middle = Vector3d::Zero();
          for (const int v : facet.boundary) middle += mesh.vertices[static_cast<std::size_t>(v)];
          middle /= static_cast<double>(facet.boundary.size());
          // No farther apart than the normals of the middle and of an edge: half a side, 5.6
          // degrees.
          EXPECT_GT(facet_normal(mesh, facet).dot(front_normal(f, middle)),
                    std::cos(std::numbers::pi / 32));
        }
      }
    }
  }
}

TEST(RoundFacets, ReplaceShapesThatShineOrLieOnOthers) {
  Scene scene;
  const auto paint = [&](float exitance) {
    scene.materials.push_back({.reflectance = Spectrum::Zero(3),
                               .specular = Spectrum::Zero(3),
                               .emission = Spectrum::Constant(3, exitance)});
    return static_cast<int>(scene.materials.size()) - 1;
  };
  const int dark = paint(0.0f), bright = paint(1.0f);
  PolygonMesh floor{.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}},
                    .facets = {{.boundary = {0, 1, 2, 3}}}};
  scene.surfaces = {{.name = "floor", .material = dark, .shape = floor}};
  const auto add = [&](const std::string& name, int material, const Frustum& frustum) {
    scene.surfaces.push_back({.name = name, .material = material, .shape = frustum});
  };
  const Vector3d up = Vector3d::UnitZ();
  add("leg", dark, frustum_about({1, 1, 0}, up, 0.7, 0.1, 0.1, false));
  add("tube", bright, frustum_about({1, 1, 2}, up, 0.7, 0.1, 0.1, false));
  add("rug", dark, frustum_about({2, 2, 0}, -up, 0.0, 0.8, 0.0, true));
  add("table", dark, frustum_about({1, 1, 0.7}, up, 0.0, 0.5, 0.0, false));
  add("beside", dark, frustum_about({9, 9, 0}, up, 0.0, 0.5, 0.0, false));
  replace_by_facets(scene);
  const auto is_exact = [&](std::size_t s) {
    return std::holds_alternative<Frustum>(scene.surfaces[s].shape);
  };
  EXPECT_TRUE(is_exact(1));
  EXPECT_FALSE(is_exact(2));
  EXPECT_FALSE(is_exact(3));
  EXPECT_TRUE(is_exact(4));
  EXPECT_TRUE(is_exact(5));
  EXPECT_EQ(scene.losses.size(), 2u);
}

}  // namespace
}  // namespace lightwell::round_facets_test
