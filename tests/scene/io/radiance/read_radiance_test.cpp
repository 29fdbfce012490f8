// Conversion of RADIANCE's primitives, materials, projects and views.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>

#include "scene/io/glossy.h"
#include "scene/round_shape.h"
#include "scene/specular.h"
#include "tests/scene/scene_file_test.h"
#include "tests/scene/scene_questions.h"

namespace lightwell::read_radiance_test {
namespace {

using test::area_of;
using test::has_loss;
using test::has_note;
using test::material_called;
using test::mesh_of;
using test::normal_of;
using test::notes_of;

constexpr double pi = std::numbers::pi;
const std::string grey = "void plastic grey 0 0 5 .5 .5 .5 0 0\n";
const std::string square = "polygon square 0 0 12 0 0 0 1 0 0 1 1 0 0 1 0\n";

class Radiance : public test::SceneFileTest {
 protected:
  Scene read(const std::string& content, const std::string& name = "scene.rad") const {
    return read_file(name, content);
  }
  // A surface of material `grey` with this type and these real arguments.
  Scene shape(const std::string& type, const std::string& arguments) const {
    return read(grey + "grey " + type + " thing 0 0 " + arguments);
  }
  // Material of a square; the definitions name it m.
  Material material(const std::string& definitions) const {
    return first_material(read(definitions + "\nm " + square));
  }
  std::string error(const std::string& content, const std::string& name = "scene.rad") const {
    return message_of<InputError>([&] { read(content, name); });
  }
};

void expect_near(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double tolerance = 1e-12) {
  EXPECT_LT((a - b).norm(), tolerance) << a.transpose() << " is not " << b.transpose();
}

void expect_rgb(const Spectrum& spectrum, const std::array<double, 3>& rgb) {
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(spectrum[k], rgb[static_cast<std::size_t>(k)], 1e-6) << "band " << k;
  }
}

// Share of the facets whose front faces away from the z axis.
double outward_share(const PolygonMesh& mesh) {
  int outward = 0;
  for (const Facet& facet : mesh.facets) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const int v : facet.boundary) middle += mesh.vertices[static_cast<std::size_t>(v)];
    middle.z() = 0.0;
    if (facet_normal(mesh, facet).dot(middle) > 0.0) ++outward;
  }
  return static_cast<double>(outward) / static_cast<double>(mesh.facets.size());
}

TEST_F(Radiance, WordsMayStandOnAnyLinesWithCommentsAndQuotes) {
  const Scene scene = read(
      "# a comment\r\nvoid plastic \"two words\"# is part of no word\n0 0\n5 .5\t.5 5e-1 0\n+0\n"
      "# another\n\"two words\" polygon 'the floor' # here too\n0\n0\n12 0 0 0  1 0 0\n1 1. 0 0 1 "
      "0");
  EXPECT_EQ(scene.surfaces.at(0).name, "the floor");
  EXPECT_NEAR(area_of(mesh_of(scene)), 1.0, 1e-12);
  EXPECT_FALSE(scene.relative_units);
}

TEST_F(Radiance, AByteOrderMarkIsABlank) {
  const std::string mark = "\xef\xbb\xbf";
  const Scene scene = read(mark + grey + "\n" + mark + "grey " + square);
  EXPECT_EQ(scene.surfaces.size(), 1u);
  EXPECT_TRUE(scene.losses.empty()) << scene.losses.front();
}

TEST_F(Radiance, PolygonsFaceWhereTheirCornersRunCounterClockwise) {
  const Scene scene = read(grey + "grey " + square);
  expect_near(normal_of(scene), {0, 0, 1});
  EXPECT_FALSE(scene.materials.at(0).one_sided);
}

TEST_F(Radiance, ASeamBecomesAHole) {
  // The hole's last side lies on the seam, as in the front wall of the office.
  const Scene scene = read(grey +
                           "grey polygon wall 0 0 30  0 0 0  4 0 0  4 3 0  0 3 0  0 1 0 "
                           " 1 1 0  1 2 0  3 2 0  3 1 0  0 1 0");
  const Facet& wall = mesh_of(scene).facets.at(0);
  EXPECT_EQ(mesh_of(scene).facets.size(), 1u);
  ASSERT_EQ(wall.holes.size(), 1u);
  EXPECT_EQ(wall.holes[0].size(), 4u);
  EXPECT_NEAR(area_of(mesh_of(scene)), 12.0 - 2.0, 1e-12);
  EXPECT_TRUE(scene.dropped_polygons == 0 && !has_note(scene, "split"));
}

TEST_F(Radiance, TwoHolesOnOneSeamAreTwoHoles) {
  const Scene scene = read(grey +
                           "grey polygon wall 0 0 48  0 0 0  9 0 0  9 4 0  0 4 0  0 0 0"
                           " 1 1 0  1 2 0  2 2 0  2 1 0  5 1 0  5 2 0  6 2 0  6 1 0  5 1 0  2 1 0 "
                           " 1 1 0");
  ASSERT_EQ(mesh_of(scene).facets.size(), 1u);
  EXPECT_EQ(mesh_of(scene).facets[0].holes.size(), 2u);
  EXPECT_NEAR(area_of(mesh_of(scene)), 36.0 - 2.0, 1e-12);
}

