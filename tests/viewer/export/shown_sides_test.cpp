// Sides of thin surfaces that models have, in an office with a window under the sky.
#include "viewer/export/shown_sides.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "radiosity/solve.h"
#include "scene/io/read_scene.h"
#include "tests/temporary_folder.h"
#include "tests/viewer/glb_file.h"
#include "viewer/export/export.h"

namespace lightwell::shown_sides_test {
namespace {

// Two rooms of 3 m x 2 m x 2 m, each with a window, and a chest on the floor of the first.
constexpr const char* office_text = R"(
[sky]
kind = "uniform"
illuminance = 10000
up = [0, 0, 1]
north = [0, 1, 0]
[materials.plaster]
reflectance = 0.7
[[surfaces]]
name = "floor"
material = "plaster"
polygon = [[0, 0, 0], [6, 0, 0], [6, 2, 0], [0, 2, 0]]
[[surfaces]]
name = "ceiling"
material = "plaster"
polygon = [[0, 0, 2], [0, 2, 2], [6, 2, 2], [6, 0, 2]]
[[surfaces]]
name = "long walls"
material = "plaster"
polygons = [[[0, 0, 0], [0, 0, 2], [6, 0, 2], [6, 0, 0]], [[6, 2, 0], [6, 2, 2], [0, 2, 2], [0, 2, 0]]]
[[surfaces]]
name = "parapets"
material = "plaster"
polygons = [[[6, 0, 0], [6, 0, 1], [6, 2, 1], [6, 2, 0]], [[0, 2, 0], [0, 2, 1], [0, 0, 1], [0, 0, 0]]]
[[surfaces]]
name = "partition"
material = "plaster"
polygon = [[3, 0, 0], [3, 2, 0], [3, 2, 2], [3, 0, 2]]
[[surfaces]]
name = "chest"
material = "plaster"
box = { min = [1, 1, 0], max = [2, 1.5, 0.5] }
)";

struct Office {
  Scene scene{};
  SolvedScene solved{};

  explicit Office(const std::string& cameras = {}) {
    const TemporaryFolder folder;
    scene = read_scene(folder.write("office.toml", office_text + cameras));
    SolveOptions options{.mesh = {.max_patch_size = 0.5}, .gather = {.rays = 16}};
    options.refine.tolerance = 0.0;
    solved = solve_scene(scene, options);
  }
  BakedModel baked(Sides sides) const { return bake_model(solved, scene, 0.0, nullptr, sides); }
};

const Office& office() {
  static const Office made;
  return made;
}

using Triangle = std::array<Eigen::Vector3d, 3>;

std::vector<Triangle> triangles_in(const Glb& glb) {
  std::vector<Triangle> triangles;
  for (const auto& mesh : glb.json["meshes"]) {
    for (const auto& primitive : mesh["primitives"]) {
      const std::vector<float> at = floats(glb, primitive["attributes"]["POSITION"], 3);
      // Indices are 32 bits wide, as floats are.
      const std::vector<float> bits = floats(glb, primitive["indices"], 1);
      std::vector<std::uint32_t> index(bits.size());
      std::memcpy(index.data(), bits.data(), 4 * bits.size());
      for (std::size_t i = 0; i + 2 < index.size(); i += 3) {
        Triangle& t = triangles.emplace_back();
        for (std::size_t c = 0; c < 3; ++c) {
          const float* p = at.data() + std::size_t{3} * index[i + c];
          t[c] = {p[0], p[1], p[2]};
        }
      }
    }
  }
  return triangles;
}

Eigen::Vector3d normal_of(const Triangle& t) {
  return (t[1] - t[0]).cross(t[2] - t[0]).normalized();
}

/// Triangles whose centre lies in a triangle that faces the other way.
int count_coincident(const std::vector<Triangle>& triangles) {
  // Positions have an error of 2^-24 of 6 m, 0.4 um; sides that are moved apart are 1 mm apart.
  constexpr double touching = 1e-5;
  const auto covers = [](const Triangle& t, const Eigen::Vector3d& n, const Eigen::Vector3d& p) {
    for (std::size_t c = 0; c < 3; ++c) {
      if ((t[(c + 1) % 3] - t[c]).cross(p - t[c]).dot(n) <= 0.0) return false;
    }
    return std::abs((p - t[0]).dot(n)) < touching;
  };
  std::vector<Eigen::Vector3d> normals;
  for (const Triangle& t : triangles) normals.push_back(normal_of(t));
  int count = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    const Eigen::Vector3d center = (t[0] + t[1] + t[2]) / 3.0;
    for (std::size_t j = 0; j < triangles.size(); ++j) {
      if (normals[i].dot(normals[j]) > -0.999 || !covers(triangles[j], normals[j], center))
        continue;
      ++count;
      break;
    }
  }
  return count;
}

