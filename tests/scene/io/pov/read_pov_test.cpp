#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "scene/io/glossy.h"
#include "scene/round_shape.h"
#include "tests/scene/expected_messages.h"
#include "tests/scene/scene_file_test.h"
#include "tests/scene/scene_questions.h"

namespace lightwell::read_pov_test {
namespace {

using std::numbers::pi;
using test::area_of;
using test::has_loss;
using test::has_note;
using test::mesh_of;

// Roundings of a few products of 2^-53, at sizes up to 10.
constexpr double rounding = 1e-13;
// Roundings of a few products of floats, 2^-24.
constexpr float float_rounding = 1e-6f;

class Pov : public test::SceneFileTest {
 protected:
  Scene read(const std::string& text) const { return read_file("a.pov", text); }
  Material material_of(const std::string& look, const std::string& shape = "sphere { 0, 1 ") const {
    return first_material(read(shape + look + " }"));
  }
};

double area(const Scene& scene) {
  double sum = 0.0;
  for (const Surface& surface : scene.surfaces) sum += surface_area(surface);
  return sum;
}

/// Largest coordinates of all surfaces.
Eigen::Vector3d high(const Scene& scene) {
  return scene_bounds(scene).high;
}

TEST_F(Pov, RoundShapesAreExact) {
  const Scene ball = read("sphere { <1, 2, 3>, 0.5 scale 2 }");
  const auto& sphere = std::get<Sphere>(ball.surfaces.at(0).shape);
  EXPECT_EQ(sphere.center, Eigen::Vector3d(2, 4, -6)) << "z is turned around";
  EXPECT_NEAR(sphere.radius, 1.0, rounding);
  EXPECT_NEAR(area(read("cylinder { 0, 2*y, 1 }")), (4.0 + 2.0) * pi, 4 * rounding);
  EXPECT_NEAR(area(read("cylinder { 0, 2*y, 1 open }")), 4.0 * pi, 4 * rounding);
  EXPECT_NEAR(area(read("cone { 0, 3, 4*y, 0 }")), (15.0 + 9.0) * pi, 10 * rounding);
  EXPECT_NEAR(area(read("disc { 0, y, 2, 1 }")), 3.0 * pi, 4 * rounding);
  // A profile like that of a cylinder makes the same surface.
  EXPECT_NEAR(area(read("lathe { linear_spline 4, <0, 0>, <1, 0>, <1, 2>, <0, 2> }")), 6.0 * pi,
              4 * rounding);
  EXPECT_NEAR(area(read("sor { 4, <1, -1>, <1, 0>, <1, 2>, <1, 3> }")), 6.0 * pi, 4 * rounding);
  EXPECT_TRUE(has_loss(read("sphere { 0, 1 scale <1, 2, 1> }"), "no longer round"));
}

TEST_F(Pov, BodiesHaveTheirFrontsOutside) {
  for (const char* text :
       {"sphere { 0, 1 }", "box { -1, 1 }", "cylinder { -y, y, 1 }", "cone { -y, 1, y, 0.5 }",
        "torus { 2, 0.5 }", "lathe { linear_spline 4, <0, -1>, <1, -1>, <1, 1>, <0, 1> }",
        "lathe { linear_spline 4, <0, 1>, <1, 1>, <1, -1>, <0, -1> }",
        "prism { -1, 1, 5, <-1, -1>, <1, -1>, <1, 1>, <-1, 1>, <-1, -1> }",
        "prism { -1, 1, 5, <-1, -1>, <-1, 1>, <1, 1>, <1, -1>, <-1, -1> }"}) {
    const Scene scene = read(text);
    double volume = 0.0;  // divergence theorem, by facets
    for (const Surface& surface : scene.surfaces) {
      if (const auto* mesh = std::get_if<PolygonMesh>(&surface.shape)) {
        for (const Facet& facet : mesh->facets) {
          const auto& p = mesh->vertices[static_cast<std::size_t>(facet.boundary[0])];
          volume += facet_area(*mesh, facet) * facet_normal(*mesh, facet).dot(p) / 3.0;
        }
      } else {
        const RoundShape shape = *round_shape(surface);
        const Eigen::Vector3d far = nearest_on(shape, {5.0, 7.0, 3.0});
        volume += front_normal(shape, far).dot(far);
      }
    }
    EXPECT_GT(volume, 0.5) << text;
  }
}

TEST_F(Pov, TransformationsFollowOneAnother) {
  // x towards y, then moved; z of the scene is the other way.
  const Scene turned = read("box { 0, <2, 1, 1> rotate z*90 translate <0, 0, 3> }");
  EXPECT_EQ(high(turned), Eigen::Vector3d(0, 2, -3));
  EXPECT_EQ(high(read("box { 0, 1 translate x scale <2, 3, 1> }")), Eigen::Vector3d(4, 3, 0));
  EXPECT_EQ(high(read("box { 0, 1 matrix <1, 0, 0, 0, 1, 0, 0, 0, 1, 5, 6, 7> }")),
            Eigen::Vector3d(6, 7, -7));
  EXPECT_EQ(high(read("#declare T = transform { translate 2*x inverse }\n"
                      "#declare B = box { 0, 1 transform T }\nobject { B translate 5*y }")),
            Eigen::Vector3d(-1, 6, 0));
}

TEST_F(Pov, GroupsHandDownTheirTexture) {
  const Scene scene = read(
      "union { box { 0, 1 } box { 2, 3 pigment { rgb 1 } finish { diffuse 0.5 } }\n"
      "  pigment { rgb 0.25 } finish { diffuse 1 } translate 10*x }");
  ASSERT_EQ(scene.surfaces.size(), 2u);
  const auto reflectance = [&](std::size_t s) {
    return scene.materials.at(static_cast<std::size_t>(scene.surfaces[s].material)).reflectance[0];
  };
  EXPECT_FLOAT_EQ(reflectance(0), 0.25f);
  EXPECT_FLOAT_EQ(reflectance(1), 0.5f);
  EXPECT_EQ(high(scene), Eigen::Vector3d(13, 3, 0));
}

TEST_F(Pov, MeshesKeepNormalsAndTextures) {
  const Scene scene = read(
      "#declare A = texture { pigment { rgb 0.2 } }\n#declare B = texture { pigment { rgb 0.4 } }\n"
      "mesh2 { vertex_vectors { 4, 0, x, x + y, y }\n"
      " texture_list { 2, texture { A } texture { B } }\n"
      " face_indices { 2, <0, 1, 2>, 0, <0, 2, 3>, 1 } }\n"
      "mesh { triangle { 0, x, y } smooth_triangle { 0, z, y, <0.5, 0, 1>, x, <-0.5, 0, 1> } }");
  ASSERT_EQ(scene.surfaces.size(), 3u);
  EXPECT_NE(scene.surfaces[0].material, scene.surfaces[1].material);
  EXPECT_NEAR(area(scene), 2.0, rounding);
  EXPECT_FALSE(mesh_of(scene, 2).normal_maps.empty());
  const Scene holed = read(
      "polygon { 10, <0, 0>, <3, 0>, <3, 3>, <0, 3>, <0, 0>, <1, 1>, <1, 2>, <2, 2>, <2, 1>, <1, "
      "1> }");
  EXPECT_NEAR(area(holed), 8.0, rounding);
  // Two rings of 8 m2, outer walls of 12 m2 and inner ones of 4 m2.
  const Scene tube = read(
      "prism { 0, 1, 10, <0, 0>, <3, 0>, <3, 3>, <0, 3>, <0, 0>, <1, 1>, <1, 2>, <2, 2>, <2, 1>, "
      "<1, "
      "1> }");
  EXPECT_NEAR(area(tube), 32.0, rounding);
}

TEST_F(Pov, ConvexBodiesAreCut) {
  const Scene room = read("difference { box { -1, 5 } box { 0, 4 } }");
  EXPECT_NEAR(area(room), 6.0 * 36.0 + 6.0 * 16.0, 100 * rounding);
  const Scene half = read("intersection { box { -1, 1 } plane { y, 0 } }");
  EXPECT_NEAR(area(half), 2.0 * 4.0 + 4.0 * 2.0, 100 * rounding);
  const Scene round_hole = read("difference { box { -1, 1 } sphere { 0, 1.2 } }");
  EXPECT_NEAR(area(round_hole), 24.0, rounding);
  EXPECT_TRUE(has_loss(round_hole, "not cut off"));
  EXPECT_TRUE(has_loss(read("box { 0, 1 } difference { sphere { 0, 1 } box { 0, 1 } }"),
                       "'difference' were left out"));
}

// Six planes make a room of exactly their distances.
TEST_F(Pov, PlanesEndAtEachOtherAndAroundAllElse) {
  const Scene room = read(
      "plane { y, 0 } plane { -y, -3 } plane { x, -2 } plane { -x, -2 } plane { z, -1 } plane { "
      "-z, "
      "-1 }\nsphere { y, 0.5 }\ncamera { location <0, 1, -0.5> look_at y }");
  EXPECT_NEAR(area(room), 2.0 * (8.0 + 12.0 + 6.0) + pi, 100 * rounding);
  const Scene floor = read("plane { y, -1 }\nbox { -1, 1 }");
  // The diagonal is sqrt(12); the square is four times as wide.
  EXPECT_NEAR(surface_area(floor.surfaces.at(1)), 16.0 * 12.0, 1e3 * rounding);
}

TEST_F(Pov, FinishesBecomeMaterials) {
  const Material paint = material_of("pigment { color rgb <1, 0.5, 0> }");
  EXPECT_NEAR(paint.reflectance[1], 0.3f, float_rounding) << "diffuse is 0.6 if it is not given";
  EXPECT_FALSE(paint.is_emitter()) << "ambient light stands in for light between surfaces";
  const Material mirror = material_of("pigment { rgb 1 } finish { diffuse 0.1 reflection 0.8 }");
  EXPECT_NEAR(mirror.specular[0], 0.8f, float_rounding);
  EXPECT_EQ(mirror.specular_roughness, 0.0f);
  const Material brass = material_of(
      "pigment { rgb <0.9, 0.7, 0.4> } finish { diffuse 0.2 metallic specular 0.8 roughness 0.01 "
      "}");
  EXPECT_NEAR(brass.specular[2], 0.32f, float_rounding);
  EXPECT_NEAR(brass.specular_roughness, alpha_of_exponent(100.0), float_rounding);
  const Material varnish = material_of("pigment { rgb 0.5 } finish { phong 0.5 phong_size 50 }");
  ASSERT_TRUE(varnish.coat);
  EXPECT_EQ(varnish.coat->index_of_refraction, 1.5f);
  // The mean of 0.2 + 0.6 (1 - cos) over even light is 0.2 + 0.6 / 3.
  const Material grazing =
      material_of("pigment { rgb 1 } finish { diffuse 0 reflection { 0.2, 0.8 } }");
  EXPECT_NEAR(grazing.specular[0], 0.4f, float_rounding);
}

TEST_F(Pov, ClearMaterialsAreGlassOrSheets) {
  const Material glass = material_of(
      "pigment { rgbf <0.9, 1, 1, 1> } interior { ior 1.5 fade_distance 2 fade_power 1001 "
      "fade_color "
      "rgb <0.5, 1, 1> }");
  ASSERT_TRUE(glass.dielectric);
  EXPECT_EQ(glass.dielectric->index_of_refraction, 1.5f);
  EXPECT_NEAR(glass.dielectric->tint[0], 0.9f, float_rounding);
  EXPECT_NEAR(glass.dielectric->absorption[0], 0.25f, float_rounding);
  EXPECT_FALSE(glass.dielectric->thin);
  const Material pane = material_of("pigment { rgbt 1 } interior { ior 1.5 }", "disc { 0, y, 1 ");
  ASSERT_TRUE(pane.dielectric);
  EXPECT_TRUE(pane.dielectric->thin);
  const Material gauze = material_of("pigment { rgb 1 transmit 0.25 } finish { diffuse 0.8 }");
  EXPECT_NEAR(gauze.regular_transmittance[0], 0.25f, float_rounding);
  EXPECT_NEAR(gauze.reflectance[0], 0.6f, float_rounding);
}

TEST_F(Pov, ShiningSurfacesAreLamps) {
  const Material lamp = material_of("pigment { rgb <1, 0.5, 0> } finish { emission 4 diffuse 0 }");
  EXPECT_NEAR(lamp.emission[1], 2.0 * pi, 2.0 * pi * float_rounding);
  EXPECT_FALSE(lamp.emits_both_sides);
  EXPECT_TRUE(material_of("pigment { rgb 1 } finish { ambient 1 }").is_emitter());
  EXPECT_TRUE(
      material_of("pigment { rgb 1 } finish { emission 1 }", "disc { 0, y, 1 ").emits_both_sides);
  EXPECT_TRUE(material_of("hollow pigment { rgb 1 } finish { emission 1 }").emits_both_sides);
}

TEST_F(Pov, ColoursFollowTheAssumedGamma) {
  const auto reflectance = [&](const std::string& before, const std::string& color) {
    return first_material(
               read(before + "sphere { 0, 1 pigment { " + color + " } finish { diffuse 1 } }"))
        .reflectance[0];
  };
  const std::string squared = "global_settings { assumed_gamma 2 }\n";
  EXPECT_NEAR(reflectance("", "rgb 0.5"), 0.5f, float_rounding);
  EXPECT_NEAR(reflectance(squared, "rgb 0.5"), 0.25f, float_rounding);
  // sRGB of 0.5 is ((0.5 + 0.055) / 1.055)^2.4 in light (IEC 61966-2-1), whatever gamma the file
  // has.
  const double linear = std::pow(0.555 / 1.055, 2.4);
  EXPECT_NEAR(reflectance("", "srgb 0.5"), linear, float_rounding);
  EXPECT_NEAR(reflectance(squared, "srgb 0.5"), linear, float_rounding);
}

TEST_F(Pov, PatternsCountByTheirMeanAndCheckersByCells) {
  const Material wood = material_of(
      "pigment { gradient y color_map { [0 rgb 0] [0.5 rgb 1] [1 rgb 1] } } finish { diffuse 1 }");
  EXPECT_NEAR(wood.reflectance[0], 0.75f, float_rounding);
  const Scene floor = read(
      "polygon { 5, <0, 0>, <4, 0>, <4, 4>, <0, 4>, <0, 0>\n"
      " pigment { checker rgb 0.1, rgb 0.9 } finish { diffuse 1 } }");
  const Material material = first_material(floor);
  ASSERT_TRUE(material.texture);
  const PolygonMesh& mesh = mesh_of(floor);
  const auto at = [&](double x, double y) {
    const UvMap& map = mesh.uv_maps.at(static_cast<std::size_t>(mesh.facets[0].uv_map));
    return material.texture->factor[0] * material.texture->image.at(map.at({x, y, 0.0}))[0];
  };
  // Codes of texels are roots in 16 bits: an error of the root of 2^-17, twice that of the value.
  const double code = std::ldexp(1.0, -15);
  EXPECT_NEAR(at(0.5, 0.5), 0.1, code);
  EXPECT_NEAR(at(1.5, 0.5), 0.9, code);
  EXPECT_NEAR(at(1.5, 3.5), 0.1, code);
  EXPECT_NEAR(at(2.5, 1.5), 0.9, code);
}

TEST_F(Pov, LightsAreLamps) {
  // E = pi at the middle of the sphere, 2 m away.
  const Scene even = read("light_source { 2*y color rgb 1 }\nsphere { 0, 1 }");
  ASSERT_EQ(even.lamps.size(), 1u);
  EXPECT_NEAR(even.lamps[0].intensity[0], 4.0 * pi, 4.0 * pi * float_rounding);
  EXPECT_TRUE(has_note(even, "do not fade"));
  const Scene faded = read(
      "light_source { 5*z color rgb <1, 0.5, 0> fade_distance 3 fade_power 2 }\nsphere { 0, 1 }");
  EXPECT_EQ(faded.lamps.at(0).position, Eigen::Vector3d(0, 0, -5));
  EXPECT_NEAR(faded.lamps[0].intensity[1], 9.0 * pi, 9.0 * pi * float_rounding);
  const Scene spot = read(
      "light_source { 3*y color rgb 1 spotlight point_at 0 radius 10 falloff 20 }\nbox { -1, 0 }");
  const auto& cone = std::get<SpotCone>(spot.lamps.at(0).shape);
  EXPECT_NEAR(cone.outer, 20.0 * pi / 180.0, rounding);
  EXPECT_NEAR((spot.lamps[0].aim() + Eigen::Vector3d::UnitY()).norm(), 0.0, rounding);
  const Scene tight = read(
      "light_source { 3*y color rgb 1 spotlight point_at 0 radius 80 falloff 80 tightness 2 }\n"
      "box { -1, 0 }");
  // cos^2, linear between steps of 80 / 180 of a degree: an error of (step / 2)^2 times 1.
  EXPECT_NEAR(relative_intensity(tight.lamps.at(0), Eigen::Vector3d(1, -1, 0).normalized()), 0.5,
              2e-5);
  const Scene area =
      read("light_source { 3*y color rgb 1 area_light 2*x, z, 4, 4 }\nsphere { 0, 1 }");
  EXPECT_EQ(area.lamps.at(0).opening.along_c0, 2.0);
  EXPECT_EQ(area.lamps[0].opening.along_c90, 1.0);
  const Scene sun = read("light_source { 9*y color rgb 1 parallel point_at 0 }\nsphere { 0, 1 }");
  ASSERT_TRUE(sun.sky && sun.sky->sun);
  EXPECT_NEAR(sun.sky->sun->irradiance[0], pi, pi * float_rounding);
  const Scene grouped = read("union { sphere { 0, 1 } light_source { 0, rgb 1 } translate 7*x }");
  EXPECT_EQ(grouped.lamps.at(0).position.x(), 7.0);
}

TEST_F(Pov, CamerasKeepTheirAnglesAndAxes) {
  const Scene scene = read(
      "sphere { 0, 1 }\n#declare C = camera { location <0, 1, -5> right 2*x look_at <0, 1, 0> }\n"
      "camera { C }\ncamera { location -3*z angle 60 look_at 0 }\ncamera { orthographic location "
      "-3*z right 4*x up 2*y }\ncamera { fisheye angle 180 location -z right x }");
  ASSERT_EQ(scene.cameras.size(), 4u);
  const Camera& first = scene.cameras[0];
  EXPECT_EQ(first.position, Eigen::Vector3d(0, 1, 5));
  EXPECT_EQ(first.direction, Eigen::Vector3d(0, 0, -1));
  EXPECT_NEAR(first.fov_degrees, 90.0, 1e-12) << "2 atan(1)";
  EXPECT_EQ(first.width, 2 * first.height);
  // +x of the text is on the right of the picture.
  EXPECT_GT(first.direction.cross(first.up).x(), 0.9);
  EXPECT_EQ(scene.cameras[1].fov_degrees, 60.0);
  EXPECT_EQ(scene.cameras[2].projection, Projection::orthographic);
  EXPECT_EQ(scene.cameras[2].view_width, 4.0);
  EXPECT_EQ(scene.cameras[3].projection, Projection::equidistant);
}

TEST_F(Pov, PartsThatCannotBeUsedAreNamed) {
  const Scene scene = read(
      "sphere { 0, 1 }\nblob { threshold 1 }\nbox { <0, 0, 0> }\nsphere { 0, 1e200*1e200 }\n"
      "sphere { <1e12, 0, 0>, 1 }\nfog { distance 3 }\n#include \"missing.inc\"\nobject { Chair }\n"
      "sphere { 0, 1 pigment { image_map { png \"missing.png\" } } }");
  EXPECT_TRUE(has_loss(scene, "'blob'"));
  EXPECT_TRUE(has_loss(scene, "a.pov:3: 'box' lacks a vector"));
  EXPECT_TRUE(has_loss(scene, "'fog'"));
  EXPECT_TRUE(has_loss(scene, "'missing.inc'"));
  EXPECT_TRUE(has_loss(scene, "'Chair'"));
  EXPECT_TRUE(has_loss(scene, "'missing.png'"));
  EXPECT_EQ(scene.surfaces.size(), 2u);
  test::expect_message([&] { read("camera { location 0 look_at z }"); }, {"a.pov", "no shapes"});
}

TEST_F(Pov, CopiesAreBounded) {
  std::string text = "#declare A = sphere { 0, 1 scale <1, 2, 1> }\n";
  for (int i = 0; i < 30; ++i) text += "#declare A = union { object { A } object { A } }\n";
  EXPECT_THROW(read(text + "object { A }"), LimitError);
  std::string empty = "#declare A = union { blob { threshold 1 } }\n";
  for (int i = 0; i < 40; ++i) empty += "#declare A = union { object { A } object { A } }\n";
  EXPECT_THROW(read(empty + "object { A }"), LimitError);
}

// The example is the box of cornell/cornell.toml, with the same facets in the same order.
TEST_F(Pov, TheCornellBoxIsThatOfTheSceneFile) {
  const std::filesystem::path root = std::filesystem::path(LIGHTWELL_DOCS).parent_path();
  const Scene pov = read_scene(root / "examples/pov/cornell.pov");
  const Scene toml = read_scene(root / "cornell/cornell.toml");
  const std::vector<FacetRef> facets = scene_facets(pov), expected = scene_facets(toml);
  ASSERT_EQ(facets.size(), expected.size());
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const auto loop_of = [&](const Scene& scene, const FacetRef& at) {
      const auto& mesh = mesh_of(scene, static_cast<std::size_t>(at.surface));
      const Facet& facet = mesh.facets[static_cast<std::size_t>(at.facet)];
      std::vector<int> corners = facet.boundary;
      for (const auto& hole : facet.holes) corners.insert(corners.end(), hole.begin(), hole.end());
      std::vector<Eigen::Vector3d> loop;
      for (const int v : corners) loop.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
      return loop;
    };
    EXPECT_EQ(loop_of(pov, facets[f]), loop_of(toml, expected[f])) << f;
    const auto material_at = [&](const Scene& scene, const FacetRef& at) {
      const Surface& surface = scene.surfaces[static_cast<std::size_t>(at.surface)];
      return scene.materials[static_cast<std::size_t>(surface.material)];
    };
    const Material is = material_at(pov, facets[f]), wants = material_at(toml, expected[f]);
    for (Eigen::Index b = 0; b < 3; ++b) {
      EXPECT_EQ(is.reflectance[b], wants.reflectance[b]);
      EXPECT_NEAR(is.emission[b], wants.emission[b], wants.emission[b] * float_rounding);
    }
  }
  ASSERT_EQ(pov.cameras.size(), 1u);
  EXPECT_LE((pov.cameras[0].position - toml.cameras.at(0).position).norm(), rounding);
  EXPECT_EQ(pov.cameras[0].fov_degrees, toml.cameras[0].fov_degrees);
}

}  // namespace
}  // namespace lightwell::read_pov_test