TEST_F(Radiance, PolygonsNumberedOfOneMaterialAreOneSurface) {
  const std::string p = " 0 0 9 0 0 0 1 0 0 0 1 0\n";
  const Scene scene = read(grey + "void plastic red 0 0 5 .5 0 0 0 0\n" + "grey polygon box.1" + p +
                           "grey polygon box.23" + p + "red polygon box.3" + p +
                           "red polygon wall.left" + p + "red polygon wall.right" + p);
  ASSERT_EQ(scene.surfaces.size(), 4u);
  EXPECT_EQ(scene.surfaces[0].name, "box");
  EXPECT_EQ(mesh_of(scene, 0).facets.size(), 2u);
  EXPECT_EQ(scene.surfaces[1].name, "box 2");
  EXPECT_EQ(scene.surfaces[2].name, "wall.left");
}

TEST_F(Radiance, SpheresAreExact) {
  const Scene scene = shape("sphere", "4 1 2 3 .5");
  const auto& sphere = std::get<Sphere>(scene.surfaces.at(0).shape);
  expect_near(sphere.center, {1, 2, 3});
  EXPECT_EQ(sphere.radius, 0.5);
  // Plastic has two equal sides.
  EXPECT_TRUE(std::holds_alternative<Sphere>(shape("bubble", "4 0 0 0 1").surfaces[0].shape));
}

TEST_F(Radiance, BubblesShineInwards) {
  const std::string lamp = "void light lamp 0 0 3 1 1 1\n";
  const Scene scene = read(lamp + "lamp bubble b 0 0 4 0 0 0 2\nlamp sphere s 0 0 4 9 9 9 -1\n");
  for (const std::size_t i : {0u, 1u}) {
    const double radius = i == 0 ? 2.0 : 1.0;
    EXPECT_NEAR(area_of(mesh_of(scene, i)), 4 * pi * radius * radius, 1e-9);
  }
  EXPECT_EQ(outward_share(mesh_of(scene, 0)), 0.0);
}

// An area of an exact shape is a product of a few numbers, that of facets a sum over 32 of two
// products each: shares of the area by which they may be off.
constexpr double area_rounding = 64 * 0x1p-53;

const Frustum& frustum_of(const Scene& scene) {
  return std::get<Frustum>(scene.surfaces.at(0).shape);
}

TEST_F(Radiance, CylindersAndTubesAreExact) {
  const Scene cylinder = shape("cylinder", "7 0 0 1 0 0 4 .5");
  EXPECT_NEAR(surface_area(cylinder.surfaces[0]), 2 * pi * 0.5 * 3, area_rounding * 3 * pi);
  EXPECT_FALSE(frustum_of(cylinder).inward);
  expect_near(frustum_of(cylinder).base, {0, 0, 1});
  expect_near(frustum_of(cylinder).axis, {0, 0, 1});
  EXPECT_TRUE(cylinder.losses.empty());
  EXPECT_FALSE(frustum_of(shape("cylinder", "7 0 0 4 0 0 1 .5")).inward);
  EXPECT_TRUE(frustum_of(shape("tube", "7 0 0 1 0 0 4 .5")).inward);
  EXPECT_TRUE(frustum_of(shape("cylinder", "7 0 0 1 0 0 4 -.5")).inward);
}

TEST_F(Radiance, ConesAndCupsAreExact) {
  const Scene cone = shape("cone", "8 0 0 0 0 0 4 3 0");
  // pi r s, slant 5
  EXPECT_NEAR(surface_area(cone.surfaces[0]), pi * 3 * 5, area_rounding * 15 * pi);
  EXPECT_FALSE(frustum_of(cone).inward);
  EXPECT_EQ(frustum_of(cone).base_radius, 3.0);
  EXPECT_EQ(frustum_of(cone).top_radius, 0.0);
  const Scene cup = shape("cup", "8 0 0 0 0 0 4 1 4");
  EXPECT_NEAR(surface_area(cup.surfaces[0]), pi * (1 + 4) * 5, area_rounding * 25 * pi);
  EXPECT_TRUE(frustum_of(cup).inward);
}

TEST_F(Radiance, RingsHaveTheirAreaTheirHoleAndTheirNormal) {
  for (const char* radii : {"1 2", "2 1"}) {
    const Scene scene = shape("ring", std::string("8 5 6 7 0 -3 0 ") + radii);
    EXPECT_NEAR(surface_area(scene.surfaces[0]), pi * (4 - 1), area_rounding * 3 * pi);
    EXPECT_EQ(frustum_of(scene).top_radius, 1.0);
    expect_near(front_normal(frustum_of(scene), {5.0, 6.0, 8.5}), {0, -1, 0});
  }
  EXPECT_NEAR(surface_area(shape("ring", "8 0 0 0 1 1 1 0 1").surfaces[0]), pi, area_rounding * pi);
}

TEST_F(Radiance, RoundShapesThatShineAreFacetsOfTheSameAreaAndFront) {
  const std::string lamp = "void light lamp 0 0 3 1 1 1\n";
  const Scene cylinder = read(lamp + "lamp cylinder c 0 0 7 0 0 1 0 0 4 .5\n");
  EXPECT_NEAR(area_of(mesh_of(cylinder)), 2 * pi * 0.5 * 3, area_rounding * 3 * pi);
  EXPECT_EQ(outward_share(mesh_of(cylinder)), 1.0);
  EXPECT_EQ(outward_share(mesh_of(read(lamp + "lamp tube c 0 0 7 0 0 1 0 0 4 .5\n"))), 0.0);
  const Scene ring = read(lamp + "lamp ring r 0 0 8 5 6 7 0 -3 0 1 2\n");
  // Edges, 6 pi long, shift by the rounding of coordinates up to 9, and 64 corners add products up
  // to 16.
  constexpr double rounding = (6 * pi * 9 + 64 * 16) * 0x1p-53;  // 1.3e-13
  EXPECT_NEAR(area_of(mesh_of(ring)), pi * (4 - 1), rounding);
  EXPECT_EQ(mesh_of(ring).facets.at(0).holes.size(), 1u);
  expect_near(normal_of(ring), {0, -1, 0});
  EXPECT_EQ(ring.losses.size(), 1u);
}