int coincident_in_glb(Sides sides) {
  const TemporaryFolder folder;
  write_gltf(folder / "office.glb", office().baked(sides));
  const auto triangles = triangles_in(parse_glb(content_of(folder / "office.glb")));
  EXPECT_GT(triangles.size(), 100u);
  return count_coincident(triangles);
}

/// Parts of a surface, and the mean illuminance of their vertices.
struct Shown {
  int parts = 0;
  double lux = 0.0;
};

Shown shown(const BakedModel& model, const std::string& name) {
  Shown result;
  int vertices = 0;
  for (const BakedPart& part : model.parts) {
    if (part.name != name) continue;
    ++result.parts;
    vertices += part.vertex_count;
    for (int v = 0; v < part.vertex_count; ++v) {
      result.lux += model.illuminance[static_cast<std::size_t>(part.first_vertex + v)];
    }
  }
  result.lux /= std::max(vertices, 1);
  return result;
}

TEST(ShownSides, NoTwoTrianglesOfADaylitRoomCoincideInGltf) {
  EXPECT_GT(coincident_in_glb(Sides::lit), 100);
  EXPECT_EQ(coincident_in_glb(Sides::front), 0);
  EXPECT_EQ(coincident_in_glb(Sides::both), 0);
}

TEST(ShownSides, FrontHasTheLightOfTheRooms) {
  const BakedModel lit = office().baked(Sides::lit), front = office().baked(Sides::front);
  for (const char* name : {"floor", "ceiling", "long walls", "parapets"}) {
    EXPECT_EQ(shown(lit, name).parts, 2) << name;
    EXPECT_EQ(shown(front, name).parts, 1) << name;
  }
  // The sky gives the roof 10000 lx; the ceiling gets what the ground and the room reflect.
  EXPECT_GT(shown(lit, "ceiling").lux, 5000.0);
  EXPECT_LT(shown(front, "ceiling").lux, 5000.0);
  EXPECT_EQ(shown(front, "partition").parts, 2) << "each room has its side";
}

/// Both sides of a partition are shown, 1 mm apart, and all else is in its place.
TEST(ShownSides, TwoShownSidesAreMovedApart) {
  const double gap = half_gap(office().solved.mesh);
  EXPECT_DOUBLE_EQ(gap, 5e-4);
  const BakedModel front = office().baked(Sides::front);
  for (const BakedPart& part : front.parts) {
    for (int v = part.first_vertex; v < part.first_vertex + part.vertex_count; ++v) {
      const Eigen::Vector3d& p = front.position[static_cast<std::size_t>(v)];
      const Eigen::Vector3d there =
          office().solved.mesh.position(front.mesh_vertex[static_cast<std::size_t>(v)]);
      if (part.name == "partition") {
        EXPECT_NEAR(std::abs(p.x() - 3.0), gap, 1e-12);
      } else {
        EXPECT_EQ(p, there) << part.name;
      }
    }
  }
}

/// A chest shows its five sides; its bottom and the insides are seen from nowhere.
TEST(ShownSides, NothingIsShownWithinAClosedBody) {
  for (const Sides sides : {Sides::front, Sides::both}) {
    const BakedModel model = office().baked(sides);
    EXPECT_EQ(shown(model, "chest").parts, 1);
    for (int f = 0; f < model.face_count(); ++f) {
      const auto face = static_cast<std::size_t>(f);
      const auto& corners = model.faces[face];
      const int p = office().solved.mesh.patch[model.element[face]];
      if (office().solved.mesh.surface[p] != 5) continue;
      double height = 0.0;
      for (int c = 0; c < model.corner_count(f); ++c) {
        height = std::max(height, model.position[static_cast<std::size_t>(corners[c])].z());
      }
      EXPECT_GT(height, 0.0);
    }
  }
}

TEST(ShownSides, ACameraOutsideSeesTheOutside) {
  const Office seen(R"(
[[cameras]]
name = "street"
position = [3, -5, 1]
look_at = [3, 0, 1]
up = [0, 0, 1]
)");
  const BakedModel front = seen.baked(Sides::front);
  EXPECT_EQ(shown(front, "long walls").parts, 2);
  EXPECT_EQ(shown(front, "ceiling").parts, 1);
}

}  // namespace
}  // namespace lightwell::shown_sides_test
