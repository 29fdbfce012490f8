#include "mesh/cleaning/spread_power.h"

#include <gtest/gtest.h>

#include <string>

#include "mesh/cleaning/planar_regions.h"
#include "scene/picture_cells.h"
#include "tests/mesh/mesh_scenes.h"
#include "tests/scene/scene_file_test.h"

namespace lightwell::spread_power_test {
namespace {

using namespace lightwell::test;

const std::string square = "[[0,0,0],[1,0,0],[1,1,0],[0,1,0]]";
const std::string turned = "[[0,0,0],[0,1,0],[1,1,0],[1,0,0]]";
const std::string apart = "[[0,0,3],[1,0,3],[1,1,3],[0,1,3]]";
// Between a statement and the power of the cleaned scene lie fewer than twenty roundings of floats:
// hue, exitance, the sums of both amounts, factor and product.
constexpr double rounding = 20.0 * 0x1p-24;

// Power of all surfaces that shine, W in each band.
Spectrum power_of(const Scene& scene) {
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(scene.bands.count());
  for (const Surface& surface : scene.surfaces) {
    const Material& material = scene.materials[static_cast<std::size_t>(surface.material)];
    const double sides = material.emits_both_sides ? 2.0 : 1.0;
    sum += sides * surface_area(surface) * mean_exitance(scene, surface);
  }
  return sum.cast<float>();
}

class SpreadPower : public SceneFileTest {
 protected:
  // One surface of some polygons that shine.
  Scene lamp(const std::string& emission, const std::string& polygons) const {
    return read_file("lamp.toml", "[materials.lamp]\nreflectance = 0\n" + emission +
                                      "\n[[surfaces]]\nmaterial = 'lamp'\npolygons = [" + polygons +
                                      "]\n");
  }
};

TEST_F(SpreadPower, StaysWhereDuplicatesGo) {
  for (const std::string& polygons : {square + ", " + square, square + ", " + square + ", " + apart,
                                      apart + ", " + square + ", " + square + ", " + square}) {
    CleanUpReport report;
    const Scene watts = merge_planar_regions(lamp("power = [1, 2, 3]", polygons), &report);
    EXPECT_GT(report.duplicates, 0);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(power_of(watts)[k], k + 1.0, (k + 1.0) * rounding);
    const Scene lumens =
        merge_planar_regions(lamp("lumens = 500\ncolour = [1.0, 0.5, 0.25]", polygons));
    EXPECT_NEAR(luminous(lumens.bands, power_of(lumens)), 500.0, 500.0 * rounding);
  }
}

TEST_F(SpreadPower, EmissionOfEachSquareMetreStaysBitForBit) {
  for (const std::string emission : {"exitance = [1, 2, 3]", "radiance = 3", "luminance = 70"}) {
    const Scene given = lamp(emission, square + ", " + square + ", " + apart);
    const Scene clean = merge_planar_regions(given);
    EXPECT_TRUE((clean.materials[0].emission == given.materials[0].emission).all());
  }
}

TEST_F(SpreadPower, OfBothSidesStaysWhereOneOfTwoFacetsBackToBackGoes) {
  CleanUpReport report;
  const Scene given = lamp("lumens = 500\nemits = 'both'", square + ", " + turned);
  const Scene clean = merge_planar_regions(given, &report);
  EXPECT_EQ(report.duplicates, 1);
  EXPECT_NEAR(luminous(clean.bands, power_of(clean)), 500.0, 500.0 * rounding);
  // Each front has light of its own where facets shine from their fronts alone.
  merge_planar_regions(lamp("lumens = 500", square + ", " + turned), &report);
  EXPECT_EQ(report.duplicates, 0);
}

// The white half of a picture on one square metre, the picture's mean, 1/2, on another that is
// there twice: 2/3 of the power is left of 3/4 of the light.
TEST_F(SpreadPower, OfPicturesIsThatOfWhatTheyShow) {
  std::filesystem::copy(LIGHTWELL_TEST_DATA "/scene/two-pixels.png", folder / "two-pixels.png");
  const Scene given = read_file(
      "picture.toml",
      "[materials.lamp]\nreflectance = 0\nlumens = 500\nemission_texture = 'two-pixels.png'\n"
      "[[surfaces]]\nmaterial = 'lamp'\npolygon = " +
          apart +
          "\nuv = [[0,1],[0.25,1],[0.25,0],[0,0]]\n"
          "[[surfaces]]\nmaterial = 'lamp'\npolygons = [" +
          square + ", " + square + "]\n");
  const Scene clean = merge_planar_regions(given);
  EXPECT_NEAR(luminous(clean.bands, power_of(clean)), 500.0, 500.0 * rounding);
}

// An hourglass whose triangles of 1 and 4 m^2 have opposite windings: the area of the loop is 3
// m^2, that of the pieces 5 m^2.
TEST_F(SpreadPower, StaysWherePolygonsThatCrossThemselvesAreCut) {
  Scene given = lamp("power = 15", square);
  given.surfaces[0].shape = polygon({{-1, -1, 0}, {1, -1, 0}, {-2, 2, 0}, {2, 2, 0}});
  given.materials[0].emission = constant_spectrum(given.bands, 5.0f);
  const Scene clean = merge_planar_regions(given);
  // A hundred roundings of doubles: the crossing, and areas of two triangles.
  EXPECT_NEAR(surface_area(clean.surfaces[0]), 5.0, 5.0 * 100.0 * 0x1p-53);
  EXPECT_NEAR(power_of(clean)[0], 15.0, 15.0 * rounding);
}

// Facets without area take no part of the power, nor does the merging of triangles.
TEST_F(SpreadPower, EmissionStaysBitForBitWhereTheAreaDoes) {
  Scene given = lamp("lumens = 500", "[[0,0,0],[1,0,0],[1,1,0]], [[0,0,0],[1,1,0],[0,1,0]]");
  auto& mesh = std::get<PolygonMesh>(given.surfaces[0].shape);
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {{0, 0, 1}, {1, 0, 1}, {0.5, 1e-15, 1}});
  mesh.facets.push_back({.boundary = {first, first + 1, first + 2}});
  CleanUpReport report;
  const Scene clean = merge_planar_regions(given, &report);
  EXPECT_EQ(report.degenerate, 1);
  EXPECT_EQ(report.merged, 2);
  EXPECT_TRUE((clean.materials[0].emission == given.materials[0].emission).all());
}

}  // namespace
}  // namespace lightwell::spread_power_test