TEST_F(Radiance, PlasticShinesWhiteAndMetalInItsColour) {
  const Material plastic = material("void plastic m 0 0 5 .6 .4 .2 .1 .05");
  expect_rgb(plastic.reflectance, {0.54, 0.36, 0.18});
  expect_rgb(plastic.specular, {0.1, 0.1, 0.1});
  const Material dull = material("void plastic m 0 0 5 .6 .4 .2 .01 0");
  EXPECT_FALSE(dull.coat);
  expect_rgb(dull.specular, {0.01, 0.01, 0.01});
  const Material metal = material("void metal m 0 0 5 .6 .4 .2 .9 0");
  expect_rgb(metal.reflectance, {0.06, 0.04, 0.02});
  expect_rgb(metal.specular, {0.54, 0.36, 0.18});
}

TEST_F(Radiance, SmoothPlasticMirrorsMoreAtGrazingAnglesAsRadiancesDoes) {
  const double share = 0.04;
  const Material paint = material("void plastic m 0 0 5 .6 .4 .2 .04 0");
  ASSERT_TRUE(paint.coat);
  EXPECT_NEAR(paint.coat->index_of_refraction, 1.5, 1e-6);  // ((n - 1) / (n + 1))^2 = 0.04
  // RADIANCE mirrors s + (1 - s) (exp(-5.85 cos) - 0.00203), and C times the rest is diffuse. The
  // integral of 2 cos exp(-5.85 cos) is 2 / 5.85^2 = 0.0584 less 0.4 %. Fresnel's mean for 1.5 is
  // 0.0918; RADIANCE's is 0.0942.
  const double mirrored = share + (1.0 - share) * (0.0584 * 0.98 - 0.00203);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(paint.reflectance[k], (0.6 - 0.2 * k) * (1.0 - mirrored), 0.003) << k;
  }
}

TEST_F(Radiance, WideHighlightsAreDiffuseLight) {
  const Material rough = material("void metal2 m 4 1 0 0 . 0 6 .6 .4 .2 .9 .1 .6");
  expect_rgb(rough.reflectance, {0.6, 0.4, 0.2});
  expect_rgb(rough.specular, {0, 0, 0});
  const Material brushed = material("void metal m 0 0 5 .6 .4 .2 .5 .3");
  expect_rgb(brushed.specular, {0.3, 0.2, 0.1});
  EXPECT_FLOAT_EQ(brushed.specular_roughness, 0.3f);
}

TEST_F(Radiance, LightIsPiTimesItsRadianceFromTheFrontAt179LumensPerWatt) {
  const Scene scene = read("void light m 0 0 3 1 2 3\nm " + square);
  const Material& light = scene.materials.at(0);
  expect_rgb(light.emission / static_cast<float>(pi), {1, 2, 3});
  EXPECT_TRUE(light.one_sided && !light.emits_both_sides);
  expect_rgb(light.reflectance, {0, 0, 0});
  // Single precision.
  EXPECT_NEAR(luminous(scene.bands, Spectrum::Ones(3)), 179.0, 179e-6);
}

TEST_F(Radiance, ColoursHaveTheLuminanceOfRadiancesPrimaries) {
  const Scene scene = read("void light m 0 0 3 1 2 3\nm " + square);
  // grey() of rayinit.cal, nine decimals. The weights are floats, off by 2^-24 of themselves.
  const Eigen::Array3d weights(0.265074126, 0.670114631, 0.064811243);
  for (int k = 0; k < 3; ++k) {
    Spectrum primary = Spectrum::Zero(3);
    primary[k] = 1.0f;
    EXPECT_NEAR(luminous(scene.bands, primary), 179.0 * weights[k],
                179.0 * (0.5e-9 + 0x1p-24 * weights[k]));
  }
  // White is (0.3333, 0.3333): X = Y, Z = 3334 / 3333 Y. Floats below 1 are off by 2^-25 each,
  // their first sum by as much and the second, which may exceed 1, by 2^-24: 3 times 2^-24 in each
  // of two sums, and one more for the product.
  constexpr float rounding = 7 * 0x1p-24f;
  const Eigen::Array3f white = scene.bands.xyz.rowwise().sum();
  EXPECT_NEAR(white[0], white[1], rounding);
  EXPECT_NEAR(white[2], 3334.0f / 3333.0f * white[1], rounding);
}

TEST_F(Radiance, GlowsOfANegativeRadiusLightNothing) {
  const std::string glow = "void glow m 0 0 4 1 2 3 -1\n";
  const Scene panel = read(glow + "m " + square);
  expect_rgb(panel.materials.at(0).emission, {0, 0, 0});
  EXPECT_TRUE(has_loss(panel, "light nothing, were read as black: 'm'"));
  // A source, and a surface whose pattern would make it a lamp.
  const Scene sky =
      read(glow + "m source s 0 0 4 0 0 1 180\nvoid plastic w 0 0 5 1 1 1 0 0\nw " + square);
  EXPECT_FALSE(sky.sky.has_value());
  EXPECT_TRUE(has_loss(sky, "light nothing, were read as black: 'm'"));
  const Scene lamp = read("void brightfunc f 2 Dz*Dz . 0 0\nf glow m 0 0 4 1 2 3 -1\nm " + square +
                          "\nvoid plastic w 0 0 5 1 1 1 0 0\nw " + square);
  EXPECT_TRUE(lamp.lamps.empty());
}

