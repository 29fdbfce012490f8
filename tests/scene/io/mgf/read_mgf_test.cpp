#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/io/mgf/mgf_color.h"
#include "tests/scene/expected_messages.h"
#include "tests/scene/scene_file_test.h"

namespace lightwell::read_mgf_test {
namespace {

const std::string corners =
    "v a =\n p 0 0 0\nv b =\n p 2 0 0\nv c =\n p 2 1 0\nv d =\n p 0 1 0\nv z =\n p 0 0 3\n n 0 0 "
    "1\n";

class Mgf : public test::SceneFileTest {
 protected:
  Scene read(const std::string& text) const { return read_file("a.mgf", corners + text); }
  Material material_of(const std::string& text) const {
    return first_material(read("m paint =\n" + text + "f a b c d\n"));
  }
};

const PolygonMesh& mesh_of(const Scene& scene) {
  return std::get<PolygonMesh>(scene.surfaces.at(0).shape);
}

double luminance(const MgfColor& color) {
  return (rgb_bands().xyz.row(1).transpose().cast<double>() * color).sum();
}

// The weights of luminance are floats that add up to 1 within a few 2^-24.
constexpr double float_error = 1e-6;

TEST_F(Mgf, EqualEnergyIsGrey) {
  const MgfColor white = mgf_chromaticity(1.0 / 3.0, 1.0 / 3.0);
  EXPECT_LE((white - 1.0).abs().maxCoeff(), float_error);
  EXPECT_LE((mgf_spectrum(400, 700, std::vector{2.0, 2.0, 2.0}) - 1.0).abs().maxCoeff(),
            float_error);
}

// Colours change the ratios of the bands alone.
TEST_F(Mgf, ColoursHaveTheLuminanceOne) {
  const std::vector<double> rising = {0.0, 1.0};
  for (const MgfColor& color :
       {mgf_chromaticity(0.5, 0.4), mgf_black_body(3000.0), mgf_spectrum(400, 700, rising)}) {
    EXPECT_NEAR(luminance(color), 1.0, float_error);
    EXPECT_GT(color[0], color[2]);
  }
  // The mean of a line over 600-700, 500-600 and 400-500 nm: 5, 3 and 1 sixths.
  const MgfColor line = mgf_spectrum(400, 700, rising);
  EXPECT_NEAR(line[0] / line[2], 5.0, float_error);
  EXPECT_NEAR(line[1] / line[2], 3.0, float_error);
  // Light within 500-600 nm alone.
  const MgfColor green = mgf_spectrum(510, 590, std::vector{1.0, 1.0});
  EXPECT_LT(green[0] / green[1], 1e-3) << "nothing but the fall of 1e-3 nm at the end is outside";
}

TEST_F(Mgf, MaterialsTakeTheColourOfTheirTime) {
  const Material material = material_of("c red =\n cxy 0.5 0.33\nrd 0.2\nc\nrs 0.3 0.1\ntd 0.1\n");
  EXPECT_EQ(material.name, "paint");
  EXPECT_NEAR(luminous(rgb_bands(1.0), material.reflectance), 0.2, float_error);
  EXPECT_GT(material.reflectance[0], material.reflectance[1]);
  EXPECT_TRUE((material.specular == 0.3f).all());
  EXPECT_EQ(material.specular_roughness, 0.1f);
  EXPECT_TRUE((material.transmittance == 0.1f).all());
  EXPECT_FALSE(material.one_sided);
  EXPECT_TRUE(material_of("rd 0.5\nsides 1\n").one_sided);
}

TEST_F(Mgf, EmittanceIsInLumens) {
  const Material material = material_of("cct 3000\ned 683\nsides 1\n");
  EXPECT_NEAR(luminous(rgb_bands(), material.emission), 683.0, 683.0 * float_error);
  EXPECT_FALSE(material.emits_both_sides);
  EXPECT_TRUE(material_of("ed 683\n").emits_both_sides) << "two sides are alike";
  EXPECT_FALSE(read("m\ned 1\nf a b c d\n").relative_units);
}

TEST_F(Mgf, OneSidedBodiesOfAnIndexAreGlass) {
  const Material glass = material_of("ts 0.9 0\nir 1.5 0\nsides 1\n");
  ASSERT_TRUE(glass.dielectric);
  EXPECT_EQ(glass.dielectric->index_of_refraction, 1.5f);
  EXPECT_TRUE((glass.dielectric->tint == 0.9f).all());
  const Material sheet = material_of("ts 0.5 0\n");
  EXPECT_FALSE(sheet.dielectric);
  EXPECT_TRUE((sheet.regular_transmittance == 0.5f).all());
}

TEST_F(Mgf, NamesKeepWhatWasSet) {
  const Scene scene = read(
      "m dark =\n rd 0.1\nm light = dark\n rd 0.9\nm dark\nf a b c d\nm light\nf a b c d\n"
      "m dark\n rd 0.2\nf a b c d\n");
  ASSERT_EQ(scene.surfaces.size(), 3u);
  const auto reflectance = [&](std::size_t i) {
    return scene.materials[static_cast<std::size_t>(scene.surfaces[i].material)].reflectance[0];
  };
  EXPECT_EQ(reflectance(0), 0.1f);
  EXPECT_EQ(reflectance(1), 0.9f);
  EXPECT_EQ(reflectance(2), 0.2f);
}

TEST_F(Mgf, ArraysRepeatShapesInGroups) {
  const Scene scene =
      read("o row\nxf -s 2 -a 3 -t 10 0 0\no ball\nsph z -0.5\nsph z 0.5\no\nxf\no\n");
  ASSERT_EQ(scene.surfaces.size(), 6u);
  EXPECT_EQ(scene.surfaces[3].name, "row.ball 4");
  const auto& sphere = std::get<Sphere>(scene.surfaces[5].shape);
  EXPECT_EQ(sphere.radius, 1.0);
  // -t follows -s; of the third copy twice.
  EXPECT_TRUE(sphere.center.isApprox(Eigen::Vector3d(20, 0, 6), 1e-15)) << sphere.center;
  EXPECT_TRUE(std::holds_alternative<PolygonMesh>(scene.surfaces[0].shape)) << "inside out";
}

// Volume by the divergence theorem, positive where fronts are outside.
double volume(const PolygonMesh& mesh) {
  double sum = 0.0;
  for (const Facet& f : mesh.facets) {
    sum += mesh.vertices[static_cast<std::size_t>(f.boundary[0])].dot(facet_normal(mesh, f)) *
           facet_area(mesh, f) / 3.0;
  }
  return sum;
}

TEST_F(Mgf, PrismsFaceOutwards) {
  const PolygonMesh face = mesh_of(read("f a b c d\n"));
  const Eigen::Vector3d face_normal = facet_normal(face, face.facets.at(0));
  for (const std::string length : {"3", "-3"}) {
    const PolygonMesh prism = mesh_of(read("prism a b c d " + length + "\n"));
    EXPECT_EQ(prism.facets.size(), 6u);
    EXPECT_NEAR(volume(prism), 6.0, 6.0 * 1e-15 * 36) << "36 corners of some roundings each";
    // A positive length goes in behind the front of the face that is given.
    double along = 0.0;
    for (const Eigen::Vector3d& v : prism.vertices) along += v.dot(face_normal);
    EXPECT_EQ(along < 0.0, length == "3");
  }
}

TEST_F(Mgf, RoundShapesHaveTheirAreas) {
  const auto area = [&](const std::string& text) {
    return surface_area(read(text).surfaces.at(0));
  };
  constexpr double pi = std::numbers::pi;
  // These shapes are scaled to the area of round ones: some hundred roundings.
  constexpr double rounding = 1e-12;
  EXPECT_NEAR(area("cyl a 2 z\n"), 12.0 * pi, 12.0 * pi * rounding);
  EXPECT_NEAR(area("ring z 1 2\n"), 3.0 * pi, 3.0 * pi * rounding);
  // The slant of a cone is that of 32 facets: their apothem is 1 - (pi / 32)^2 / 2 of the radius.
  const double facet = 0.5 * pi * pi / 1024.0;
  EXPECT_NEAR(area("cone a 4 z 0\n"), 20.0 * pi, 20.0 * pi * facet * 2.0);
  // A torus of 32 by 16 flat faces is smaller by the chords of both circles.
  const double chord = (pi / 32) * (pi / 32) / 6 + (pi / 16) * (pi / 16) / 6;
  EXPECT_NEAR(area("torus z 1 3\n") / (8.0 * pi * pi), 1.0, 2.0 * chord);
  EXPECT_GT(volume(mesh_of(read("torus z 1 3\n"))), 0.0);
}

TEST_F(Mgf, FacesHaveHolesAndNormals) {
  const std::string inner =
      "v e =\n p .5 .2 0\nv f =\n p .5 .7 0\nv g =\n p 1 .7 0\nv h =\n p 1 .2 0\n";
  const Scene scene = read(inner + "fh a b c d - e f g h\n");
  // 2 x 1 less 0.5 x 0.5, in doubles.
  EXPECT_NEAR(surface_area(scene.surfaces.at(0)), 1.75, 1e-14);
  const Scene bent = read(
      "v a\n n -.6 0 .8\nv d\n n -.6 0 .8\nv b\n n .6 0 .8\nv c\n n .6 0 .8\n"
      "f a b c d\n");
  EXPECT_EQ(mesh_of(bent).facets.at(0).normal_map, 0);
}

TEST_F(Mgf, IncludedFilesStandTransformed) {
  folder.write("part.mgf", "v q =\n p 1 0 0\nsph q 1\n");
  const Scene scene = read("i part.mgf -s 3\ni none.mgf\n");
  EXPECT_EQ(std::get<Sphere>(scene.surfaces.at(0).shape).radius, 3.0);
  ASSERT_FALSE(scene.losses.empty());
  EXPECT_TRUE(says(scene.losses[0], "Included files are missing"));
}

TEST_F(Mgf, FaultsNameTheirLine) {
  const auto fails = [&](const std::string& line, const std::string& what) {
    test::expect_message([&] { read("f a b \\\n c d\n" + line + "\n"); }, {"a.mgf:14:", what});
  };
  fails("f a b q", "'q' is not defined");
  fails("m paint", "'paint' is not defined");
  fails("rd x", "no number");
  fails("rd -1", "below 0");
  fails("cxy 0.3 0", "above 0");
  fails("cmix 0 c", "'c' is not defined");
  fails("cspec 700 400 1 1", "do not rise");
  fails("cspec 400 700 0 0", "no luminance");
  fails("cone a 1 z -1", "different signs");
  fails("xf", "none is open");
  fails("o", "none is open");
  fails("xf -a 999999999", "xform");
  fails("sph a", "has 1 arguments");
}

TEST_F(Mgf, UnknownEntitiesAreNamedOnce) {
  const Scene scene = read("f a b c d\nies lamp.ies\nies other.ies\n");
  ASSERT_EQ(scene.losses.size(), 1u);
  EXPECT_EQ(scene.losses[0], "Entities that are not understood were left out: 'ies'.");
}

TEST_F(Mgf, FilesThatIncludeThemselvesAreRefused) {
  test::expect_message([&] { read("i a.mgf\n"); }, {"include each other"});
}

}  // namespace
}  // namespace lightwell::read_mgf_test
