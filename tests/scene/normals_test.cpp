// Vertex normals in readers, and the smooth surface that they define over facets.
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>

#include "scene/facet_normals.h"
#include "scene/io/corner_maps.h"
#include "scene/io/placed_mesh.h"
#include "scene/io/polygon.h"
#include "scene/io/polygon_repair.h"
#include "scene/optics.h"
#include "scene/sampling.h"
#include "tests/scene/gltf_text.h"
#include "tests/scene/scene_file_test.h"

namespace lightwell::normals_test {
namespace {

using Eigen::Vector3d;

class Normals : public test::SceneFileTest {};

// A quarter of a cylinder of radius 1 about z, with chords counter-clockwise as seen from outside.
std::string quarter_cylinder(bool with_normals) {
  std::ostringstream text;
  for (int i = 0; i <= 4; ++i) {
    const double x = std::cos(std::numbers::pi / 8.0 * i), y = std::sin(std::numbers::pi / 8.0 * i);
    for (const int z : {0, 1}) {
      text << "v " << x << ' ' << y << ' ' << z << "\nvn " << x << ' ' << y << " 0\n";
    }
  }
  const auto face = [&](const std::array<int, 3>& corners) {
    text << 'f';
    for (const int c : corners) {
      text << ' ' << c;
      if (with_normals) text << "//" << c;
    }
    text << '\n';
  };
  for (int i = 0; i < 4; ++i) {
    const int a = 2 * i + 1;  // bottom, then top; the next two are a + 2, a + 3
    face({a, a + 2, a + 3});
    face({a, a + 3, a + 1});
  }
  return text.str();
}

const PolygonMesh& mesh_of(const Scene& scene) {
  return std::get<PolygonMesh>(scene.surfaces.at(0).shape);
}

TEST(NormalMap, IsLinearOverASphereAndNoneOverWhatIsFlat) {
  // Corners of one quadrilateral of latitude and longitude: n = p on the unit sphere.
  Loop loop;
  for (const auto& [latitude, longitude] :
       {std::pair(0.2, 0.1), {0.2, 0.4}, {0.5, 0.4}, {0.5, 0.1}}) {
    loop.emplace_back(std::cos(latitude) * std::cos(longitude),
                      std::cos(latitude) * std::sin(longitude), std::sin(latitude));
  }
  const auto map = normal_map_over(loop, loop);
  ASSERT_TRUE(map);
  const Vector3d middle = 0.25 * (loop[0] + loop[1] + loop[2] + loop[3]);
  EXPECT_LT((map->at(middle) - middle).norm(), 1e-9);

  const Vector3d flat = (loop[1] - loop[0]).cross(loop[2] - loop[0]);
  EXPECT_FALSE(normal_map_over(loop, NormalLoop(4, flat)));
  EXPECT_TRUE(is_even(loop, NormalLoop(4, flat)));
}

TEST(NormalMap, OfWhatIsNoNormalIsNone) {
  const Loop loop = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  const Vector3d up(0.1, 0, 1);
  for (const Vector3d& bad : {Vector3d(0, 0, 0), Vector3d(std::nan(""), 0, 1), Vector3d(1, 0, 0),
                              Vector3d(0, 0, HUGE_VAL)}) {
    EXPECT_FALSE(normal_map_over(loop, {up, up, bad}));
  }
  EXPECT_FALSE(normal_map_over(loop, {up, up})) << "one short";
  EXPECT_TRUE(normal_map_over(loop, {-up, -up, -2.0 * up})) << "of any length and either side";
}

TEST_F(Normals, OfObjFilesAreReadAndTrianglesOfOneChordShareThem) {
  const Scene scene = read_file("bent.obj", quarter_cylinder(true));
  const PolygonMesh& mesh = mesh_of(scene);
  ASSERT_EQ(mesh.facets.size(), 8u);
  EXPECT_EQ(mesh.normal_maps.size(), 4u);
  const FacetNormals normals(scene);
  for (int f = 0; f < 8; ++f) {
    const Facet& facet = mesh.facets[static_cast<std::size_t>(f)];
    const Vector3d flat = facet_normal(mesh, facet);
    EXPECT_TRUE(normals.is_given(f));
    for (const int v : facet.boundary) {
      const Vector3d& p = mesh.vertices[static_cast<std::size_t>(v)];
      EXPECT_LT((normals.at(f, p, flat) - Vector3d(p.x(), p.y(), 0)).norm(), 1e-5);
      EXPECT_LT((normals.at(f, p, -flat) + Vector3d(p.x(), p.y(), 0)).norm(), 1e-5) << "behind";
      EXPECT_NEAR(normals.height(f, p, flat), 0.0, 1e-6);
    }
  }
  EXPECT_TRUE(FacetNormals(read_file("flat.obj", quarter_cylinder(false))).is_empty());
}

TEST_F(Normals, ThatMeanNothingLeaveTheFileReadable) {
  const Scene scene = read_file("odd.obj",
                                "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn what is this\nvn 0 0\n"
                                "f 1//1 2//2 3//9\nf 1//1 2//2 3//1\n");
  EXPECT_TRUE(mesh_of(scene).normal_maps.empty());
}

TEST_F(Normals, OfGltfFilesTurnWithTheirNode) {
  const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::vector<float> normals = {0.2f, 0, 1, 0.2f, 0, 1, -0.2f, 0, 1};
  std::string bytes(reinterpret_cast<const char*>(positions.data()), 36);
  bytes.append(reinterpret_cast<const char*>(normals.data()), 36);
  folder.write("mesh.bin", bytes);
  // A quarter turn about x: y becomes z, z becomes -y.
  const Scene scene = read_file("mesh.gltf", R"({"asset": {"version": "2.0"}, "scene": 0,
    "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0, "rotation": [0.70710678, 0, 0, 0.70710678]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}}]}],
    "buffers": [{"uri": "mesh.bin", "byteLength": 72}],
    "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36},
                    {"buffer": 0, "byteOffset": 36, "byteLength": 36}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                  {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"}]})");
  const FacetNormals found(scene);
  ASSERT_FALSE(found.is_empty());
  const Vector3d flat = facet_normal(mesh_of(scene), mesh_of(scene).facets[0]);
  EXPECT_LT((found.at(0, {0, 0, 0}, flat) - Vector3d(0.2, -1, 0).normalized()).norm(), 1e-6);
}

TEST_F(Normals, OfTomlMeshesAreTurnedScaledAndTakenAway) {
  folder.write("bent.obj", quarter_cylinder(true));
  const auto scene_with = [&](const std::string& more) {
    return read_file(
        "scene.toml",
        "[materials.m]\nreflectance = 0.5\n[[surfaces]]\nmesh = \"bent.obj\"\nmaterial = "
        "\"m\"\nscale = 2.0\nrotate = [90.0, 0.0, 0.0]\ntranslate = [5.0, 0.0, 0.0]\n" +
            more);
  };
  const Scene scene = scene_with("");
  const FacetNormals normals(scene);
  const Facet& facet = mesh_of(scene).facets[0];
  const Vector3d flat = facet_normal(mesh_of(scene), facet);
  for (const int v : facet.boundary) {
    Vector3d out = mesh_of(scene).vertices[static_cast<std::size_t>(v)] - Vector3d(5, 0, 0);
    out.y() = 0.0;  // the axis is now y
    EXPECT_LT((normals.at(0, mesh_of(scene).vertices[static_cast<std::size_t>(v)], flat) -
               out.normalized())
                  .norm(),
              1e-5);
  }
  EXPECT_TRUE(FacetNormals(scene_with("smooth = false\n")).is_empty());
  EXPECT_NE(scene_hash(scene), scene_hash(scene_with("smooth = false\n")));
}

TEST_F(Normals, OfMitsubaShapesAreLeftOutWhereFacesSayTheirs) {
  folder.write("bent.obj", quarter_cylinder(true));
  const auto scene_with = [&](const std::string& more) {
    return read_file(
        "scene.xml",
        R"(<scene version="3.0.0"><shape type="obj"><string name="filename" value="bent.obj"/>)" +
            more + "</shape></scene>");
  };
  EXPECT_FALSE(FacetNormals(scene_with("")).is_empty());
  EXPECT_TRUE(
      FacetNormals(scene_with(R"(<boolean name="face_normals" value="true"/>)")).is_empty());
}

TEST(FacetNormals, HeightIsThatOfTheSphereBehindAFacet) {
  Scene scene;
  Repairs repairs;
  scene.surfaces.push_back({.shape = placed_loops(sphere_loops(), Eigen::Affine3d::Identity(),
                                                  false, repairs, {}, sphere_loops())});
  const PolygonMesh& mesh = mesh_of(scene);
  const FacetNormals normals(scene);
  const double radius = mesh.vertices[0].norm();
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const Facet& facet = mesh.facets[f];
    const Vector3d flat = facet_normal(mesh, facet);
    Vector3d middle = Vector3d::Zero();
    for (const int v : facet.boundary) middle += mesh.vertices[static_cast<std::size_t>(v)];
    middle /= static_cast<double>(facet.boundary.size());
    const double exact = radius - middle.norm();
    // A parabola in place of a circle has an error of h / (2 r) of the height h, at most 0.01 r.
    EXPECT_NEAR(normals.height(static_cast<int>(f), middle, flat), exact, 0.005 * exact);
    EXPECT_EQ(normals.height(static_cast<int>(f), middle, -flat), 0.0) << "hollow from behind";
    // Linear interpolation in the plane gives a sphere's normals exactly, except for float
    // rounding.
    EXPECT_LT((normals.at(static_cast<int>(f), middle, flat) - middle.normalized()).norm(), 1e-6);
  }
}

TEST(VisibleNormal, MirrorsNothingBelowTheSurface) {
  const Vector3d flat = Vector3d::UnitZ();
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const auto u = [&](std::uint64_t k) { return random_uniform(random_key(i, k)); };
    const double z = u(0), phi = 2.0 * std::numbers::pi * u(1);
    const double s = std::sqrt(1.0 - z * z);
    const Vector3d direction(s * std::cos(phi), s * std::sin(phi), -z);
    const Vector3d smooth = (flat + Vector3d(2.0 * u(2) - 1.0, 2.0 * u(3) - 1.0, 0.0)).normalized();
    const Vector3d normal = visible_normal(direction, flat, smooth);
    EXPECT_NEAR(normal.norm(), 1.0, 1e-12);
    EXPECT_GE(reflect(direction, normal).dot(flat), 0.0);
    EXPECT_LE(direction.dot(normal), 1e-12) << "seen from before";
    if (reflect(direction, smooth).dot(flat) > 0.01) {
      EXPECT_EQ(normal, smooth);
    }
  }
}

}  // namespace
}  // namespace lightwell::normals_test