TEST_F(Radiance, AGlowHasFourNumbersAndAConeThePowerOfItsSpotlightsBeam) {
  expect_rgb(material("void glow m 0 0 4 1 1 1 0").emission / static_cast<float>(pi), {1, 1, 1});
  // Half angle 30 degrees: sin^2 = 1/4.
  const Scene scene =
      read("void spotlight m 0 0 7 8 8 8 60 0 0 1\nm cone c 0 0 8 0 0 0 0 0 1 .1 .2\n");
  expect_rgb(first_material(scene).emission / static_cast<float>(pi), {2, 2, 2});
}

// Light that goes on from a pane, by the angle from its normal: mirrored, and straight on.
SmoothScattering at_angle(const Material& pane, double degrees) {
  const double angle = degrees * pi / 180.0;
  return smooth_scattering({.material = pane,
                            .direction = {std::sin(angle), 0.0, -std::cos(angle)},
                            .normal = Eigen::Vector3d::UnitZ()});
}
Spectrum reflected_at(const Material& pane, double degrees) {
  return at_angle(pane, degrees).sample[0].weight;
}
Spectrum passed_at(const Material& pane, double degrees) {
  return at_angle(pane, degrees).sample[1].weight;
}

TEST_F(Radiance, GlassPassesWhatItsTwoFacesAndItsBodyLeave) {
  // F = ((n - 1) / (n + 1))^2. A pane with t = 1 passes (1 - F) / (1 + F), all light that is not
  // reflected.
  const Material clear = material("void glass m 0 0 3 1 1 1");
  EXPECT_TRUE(clear.dielectric->thin);
  EXPECT_FLOAT_EQ(clear.dielectric->index_of_refraction, 1.52f);
  EXPECT_NEAR(clear.dielectric->tint[0], 1.0, 1e-6);
  EXPECT_EQ(clear.dielectric->transmissivity.size(), 0);
  const double F = 0.04, t = 0.5;  // n = 1.5
  const Material tinted = material("void glass m 0 0 4 1 1 .5 1.5");
  EXPECT_NEAR(passed_at(tinted, 0.0)[2], (1 - F) * (1 - F) * t / (1 - F * F * t * t), 1e-6);
}

// Window glass that passes 0.6 along the normal. The table of what RADIANCE's glass passes and
// reflects is good to a unit of its third digit.
TEST_F(Radiance, GlassPassesLessOfInclinedLight) {
  const Material window = material("void glass m 0 0 3 0.654047 0.654047 0.654047");
  const std::array<std::array<double, 3>, 6> table = {{{0, 0.600, 0.059},
                                                       {30, 0.584, 0.060},
                                                       {50, 0.543, 0.079},
                                                       {60, 0.499, 0.115},
                                                       {70, 0.412, 0.207},
                                                       {80, 0.236, 0.434}}};
  for (const auto& [degrees, passed, reflected] : table) {
    EXPECT_NEAR(passed_at(window, degrees)[0], passed, 1e-3) << degrees;
    EXPECT_NEAR(reflected_at(window, degrees)[0], reflected, 1e-3) << degrees;
  }
}

TEST_F(Radiance, DielectricsAndInterfacesRefract) {
  EXPECT_FLOAT_EQ(material("void dielectric m 0 0 5 1 1 1 1.33 0").dielectric->index_of_refraction,
                  1.33f);
  EXPECT_FLOAT_EQ(
      material("void interface m 0 0 8 1 1 1 1.5 1 1 1 1.2").dielectric->index_of_refraction,
      1.25f);
}

TEST_F(Radiance, MirrorsAreBlackBehind) {
  const Material mirror = material("void mirror m 0 0 3 .9 .9 .8");
  expect_rgb(mirror.specular, {0.9, 0.9, 0.8});
  EXPECT_TRUE(mirror.one_sided);
}

// With a specularity of 0.1, a transmissivity of 0.5 and a transmitted specularity of 0.2:
// rho = 0.9 C 0.5, tau = 0.9 C 0.5 0.8, and 0.9 C 0.5 0.2 passes straight on.
TEST_F(Radiance, TransPassesLightStraightAndDiffusely) {
  const Material curtain = material("void trans m 0 0 7 .8 .6 .4 .1 .05 .5 .2");
  expect_rgb(curtain.reflectance, {0.36, 0.27, 0.18});
  expect_rgb(curtain.specular, {0.1, 0.1, 0.1});
  expect_rgb(curtain.transmittance, {0.288, 0.216, 0.144});
  expect_rgb(curtain.regular_transmittance, {0.072, 0.054, 0.036});
  EXPECT_FLOAT_EQ(curtain.specular_roughness, 0.05f);
  const Material clear = material("void trans m 0 0 7 .9 .9 .9 0 0 .9 .9");
  EXPECT_FALSE(clear.dielectric);
  EXPECT_NEAR(clear.regular_transmittance[1], 0.9 * 0.9 * 0.9, 1e-6);
  const Material screen = material("void trans m 0 0 7 .5 .5 .5 0 0 0 0");
  EXPECT_FALSE(screen.is_translucent() || screen.passes_straight());
}

