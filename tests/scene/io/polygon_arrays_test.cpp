#include "scene/io/polygon_arrays.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <string>
#include <utility>

#include "scene/errors.h"
#include "scene/io/default_material.h"

namespace lightwell::polygon_arrays_test {
namespace {

// Two surfaces without shape.
Scene floor_and_wall() {
  Scene scene;
  scene.materials.push_back(default_material(scene.bands));
  scene.surfaces = {{.name = "floor"}, {.name = "wall"}};
  return scene;
}

// A square of the floor, a triangle of the wall, and a face without area.
PolygonArrays square_and_triangle() {
  return {.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}, {0, 0, 4}},
          .corners = {0, 1, 2, 3, 0, 1, 1, 0, 4, 1},
          .first = {0, 4, 7, 10},
          .surface = {0, 0, 1}};
}

double area_of(const PolygonArrays& triangles, int surface) {
  double area = 0.0;
  for (std::size_t t = 0; t < triangles.surface.size(); ++t) {
    if (triangles.surface[t] != surface) continue;
    const auto at = [&](std::size_t c) {
      return triangles.vertices[static_cast<std::size_t>(triangles.corners[3 * t + c])];
    };
    area += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
  }
  return area;
}

// Message of the InputError for arrays; "" if none is thrown.
std::string refusal(const PolygonArrays& polygons) {
  try {
    scene_of_polygons(floor_and_wall(), polygons);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SceneOfPolygons, KeepsTextureCoordinatesAndNormalsOfVertices) {
  PolygonArrays arrays = square_and_triangle();
  // u grows along x, v against y; normals lean outwards from the middle of the square.
  for (const Eigen::Vector3d& p : arrays.vertices) {
    arrays.uv.emplace_back(0.5 * p.x(), 1.0 - p.y() / 3.0);
    arrays.normals.emplace_back(0.2 * (p.x() - 1.0), 0.2 * (p.y() - 1.5), 1.0);
  }
  const NumberedScene numbered = scene_of_polygons(floor_and_wall(), arrays);
  const auto& mesh = std::get<PolygonMesh>(numbered.scene.surfaces[0].shape);
  ASSERT_EQ(mesh.uv_maps.size(), 1u);
  for (std::size_t v = 0; v < 4; ++v) {
    const Eigen::Vector2d uv =
        mesh.uv_maps[0].gradient * arrays.vertices[v] + mesh.uv_maps[0].offset;
    // The gradient comes from a system of three equations of numbers up to 3, in some 20 operations
    // that round by 3 * 2^-53 each: 6.7e-15.
    EXPECT_NEAR((uv - arrays.uv[v]).norm(), 0.0, 1e-14);
  }
  EXPECT_FALSE(mesh.normal_maps.empty());
  arrays.uv.pop_back();
  EXPECT_NE(refusal(arrays).find("every vertex needs texture"), std::string::npos);
}

TEST(SceneOfPolygons, NumbersFacetsByFaces) {
  const NumberedScene numbered = scene_of_polygons(floor_and_wall(), square_and_triangle());
  ASSERT_EQ(numbered.rows.size(), 3u);
  EXPECT_EQ(numbered.row_of_facet, (std::vector<int>{0, 2}));
  EXPECT_EQ(numbered.rows[0].name, "floor");
  EXPECT_EQ(numbered.rows[1].name, "floor");  // without area
  EXPECT_EQ(numbered.rows[2].name, "wall");
  EXPECT_EQ(numbered.scene.notes.size(), 1u);
  EXPECT_EQ(surface_area(numbered.scene.surfaces[0]), 6.0);  // 2 by 3, exact in floats
  EXPECT_EQ(surface_area(numbered.scene.surfaces[1]), 4.0);  // half of 2 by 4
}

TEST(SceneOfPolygons, LeavesOutSurfacesWithoutArea) {
  PolygonArrays polygons = square_and_triangle();
  polygons.surface = {0, 1, 0};
  const NumberedScene numbered = scene_of_polygons(floor_and_wall(), polygons);
  ASSERT_EQ(numbered.scene.surfaces.size(), 1u);
  EXPECT_EQ(numbered.scene.surfaces[0].name, "floor");
  EXPECT_EQ(numbered.scene.losses.size(), 2u);  // the polygon and the surface
}

TEST(SceneOfPolygons, RefusesWhatDoesNotFitWithASentence) {
  const PolygonArrays sound = square_and_triangle();
  PolygonArrays bad = sound;
  bad.corners[5] = 9;
  EXPECT_EQ(refusal(bad), "face 1 names vertex 9, but there are 5, counted from 0");
  bad = sound;
  bad.corners[0] = -1;
  EXPECT_EQ(refusal(bad), "face 0 names vertex -1, but there are 5, counted from 0");
  bad = sound;
  bad.surface[2] = 2;
  EXPECT_EQ(refusal(bad), "face 2 is of surface 2, but there are 2, counted from 0");
  bad = sound;
  bad.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal(bad).find("vertex 3 has a coordinate that is not a finite number"),
            std::string::npos);
  for (const std::vector<std::size_t>& first :
       {std::vector<std::size_t>{}, {0, 4, 7}, {1, 4, 7, 10}, {0, 4, 7, 11}, {0, 7, 4, 10}}) {
    bad = sound;
    bad.first = first;
    EXPECT_NE(refusal(bad).find("do not fit each other"), std::string::npos);
  }
  bad = sound;
  bad.vertices.assign(5, Eigen::Vector3d::Ones());
  EXPECT_NE(refusal(bad).find("no face has an area"), std::string::npos);
}

TEST(SceneTriangles, HaveTheAreaOfTheSurfaces) {
  Scene scene = scene_of_polygons(floor_and_wall(), square_and_triangle()).scene;
  PolygonMesh& floor = std::get<PolygonMesh>(scene.surfaces[0].shape);
  for (const auto& [x, y] : {std::pair(0.5, 0.5), {0.5, 1.5}, {1.5, 1.5}, {1.5, 0.5}}) {
    floor.vertices.push_back({x, y, 0});
  }
  floor.facets[0].holes = {{4, 5, 6, 7}};  // 1 by 1
  scene.surfaces.push_back({.name = "ball", .shape = Sphere{.radius = 2.0}});
  scene.surfaces.push_back({.name = "tube", .shape = Frustum{.height = 3.0}});
  const PolygonArrays triangles = scene_triangles(scene);
  EXPECT_EQ(triangles.first.size(), triangles.surface.size() + 1);
  // Sums of at most 2000 areas, each with a few roundings of 2^-53 of areas up to 50.
  constexpr double rounding = 2000 * 4 * 50 * 1.2e-16;
  EXPECT_NEAR(area_of(triangles, 0), 5.0, rounding);
  for (int s = 0; s < 4; ++s) {
    EXPECT_NEAR(area_of(triangles, s), surface_area(scene.surfaces[static_cast<std::size_t>(s)]),
                rounding);
  }
}

TEST(SceneTriangles, FaceAsThePolygonsDo) {
  const PolygonArrays triangles =
      scene_triangles(scene_of_polygons(floor_and_wall(), square_and_triangle()).scene);
  for (std::size_t t = 0; t < 2; ++t) {  // those of the floor
    const auto at = [&](std::size_t c) { return triangles.vertices[3 * t + c]; };
    EXPECT_GT((at(1) - at(0)).cross(at(2) - at(0)).z(), 0.0);
  }
}

}  // namespace
}  // namespace lightwell::polygon_arrays_test
