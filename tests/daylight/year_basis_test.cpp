#include "daylight/year_basis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "daylight/year.h"
#include "radiosity/gather/vertex_points.h"
#include "radiosity/refine/interpolated_vertices.h"
#include "scene/errors.h"
#include "tests/daylight/daylight_rooms.h"
#include "tests/daylight/three_days.h"

namespace lightwell::year_basis_test {
namespace {

using Eigen::Vector3d;

constexpr double ground = 0.2;

DaylightOptions coarse() {
  DaylightOptions options;
  options.sky_subdivision = 1;
  options.mesh.auto_patch_count = 120;
  options.mesh.elements_per_patch_edge = 1;
  options.points = YearBasisOptions{}.view;
  options.gather_rays = 256;
  options.sun_rays_of_patch = options.points_of_patch;  // as find_year_basis() has them
  return options;
}

// Light of all vertices in all hours but that straight from the sun, vertices x hours, with the
// vertices as sensors.
Eigen::ArrayXXf light_of_sensors(DaylightModel& model, std::span<const SkyHour> hours) {
  model.set_sensors(vertex_gather_points(model.mesh()));
  Eigen::ArrayXXf light;
  simulate_year(model, model.sky_coefficients().sum(), hours, ground,
                [&](const HourBlock& block) { light = block.total - block.sunlight; });
  return light;
}

Eigen::ArrayXf illuminance(const DaylightModel& model, const BandArray& bands) {
  return (bands.matrix() * model.band_weights().matrix()).array();
}

class YearBasisOf : public testing::Test {
 protected:
  const std::vector<SkyHour> hours =
      sky_hours(test::three_days(), Vector3d::UnitZ(), Vector3d::UnitY());
};

/// Red walls, so that light has several bands.
Scene red_room() {
  Material red = test::diffuse(Bands(rgb_bands()), 0.5f);
  red.reflectance[1] = 0.3f;
  return test::room_with_window(red);
}

}  // namespace

// Terms as many as the hours leave out nothing: the sum is the light of sensors in the same
// places, by the same rays. What is left is the equations' tolerance, 1e-6 of the brightest patch,
// of which the sensors' columns have one each for 145 patches and the sun, and the rounding of
// floats in sums of up to 36 terms, 36 x 6e-8 of the vertex' brightest hour: 1e-4 of that is more
// than both.
TEST_F(YearBasisOf, AllTermsAreTheLightOfSensorsInTheSamePlaces) {
  DaylightModel model(red_room(), Vector3d::UnitZ(), Vector3d::UnitY(), coarse());
  ASSERT_LE(hours.size(), 36u);
  const YearBasis basis =
      find_year_basis(model, hours, ground, {.most = 36, .error = 0.0, .rays = 256});
  const Eigen::ArrayXXf sensors = light_of_sensors(model, hours);
  EXPECT_LT(basis.error, 1e-4);
  for (std::size_t h = 0; h < hours.size(); ++h) {
    const Eigen::ArrayXf light =
        illuminance(model, light_of_hour(basis, static_cast<int>(h), model.scene().bands.count()));
    const auto column = static_cast<Eigen::Index>(h);
    const Eigen::ArrayXf within = 1e-4f * sensors.rowwise().maxCoeff();
    EXPECT_TRUE(((light - sensors.col(column)).abs() <= within).all()) << "hour " << h;
  }
}

// The error said is that of all vertices and hours: root mean square, relative to the vertex and to
// the hour. Squares of vertices' errors vary by about their mean, so that the mean of the 256
// vertices of the check varies by a sixteenth, and its root by a thirtieth; four such are 13 %.
// Vertices are drawn, and weighed here, by area. A tenth of them at most are samples, of which less
// is left out: the mean of the squares is lower by a tenth at most.
TEST_F(YearBasisOf, ErrorIsThatOfAllVertices) {
  DaylightOptions fine = coarse();
  fine.mesh.auto_patch_count = 600;
  DaylightModel model(test::room_with_window(test::diffuse(Bands(rgb_bands()), 0.5f)),
                      Vector3d::UnitZ(), Vector3d::UnitY(), fine);
  const YearBasis basis =
      find_year_basis(model, hours, ground, {.error = 0.05, .samples = 90, .rays = 256});
  EXPECT_LE(basis.error, 0.05);
  EXPECT_LT(basis.term_count(), 24);
  const Eigen::ArrayXXf sensors = light_of_sensors(model, hours);
  Eigen::ArrayXXf left_out = sensors;
  for (std::size_t h = 0; h < hours.size(); ++h) {
    left_out.col(static_cast<Eigen::Index>(h)) -=
        illuminance(model, light_of_hour(basis, static_cast<int>(h), 1));
  }
  // The brightness of each vertex, but a quarter of the median of all at least.
  const auto at_least = [](const Eigen::ArrayXf& brightness) {
    Eigen::ArrayXf sorted = brightness;
    std::ranges::sort(sorted);
    return Eigen::ArrayXf(brightness.max(0.25f * sorted[sorted.size() / 2]));
  };
  const Eigen::ArrayXf lit = at_least(sensors.rowwise().mean());
  Eigen::ArrayXXf relative = sensors.colwise() / lit;
  const std::vector<double> areas = vertex_areas(model.mesh());
  Eigen::ArrayXf area =
      Eigen::Map<const Eigen::ArrayXd>(areas.data(), sensors.rows()).cast<float>();
  area /= area.sum();
  const auto mean_square = [&](const Eigen::ArrayXXf& x) {
    return Eigen::Array<float, 1, Eigen::Dynamic>((x.square().colwise() * area).colwise().sum());
  };
  const Eigen::Array<float, 1, Eigen::Dynamic> of_hours = mean_square(relative).sqrt();
  relative.rowwise() /= of_hours;
  const Eigen::ArrayXf of_vertices = at_least(relative.square().rowwise().mean().sqrt());
  relative.colwise() /= of_vertices;
  const Eigen::ArrayXXf errors =
      ((left_out.colwise() / lit).rowwise() / of_hours).colwise() / of_vertices;
  const double found = std::sqrt(double{mean_square(errors).sum() / mean_square(relative).sum()});
  EXPECT_GE(model.mesh().vertex_count(), 10 * 90);
  EXPECT_LT(found, 1.13 * basis.error);
  EXPECT_GT(found, (0.87 - 0.05) * basis.error);
}

TEST_F(YearBasisOf, RefusesWhatAPageCannotShow) {
  const Scene room = test::room_with_window(test::diffuse(Bands(rgb_bands()), 0.5f));
  const DaylightModel model(room, Vector3d::UnitZ(), Vector3d::UnitY(), coarse());
  const auto sentence = [&](const DaylightModel& of, std::span<const SkyHour> when,
                            const YearBasisOptions& options) -> std::string {
    try {
      find_year_basis(of, when, ground, options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(sentence(model, hours, {.most_vertices = 10}),
            "the surfaces have " + std::to_string(model.mesh().vertex_count()) +
                " vertices, and a page of a year takes 10 at most; give a larger "
                "'--max-patch-size'");
  EXPECT_EQ(sentence(model, {}, {}),
            "the weather has no hour with daylight, so that a page would be black");
  Scene closed;
  const int rho = test::add_material(closed, test::diffuse(closed.bands, 0.5f));
  test::add_box(closed, {0.0, 0.0, 0.0}, {4.0, 3.0, 2.5}, {rho, rho, rho, rho, rho, rho}, true);
  const DaylightModel dark(closed, Vector3d::UnitZ(), Vector3d::UnitY(), coarse());
  EXPECT_EQ(sentence(dark, hours, {}),
            "no daylight reaches any surface in any hour, so that a page would be black: the scene "
            "has no opening, or its windows are opaque");
}

// Few bytes take few terms: 4 at least.
TEST_F(YearBasisOf, FewBytesAreFewTerms) {
  const DaylightModel model(test::room_with_window(test::diffuse(Bands(rgb_bands()), 0.5f)),
                            Vector3d::UnitZ(), Vector3d::UnitY(), coarse());
  const double of_term = 2.0 * model.mesh().vertex_count();
  const YearBasis basis = find_year_basis(
      model, hours, ground, {.error = 0.0, .rays = 256, .most_bytes = 11.0 * of_term});
  EXPECT_EQ(basis.term_count(), 8);
  EXPECT_EQ(basis.light.cols(), 8);
}

}  // namespace lightwell::year_basis_test