TEST_F(Radiance, TransThatIsRoughPassesLightDiffusely) {
  const Scene scene = read("void trans2 m 4 1 0 0 . 0 8 .8 .8 .8 0 .05 .3 .5 .4\nm " + square);
  const Material& frosted = scene.materials.at(0);
  expect_rgb(frosted.transmittance, {0.4, 0.4, 0.4});
  EXPECT_FALSE(frosted.passes_straight());
  EXPECT_TRUE(has_loss(scene, "roughness above 0.1 was read as diffuse: 'm'"));
  expect_rgb(material("void transfunc m 2 f f.cal 0 6 .8 .8 .8 0 .5 .5").transmittance,
             {0.4, 0.4, 0.4});
}

TEST_F(Radiance, ProgrammedMaterialsKeepTheirDiffuseAndConstantParts) {
  const Material blind =
      material("void BRTDfunc m 10 .1 .1 .1 .2 .2 .3 0 0 0 . 0 9 .3 .3 .3 .1 .1 .1 .2 .2 .1");
  expect_rgb(blind.reflectance, {0.3, 0.3, 0.3});
  expect_rgb(blind.specular, {0.1, 0.1, 0.1});
  expect_rgb(blind.transmittance, {0.2, 0.2, 0.1});
  expect_rgb(blind.regular_transmittance, {0.2, 0.2, 0.3});
  const Material formula =
      material("void BRTDfunc m 10 0 0 0 f(x) 0 0 0 0 0 f.cal 0 9 .3 .3 .3 0 0 0 .2 .2 .2");
  EXPECT_FALSE(formula.passes_straight());
  // Shares of 1.5 in all.
  const Material panel =
      material("void BSDF m 6 0 panel.xml 0 0 1 . 0 9 .75 .75 .75 .5 .5 .5 .75 .75 .75");
  expect_rgb(panel.reflectance, {0.5, 0.5, 0.5});
  expect_rgb(panel.transmittance, {0.5, 0.5, 0.5});
}

TEST_F(Radiance, ConstantPatternsMultiply) {
  const Material m = material(
      "void colorfunc tint 4 1 A1 A1/2 . 0 1 .5\ntint brightfunc dim 2 .5 . 0 0\n"
      "dim texfunc bumps 4 x y z f.cal 0 0\nbumps plastic m 0 0 5 .8 .8 .8 0 0");
  expect_rgb(m.reflectance, {0.4, 0.2, 0.1});
}

TEST_F(Radiance, PatternsThatVaryAreNamed) {
  const Scene scene = read(
      "void brightfunc grain 2 xgrain wood.cal 0 0\ngrain plastic wood 0 0 5 .6 .4 .2 0 0\nwood " +
      square);
  expect_rgb(scene.materials[0].reflectance, {0.6, 0.4, 0.2});
  EXPECT_TRUE(has_note(scene, "taken as 1: 'grain'"));
  const Material picture = material(
      "void colorpict p 7 red green blue a.hdr p.cal pic_u pic_v 0 0\np plastic m 0 0 5 1 1 1 0 0");
  expect_rgb(picture.reflectance, {0.5, 0.5, 0.5});
}

// Two pixels (m + 1/2) 2^(e - 136): 128.5 / 256 and 128.5 / 64, 64.5 / 256 and 64.5 / 64,
// 32.5 / 256 and 32.5 / 64. Neither the exposure counts
// nor a beginning other than "#?".
TEST_F(Radiance, PicturesCountByTheirMeanColour) {
  std::filesystem::create_directory(folder / "lib");
  folder.write("lib/print.hdr", "pfilt -1 old.pic\nEXPOSURE=4\n\n-Y 1 +X 2\n" +
                                    std::string("\x80\x40\x20\x80\x80\x40\x20\x82", 8));
  const auto mean = [&](const std::string& functions, const std::string& file) -> Spectrum {
    return material("void colorpict p 7 " + functions + " " + file +
                    " picture.cal pic_u pic_v 0 0\np light m 0 0 3 1 1 1")
               .emission /
           static_cast<float>(pi);
  };
  const auto of_mantissa = [](double m) { return 0.5 * (m / 256 + m / 64); };
  const double red = of_mantissa(128.5), green = of_mantissa(64.5), blue = of_mantissa(32.5);
  expect_rgb(mean("red green blue", "print.hdr"), {red, green, blue});
  expect_rgb(mean("clip_r clip_g clip_b", "print.pic"),
             {0.5 * (128.5 / 256 + 1.0), 0.5 * (64.5 / 256 + 1.0), blue});
  // grey() of rayinit.cal.
  const double all = 0.265074126 * red + 0.670114631 * green + 0.064811243 * blue;
  expect_rgb(mean("grey grey grey", "print.hdr"), {all, all, all});
  expect_rgb(mean("fadered green blue", "print.hdr"), {0.5, 0.5, 0.5});
  folder.write("torn.hdr", "#?RADIANCE\n\n-Y 1 +X 2\n\x80");
  expect_rgb(mean("red green blue", "torn.hdr"), {0.5, 0.5, 0.5});
}

TEST_F(Radiance, ANameMeansWhatWasDefinedLast) {
  const Scene scene = read("void plastic m 0 0 5 .1 .1 .1 0 0\nm " + square +
                           "void plastic m 0 0 5 .2 .2 .2 0 0\nm polygon other 0 0 9 0 0 0 1 0 0 "
                           "0 1 0\n");
  EXPECT_FLOAT_EQ(material_called(scene, "m").reflectance[0], 0.1f);
  EXPECT_FLOAT_EQ(material_called(scene, "m 2").reflectance[0], 0.2f);
  EXPECT_EQ(scene.surfaces.at(1).material, 1);
}

