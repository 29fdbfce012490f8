#include "radiosity/emitters/clear_places.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/radiosity/test_scenes.h"

namespace lightwell::clear_places_test {
namespace {

using Eigen::Vector3d;

constexpr double clearance = 0.5e-3, distance = 2.0 * clearance;  // m

// A plate of 1 m in the plane z = 0, front up, in two triangles, and one lamp.
class Plate {
 public:
  explicit Plate(bool one_sided) {
    Material grey = test::diffuse(scene_.bands, 0.5f);
    grey.one_sided = one_sided;
    const int material = test::add_material(scene_, grey);
    test::add_polygon(scene_, "left", material, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    test::add_polygon(scene_, "right", material, {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  }

  // Height for rays of a lamp at a height over the middle, where the triangles meet.
  double height(double of_lamp, const IntensityShape& shape = {},
                const Vector3d& aim = -Vector3d::UnitZ()) {
    return place({0.5, 0.5, of_lamp}, shape, aim).z();
  }

  Vector3d place(const Vector3d& of_lamp, const IntensityShape& shape = {},
                 const Vector3d& aim = -Vector3d::UnitZ()) {
    scene_.lamps = {{.position = of_lamp,
                     .axes = lamp_axes(aim),
                     .intensity = constant_spectrum(scene_.bands, 1.0f),
                     .shape = shape}};
    return clear_places(scene_, {{clearance}}).at(0);
  }

  Scene& scene() { return scene_; }

 private:
  Scene scene_{};
};

// One step reaches its place but for the rounding of four sums of up to 1 m: 4 * 2^-52 m.
constexpr double rounding = 4 * 0x1p-52;

TEST(ClearPlaces, LampsKeepTheirSideOfASheet) {
  Plate sheet(false);
  for (const double height : {1e-6, 1e-4, 9e-4}) {
    EXPECT_NEAR(sheet.height(height), distance, rounding) << height;
    EXPECT_NEAR(sheet.height(-height), -distance, rounding) << height;
  }
  EXPECT_EQ(sheet.height(1.1e-3), 1.1e-3);
  EXPECT_EQ(sheet.height(-1.1e-3), -1.1e-3);
}

// A diagonal of 1.4 m makes 1e-9 m less than the digits of files.
TEST(ClearPlaces, LampsOnASheetGoWhereTheyShine) {
  Plate sheet(false);
  const SpotCone spot{.inner = 0.0, .outer = std::numbers::pi / 4.0};
  for (const double height : {-1e-9, 0.0, 1e-9}) {
    EXPECT_NEAR(sheet.height(height, spot, Vector3d::UnitZ()), distance, rounding);
    EXPECT_NEAR(sheet.height(height, spot, -Vector3d::UnitZ()), -distance, rounding);
    EXPECT_NEAR(sheet.height(height), distance, rounding);
  }
}

TEST(ClearPlaces, OneSidedSurfacesHaveLampsBeforeThem) {
  Plate plate(true);
  for (const double height : {-9e-4, -1e-6, 0.0, 1e-6}) {
    EXPECT_NEAR(plate.height(height), distance, rounding) << height;
  }
}

TEST(ClearPlaces, LampsBesideAnEdgeStay) {
  Plate plate(false);
  const Vector3d beside(1.002, 0.5, 1e-5), over(0.998, 0.5, 1e-5);
  EXPECT_EQ(plate.place(beside), beside);
  EXPECT_NEAR(plate.place(over).z(), distance, rounding);
}

// 16 passes leave (2/3)^16 of a way of at most the distance to each wall.
TEST(ClearPlaces, LampsInACornerLeaveAllWalls) {
  Scene scene;
  std::array<int, 6> grey;
  grey.fill(test::add_material(scene, test::diffuse(scene.bands, 0.5f)));
  test::add_box(scene, {0, 0, 0}, {1, 1, 1}, grey, true);
  scene.lamps.push_back({.position = {1.0 - 1e-5, 2e-5, 1.0},
                         .axes = lamp_axes(-Vector3d::UnitZ()),
                         .intensity = constant_spectrum(scene.bands, 1.0f)});
  constexpr double left = distance * 2e-3;
  EXPECT_LT((clear_places(scene, {{clearance}}).at(0) -
             Vector3d(1.0 - distance, distance, 1.0 - distance))
                .cwiseAbs()
                .maxCoeff(),
            left);
}

// From a tenth of the way through a gap of 1 mm the planes lack 0.9 and 0.1 mm. The mean of the two
// steps is 0.4 mm and leads to the middle, where both lack the same.
TEST(ClearPlaces, LampsInAGapGoToItsMiddle) {
  Plate sheet(false);
  test::add_polygon(sheet.scene(), "lid", 0,
                    {{0, 0, 1e-3}, {1, 0, 1e-3}, {1, 1, 1e-3}, {0, 1, 1e-3}});
  sheet.scene().surfaces[0].shape = sheet.scene().surfaces[2].shape;
  for (Vector3d& v : std::get<PolygonMesh>(sheet.scene().surfaces[0].shape).vertices) v.z() = 0.0;
  sheet.scene().surfaces.erase(sheet.scene().surfaces.begin() + 1);
  EXPECT_NEAR(sheet.height(1e-4), 5e-4, rounding);
}

TEST(ClearPlaces, LampsLeaveRoundShapes) {
  Scene scene;
  Material grey = test::diffuse(scene.bands, 0.5f);
  grey.one_sided = false;
  const int material = test::add_material(scene, grey);
  scene.surfaces.push_back({.name = "ball", .material = material, .shape = Sphere{{0, 0, 0}, 1.0}});
  const auto place = [&](double z) {
    scene.lamps = {{.position = {0, 0, z},
                    .axes = lamp_axes(-Vector3d::UnitZ()),
                    .intensity = constant_spectrum(scene.bands, 1.0f)}};
    return clear_places(scene, {{clearance}}).at(0).z();
  };
  EXPECT_NEAR(place(1.0001), 1.0 + distance, rounding);
  EXPECT_NEAR(place(0.9999), 1.0 - distance, rounding);
  EXPECT_EQ(place(0.0), 0.0);
}

}  // namespace
}  // namespace lightwell::clear_places_test