TEST_F(Radiance, AnAliasTakesOrInheritsModifiers) {
  const std::string half = "void brightfunc half 2 .5 . 0 0\n";
  EXPECT_FLOAT_EQ(
      material(half + "half plastic a 0 0 5 .8 .8 .8 0 0\ninherit alias m a").reflectance[0], 0.4f);
  EXPECT_FLOAT_EQ(
      material(half + "void plastic a 0 0 5 .8 .8 .8 0 0\nhalf alias m a").reflectance[0], 0.4f);
  EXPECT_FLOAT_EQ(
      material(half + "half plastic a 0 0 5 .8 .8 .8 0 0\nvoid alias m a").reflectance[0], 0.8f);
}

TEST_F(Radiance, AMixtureIsAMean) {
  const std::string parts =
      "void plastic white 0 0 5 .8 .8 .8 0 0\nvoid plastic black 0 0 5 0 0 0 0 0\n";
  EXPECT_FLOAT_EQ(material(parts + "void mixfunc m 4 white black .25 . 0 0").reflectance[0], 0.2f);
  EXPECT_FLOAT_EQ(material(parts + "void mixpict m 4 white black a b 0 0").reflectance[0], 0.4f);
}

TEST_F(Radiance, AMixtureWithNothingIsAPerforatedSheet) {
  const std::string parts =
      "void metal steel 0 0 5 .6 .6 .6 .5 .1\nvoid trans cloth 0 0 7 .5 .5 .5 0 0 .4 0\n";
  for (const std::string mixture : {"steel void .7", "void steel .3"}) {
    const Material sheet = material(parts + "void mixfunc m 4 " + mixture + " . 0 0");
    expect_rgb(sheet.reflectance, {0.21, 0.21, 0.21});
    expect_rgb(sheet.specular, {0.21, 0.21, 0.21});
    expect_rgb(sheet.regular_transmittance, {0.3, 0.3, 0.3});
  }
  const Material both = material(parts + "void mixfunc m 4 cloth steel .5 . 0 0");
  expect_rgb(both.transmittance, {0.1, 0.1, 0.1});
}

TEST_F(Radiance, PrismsLetLightStraightThrough) {
  const Material prism = material("void prism1 m 5 1 0 0 0 f.cal 0 0");
  expect_rgb(prism.regular_transmittance, {1, 1, 1});
}

TEST_F(Radiance, PatternsOfThePlaceCountByTheirMeanOverASurface) {
  folder.write("ramp.cal", "ramp = Px * A1; checks = if(mod(Px, .5) - .25, 1, 0);");
  const auto rho = [&](const std::string& pattern) {
    return material("void " + pattern + "\np plastic m 0 0 5 .8 .8 .8 0 0").reflectance;
  };
  // 2048 points spread evenly: off by some 2048ths of the pattern's range, and three digits.
  constexpr double even = 0.8 * 0.005;
  EXPECT_NEAR(rho("brightfunc p 2 ramp ramp.cal 0 1 .5")[0], 0.8 * 0.25, even);
  EXPECT_NEAR(rho("brightfunc p 2 checks ramp.cal 0 0")[1], 0.8 * 0.5, 4.0 * even);
  const Spectrum colors = rho("colorfunc p 4 ramp Py noise3(Px,Py,Pz)*0+.3 ramp.cal 0 1 1");
  EXPECT_NEAR(colors[0], 0.8 * 0.5, even);
  EXPECT_NEAR(colors[1], 0.8 * 0.5, even);
  EXPECT_NEAR(colors[2], 0.8 * 0.3, 1e-6);
  // A pattern is placed with its object: here at x from 2 to 3.
  const Scene moved =
      read("!xform -t -2 0 0 pattern.rad\np plastic m 0 0 5 .2 .2 .2 0 0\nm " + square);
  EXPECT_TRUE(has_loss(moved, "are missing"));
  folder.write("pattern.rad", "void brightfunc p 2 Px . 0 0\n");
  const Scene placed =
      read("!xform -t -2 0 0 pattern.rad\np plastic m 0 0 5 .2 .2 .2 0 0\nm " + square);
  EXPECT_NEAR(first_material(placed).reflectance[0], 0.2 * 2.5, even);
}

TEST_F(Radiance, CopiesOfAnObjectShareTheirMaterials) {
  folder.write("chair.rad",
               "void brightfunc grain 2 .5+.2*sin(Px*9) . 0 0\n"
               "grain plastic wood 0 0 5 .5 .5 .5 0 0\nwood " +
                   square);
  const Scene scene = read(
      "!xform -n a -t 1 0 0 chair.rad\n!xform -n b -t 5 2 0 chair.rad\n"
      "!xform -n c -t 3 3 0 chair.rad\n");
  EXPECT_EQ(scene.surfaces.size(), 3u);
  EXPECT_EQ(scene.materials.size(), 1u);
}

TEST_F(Radiance, FacetsOfRoundShapesHaveTheNormalsOfRoundOnes) {
  const Scene scene = read("void light lamp 0 0 3 1 1 1\nlamp cone c 0 0 8 0 0 0 0 0 2 1 .5\n");
  const auto& mesh = std::get<PolygonMesh>(scene.surfaces.at(0).shape);
  ASSERT_FALSE(mesh.normal_maps.empty());
  for (const Facet& facet : mesh.facets) {
    ASSERT_GE(facet.normal_map, 0);
    for (const int v : facet.boundary) {
      const Eigen::Vector3d& p = mesh.vertices[static_cast<std::size_t>(v)];
      const Eigen::Vector3d expected =
          Eigen::Vector3d(2.0 * p.x() / p.head<2>().norm(), 2.0 * p.y() / p.head<2>().norm(), 0.5)
              .normalized();
      const Eigen::Vector3d found =
          mesh.normal_maps[static_cast<std::size_t>(facet.normal_map)].at(p).normalized();
      expect_near(found, expected, 1e-9);
    }
  }
}

TEST_F(Radiance, DielectricsAbsorbByTheMetre) {
  const Material green = material("void dielectric m 0 0 5 .5 1 .25 1.5 0");
  const Spectrum passed = (-2.0f * green.dielectric->absorption).exp();  // over two metres
  expect_rgb(passed, {0.25, 1.0, 0.0625});
  EXPECT_EQ(material("void dielectric m 0 0 5 0 1 1 1.5 0").dielectric->absorption[0],
            highest_absorption);
}

TEST_F(Radiance, AnIllumShinesUnlessItsPatternIsUnknown) {
  EXPECT_TRUE(material("void illum m 1 void 0 3 1 1 1").is_emitter());
  const Scene scene = read(
      "!genssky 7 12 17\nvoid glass pane 0 0 3 1 1 1\nvoid brightfunc unknown 2 Px . 0 0\n"
      "unknown illum m 1 pane 0 3 1 1 1\nm " +
      square);
  EXPECT_TRUE(scene.materials.at(0).dielectric.has_value());
  EXPECT_TRUE(has_note(scene, "Skies of other programs"));
}

TEST_F(Radiance, WhatCannotBeSeenIsLeftOutByName) {
  const Scene scene =
      read(grey + "grey " + square + "void polygon ghost 0 0 9 0 0 1 1 0 1 0 1 1\n" +
           "grey source sun 0 0 4 0 0 1 .5\nvoid mist fog 0 0 0\nfog sphere cloud "
           "0 0 4 0 0 0 9\n");
  EXPECT_EQ(scene.surfaces.size(), 1u);
  for (const char* name : {"'ghost'", "'sun'", "'cloud'"}) EXPECT_TRUE(has_note(scene, name));
}

TEST_F(Radiance, MixturesOfMixturesAreReadOnce) {
  std::ostringstream text;
  text << "void plastic m0 0 0 5 .8 .8 .8 0 0\n";
  for (int i = 1; i <= 40; ++i) {  // 2^40 readings otherwise
    text << "void mixfunc m" << i << " 4 m" << i - 1 << " m" << i - 1 << " .5 . 0 0\n";
  }
  const Scene scene = read(text.str() + "m40 " + square);
  EXPECT_FLOAT_EQ(scene.materials.at(0).reflectance[0], 0.8f);
}

TEST_F(Radiance, WrongPrimitivesAreNamedWithFileAndLine) {
  const auto wrong = [&](const std::string& text, const std::string& says_this) {
    EXPECT_TRUE(says(error(grey + text), says_this));
  };
  wrong("grey " + square + "\ngrey polygone p 0 0 9\n",
        "scene.rad:4: 'polygone' is no type of a primitive");
  wrong("grey polygon p 0 0 12 1 2 three\n", "scene.rad:2: polygon 'p' has 'three' (line 2)");
  wrong("grey polygon p 0 0 12 1 2 3\n", "ends with the file, before its 12 real arguments");
  wrong("grey polygon p 0 0 6 1 2 3 4 5 6\n", "three corners");
  wrong("grey polygon p -1 0 6\n", "has '-1' (line 2) where the number of its string arguments");
  wrong("grey polygon p 0 2 1 1 0\n", "has integer arguments");
  wrong("grey polygon 'p 0 0 9\n", "a quoted word does not end");
  wrong("void alias a b\n", "modifier 'b'");
  wrong("grey sphere s 0 0 3 1 2 3\n", "sphere 's' has 3 real arguments; it needs 4");
  wrong("grey sphere s 0 0 4 1 2 3 1e300\n", "nothing may lie beyond");
  wrong("grey sphere s 0 0 4 1 2 3 nan\n", "has 'nan'");
  wrong("grey cone c 0 0 8 0 0 0 0 0 1 1 -1\n", "radii of different signs");
  wrong("grey ring r 0 0 8 0 0 0 0 0 0 0 1\n", "has no normal");
  wrong("void instance i 1 room.oct 0 0\n", "put '!xform FILE'");
  wrong("void mesh i 1 room.rtm 0 0\n", "the OBJ file that each was made from");
  EXPECT_TRUE(says(error(""), "has no surfaces that can be read"));
  EXPECT_TRUE(says(error("", "room.oct"), "compiled from RADIANCE's scene files"));
}

TEST_F(Radiance, MaterialsThatCannotBeReadBecomeGrey) {
  const auto noted = [&](const std::string& text, const std::string& says_this) {
    const Scene scene = read(grey + text);
    EXPECT_TRUE(says(notes_of(scene), says_this));
    EXPECT_TRUE(has_loss(scene, says_this));
    EXPECT_FLOAT_EQ(first_material(scene).reflectance[1], 0.5f);
  };
  noted("brown " + square, "modifier 'brown', which nothing before it defines");
  noted("inherit " + square, "modifier 'inherit'");
  noted("void plastic m 0 0 5 -.5 0 0 0 0\nm " + square, "colour component -0.5");
  noted("void plastic m 0 0 5 .5 0 0 2 0\nm " + square, "specularity 2; it must lie in 0 to 1");
  noted("void plastic m 0 0 3 .5 0 0\nm " + square, "has 3 real arguments; it needs 5");
  noted("void dielectric m 0 0 5 1 1 1 0 0\nm " + square, "index of refraction 0");
}

TEST_F(Radiance, PartsThatCannotBeUsedAreLeftOutOnceWithCounts) {
  folder.write("torn.rad", "grey " + square + "grey polygon p 0 0 12 1 2 three\n");
  std::string text = grey + "grey " + square + "!cat gone.rad\n!gencat grey c 1\n!cat torn.rad\n";
  for (int i = 0; i < 7; ++i) text += "grey sphere s" + std::to_string(i) + " 0 0 3 1 2 3\n";
  const Scene scene = read(text);
  ASSERT_EQ(scene.surfaces.size(), 1u);  // successive squares of one material
  EXPECT_EQ(mesh_of(scene).facets.size(), 2u);
  EXPECT_TRUE(has_note(scene, "Files are missing, with all that they hold: 'gone.rad'"));
  EXPECT_TRUE(
      has_note(scene, "Commands that cannot be evaluated were left out: 'gencat grey c 1'"));
  EXPECT_TRUE(has_note(scene, "the rest was left out: 'torn.rad'"));
  EXPECT_TRUE(has_note(scene, "left out: 's0', 's1', 's2', 's3', 's4' and 2 more; the first: "));
  EXPECT_TRUE(has_loss(scene, "'s0', 's1', 's2', 's3', 's4', 's5', 's6'; the first: "));
}

// A unit square, 1 m up and turned by 90 degrees about z: from (0, 0, 1) to (-1, 1, 1).
TEST_F(Radiance, CompiledPartsAreReadFromTheSourcesBesideThem) {
  folder.write("desk.rad", "void plastic red 0 0 5 .8 .1 .1 0 0\nred " + square);
  folder.write("cup.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  const Scene scene = read(grey +
                           "void instance a 7 desk.oct -rz 90 -t 0 0 1 0 0\n"
                           "grey instance b 1 desk.oct 0 0\n"
                           "grey mesh c 5 cup.rtm -t 0 0 2 0 0\n"
                           "void instance d 1 gone.oct 0 0\n");
  ASSERT_EQ(scene.surfaces.size(), 3u);
  EXPECT_LT((mesh_of(scene, 0).vertices.at(2) - Eigen::Vector3d(-1, 1, 1)).norm(), 1e-12);
  const auto red = [&](std::size_t s) {
    return scene.materials.at(static_cast<std::size_t>(scene.surfaces[s].material)).reflectance[0];
  };
  EXPECT_FLOAT_EQ(red(0), 0.8f);
  EXPECT_FLOAT_EQ(red(1), 0.5f);  // the modifier of the instance
  EXPECT_EQ(mesh_of(scene, 2).vertices.at(0).z(), 2.0);
  EXPECT_TRUE(has_loss(scene, "read from the scene files beside them: 'desk.oct'"));
  EXPECT_TRUE(has_loss(scene, "'gone.oct'"));
}

TEST_F(Radiance, APolygonOfEndlessCornersIsRefusedSoon) {
  std::string numbers;
  for (int i = 0; i < 30'000; ++i) numbers += std::to_string(i % 7) + " ";
  EXPECT_TRUE(says(error(grey + "grey polygon p 0 0 30000 " + numbers), "10000 corners"));
  EXPECT_TRUE(says(error(grey + "grey polygon p 0 0 999999999 1 2 3"), "ends with the file"));
}

TEST(RadianceOffice, IsReadWhole) {
  const Scene scene = read_scene(LIGHTWELL_TEST_DATA "/scene/radiance/office.rif");
  EXPECT_EQ(scene.dropped_polygons, 0);
  EXPECT_FALSE(has_note(scene, "split"));
  const auto named = [&](const std::string& name) -> const Surface& {
    for (const Surface& surface : scene.surfaces) {
      if (surface.name == name) return surface;
    }
    throw std::runtime_error("no surface " + name);
  };
  // The room is 60 x 35.5 x 60; its front wall has a window of 47 x 17.
  EXPECT_NEAR(surface_area(named("wall.front")), 60 * 35.5 - 47 * 17, 1e-9);
  EXPECT_NEAR(surface_area(named("light1")), 100.0, 1e-9);
  expect_near(facet_normal(std::get<PolygonMesh>(named("light1").shape),
                           std::get<PolygonMesh>(named("light1").shape).facets[0]),
              {0, -1, 0});
  EXPECT_NEAR(surface_area(named("blind")), 24 * 48, 1e-9);  // slats of 1 x 48
  EXPECT_NEAR(surface_area(named("mug.outside")), 2 * pi * 1.625 * 3.5 * 0.3333 * 0.3333, 1e-9);
  for (const char* name : {"left_bookcase.base", "chair1.platform", "chair2.seat", "lamp.lightbulb",
                           "book.page1", "right_bookcase.side.kj", "painting"}) {
    EXPECT_NO_THROW(named(name)) << name;
  }
  const Bounds bounds = scene_bounds(scene);
  expect_near(bounds.low, {-30, 15.5, -30}, 1e-3);
  expect_near(bounds.high, {30, 51, 30}, 1e-3);
  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_EQ(scene.cameras[0].name, "norm");
  EXPECT_DOUBLE_EQ(scene.cameras[0].fov_degrees, 39.9);
  // Square pixels: 512 tan(27.5 / 2) / tan(39.9 / 2).
  EXPECT_EQ(scene.cameras[0].height, 345);
  EXPECT_GT(scene.cameras[0].up.y(), 0.9);
}

}  // namespace
}  // namespace lightwell::read_radiance_test
