#include "radiosity/radiation/shortwave.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "radiosity/radiation/shortwave_model.h"
#include "radiosity/radiation/sky_exposure.h"
#include "scene/errors.h"
#include "tests/radiosity/radiation/street.h"

namespace lightwell::shortwave_test {
namespace {

using street::endless_street, street::factors_between, street::height, street::width,
    street::zenith;

Eigen::Vector3d sun_over_second_wall(double altitude_degrees) {
  const double a = altitude_degrees * std::numbers::pi / 180.0;
  return {std::cos(a), 0.0, std::sin(a)};
}

// Factors of an endless street (Noilhan 1981; Masson 2000, "A physically-based scheme for the urban
// energy budget in atmospheric models").
const double road_sky = std::hypot(height / width, 1.0) - height / width;
const double wall_sky =
    0.5 * (height / width + 1.0 - std::hypot(height / width, 1.0)) * width / height;

TEST(SkyViewFactors, OfAStreetAreThoseOfItsClosedForm) {
  const Eigen::ArrayXd sky = sky_view_factors(endless_street(), zenith);
  // Two ends, and factors that are floats.
  EXPECT_NEAR(sky[0], road_sky, 5.1e-5);
  EXPECT_NEAR(sky[1], wall_sky, 5.1e-5);
  EXPECT_NEAR(sky[2], wall_sky, 5.1e-5);
}

// (1 + cos tilt) / 2 with nothing in the way, and no sky by way of a black back. Four standard
// errors of independent rays, of which there are 16384: stratified ones err less.
TEST(SkyViewFactors, LeaveOutTheGroundAndBacks) {
  const double a = std::sqrt(0.75);
  const auto alone = [](const std::array<Eigen::Vector3d, 4>& quad) {
    return sky_view_factors(factors_between({quad}), zenith)[0];
  };
  EXPECT_EQ(alone({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}), 1.0);
  EXPECT_EQ(alone({{{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}}), 0.0);
  const auto noise = [](double p) { return 4.0 * std::sqrt(p * (1.0 - p) / 16384.0); };
  EXPECT_NEAR(alone({{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}}), 0.5, noise(0.5));
  EXPECT_NEAR(alone({{{0, 0, 0}, {0.5, 0, a}, {0.5, 1, a}, {0, 1, 0}}}), 0.75, noise(0.75));
  // Parallel unit squares at distance 1: Howell's catalogue, C-11.
  const Eigen::ArrayXd below =
      sky_view_factors(factors_between({{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}},
                                        {{{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}}}),
                       zenith);
  EXPECT_NEAR(below[0], 1.0 - 0.199824896, noise(0.2));
  EXPECT_EQ(below[1], 1.0);
}

// The shadow of the second wall is height / tan(altitude) long. Its edge is straight along the
// street, so one of 16384 strips along the street is lit in part, to rays in single precision.
TEST(SunFactors, OfAStreetFollowTheShadowOfItsWall) {
  const FacetViewFactors found = endless_street(100.0);
  const double strip = 2.0 / 16384.0;
  const Eigen::ArrayXd high = sun_factors(found, sun_over_second_wall(60.0));
  const double root = std::sqrt(3.0);
  EXPECT_NEAR(high[0], 0.5 * root * (1.0 - height / (width * root)), strip);
  EXPECT_NEAR(high[1], 0.5, 1e-12);
  EXPECT_EQ(high[2], 0.0);
  const Eigen::ArrayXd low = sun_factors(found, sun_over_second_wall(45.0));
  EXPECT_EQ(low[0], 0.0);
  EXPECT_NEAR(low[1], std::sqrt(0.5) * width / height, strip);
}

// Three equations for the irradiances, with the closed forms of an endless street.
TEST(ShortwaveExchange, OfAStreetIsThatOfItsThreeEquations) {
  const FacetViewFactors found = endless_street();
  const Eigen::Array3d first(300.0, 500.0, 40.0), albedo(0.1, 0.6, 0.4);
  const ShortwaveExchange result = shortwave_exchange(found.factors, first, albedo);
  const double F_rw = 0.5 * (1.0 - road_sky), F_wr = F_rw * width / height;
  Eigen::Matrix3d F;
  F << 0.0, F_rw, F_rw, F_wr, 0.0, 1.0 - 2.0 * wall_sky, F_wr, 1.0 - 2.0 * wall_sky, 0.0;
  ASSERT_NEAR(F_wr, wall_sky, 1e-12);  // a wall sees as much of the road as of the sky
  const Eigen::Matrix3d M = Eigen::Matrix3d::Identity() - F * albedo.matrix().asDiagonal();
  const Eigen::Array3d E = M.partialPivLu().solve(first.matrix()).array();
  // Each of the factors errs by 5.1e-5 of less than 600 W/m2, twice over by further reflections.
  EXPECT_LT((result.net - (1.0 - albedo) * E).abs().maxCoeff(), 0.07);
  EXPECT_LT((result.reflected - (E - first)).abs().maxCoeff(), 0.07);
  EXPECT_NEAR(result.absorbed + result.escaped, result.arriving, 1e-6 * result.arriving);
}

// Two plates of albedo 0.99 that see all of each other, one lit: E_0 = 1 / (1 - 0.99^2).
TEST(ShortwaveExchange, AddsUpManyReflections) {
  ViewFactors plates(2);
  plates.area = {1.0, 1.0};
  plates.factors.append(0, std::array{FormFactor{1, 1.0f}});
  plates.factors.append(1, std::array{FormFactor{0, 1.0f}});
  plates.factors.close();
  const ShortwaveExchange result =
      shortwave_exchange(plates, Eigen::Array2d(1.0, 0.0), Eigen::Array2d::Constant(0.99));
  // A change of 1e-10 in a sweep leaves at most 1e-10 / (1 - 0.99).
  EXPECT_NEAR(result.net[0], 0.01 / (1.0 - 0.99 * 0.99), 1e-8);
  EXPECT_NEAR(result.absorbed, 1.0, 1e-7);
  EXPECT_EQ(result.escaped, 0.0);
}

// A point of the road sees the sky between the walls' tops, which stand at the angles a and b above
// the horizon: (cos a + cos b) / 2. A point of a wall at the height z sees it above the other's top
// and up to its own plane: (1 - sin c) / 2, c of the other's top.
TEST(PointViews, OfAStreetAreThoseOfItsClosedForm) {
  const FacetViewFactors found = endless_street();
  const ElementCaster caster(found.mesh);
  const double y = 5e5, x = 2.5, z = 6.0;
  const std::vector<SurfacePoint> points{
      {.position = {x, y, 0.0}, .normal = zenith, .facet = 0},
      {.position = {0.0, y, z}, .normal = Eigen::Vector3d::UnitX(), .facet = 1},
      {.position = {x, y, height + 1.0}, .normal = zenith},
      {.position = {x, y, 1.0}, .normal = -zenith}};
  const PointViews views = point_views(found, caster, points, zenith);
  const auto cosine = [](double d) { return d / std::hypot(d, height); };
  const double of_road = 0.5 * (cosine(x) + cosine(width - x));
  const double of_wall = 0.5 * (1.0 - (height - z) / std::hypot(height - z, width));
  // Four standard errors of independent rays; stratified ones err less.
  const auto noise = [](double p) { return 4.0 * std::sqrt(p * (1.0 - p) / 16384.0); };
  EXPECT_NEAR(views.sky[0], of_road, noise(of_road));
  EXPECT_NEAR(views.sky[1], of_wall, noise(of_wall));
  EXPECT_EQ(views.sky[2], 1.0);
  EXPECT_EQ(views.sky[3], 0.0);
  ASSERT_EQ(views.rows[0].size(), 2u);
  EXPECT_NEAR(views.rows[0][0].value, 0.5 * (1.0 - cosine(x)), noise(0.5 * (1.0 - cosine(x))));
  // From 1 m above, the road ends at the feet of both walls.
  const double below = 0.5 * (x / std::hypot(x, 1.0) + (width - x) / std::hypot(width - x, 1.0));
  ASSERT_EQ(views.rows[3].size(), 3u);
  EXPECT_NEAR(views.rows[3][0].value, below, noise(below));
  // A sun at 45 degrees shines on the road from x = height on, and above the walls.
  const Eigen::ArrayXd sun = point_sun_factors(caster, points, sun_over_second_wall(45.0));
  EXPECT_EQ(sun[0], 0.0);
  EXPECT_NEAR(sun[1], std::sqrt(0.5), 1e-12);  // the shadow ends at height - width = 5 m
  EXPECT_NEAR(sun[2], std::sqrt(0.5), 1e-12);
  EXPECT_EQ(sun[3], 0.0);
}

// Light of an instant does not depend on those beside it; the light at points in the middle of the
// road is near that of the rows they lie on, and adds up with the model's rows.
TEST(ShortwaveModel, ComputesEachInstantAsIfItWereAlone) {
  const FacetViewFactors found = endless_street();
  const ElementCaster caster(found.mesh);
  const std::vector<SurfacePoint> points{
      {.position = {0.5 * width, 5e5, 0.0}, .normal = zenith, .facet = 0}};
  const ShortwaveModel model(found, caster, points, zenith);
  const Eigen::Array3d albedo(0.1, 0.6, 0.4);
  std::vector<SunAndSky> instants;
  for (int i = 0; i < 40; ++i) {  // more than are computed at the same time
    instants.push_back(
        {.sun = sun_over_second_wall(50.0 + i), .direct = 20.0 * i, .diffuse = 100.0 + i});
  }
  int seen = 0;
  model.run(instants, albedo, rays_of_many_suns, [&](int number, const ShortwaveInstant& light) {
    EXPECT_EQ(number, seen++);
    const auto h = static_cast<std::size_t>(number);
    if (number % 13 != 0) return;
    model.run(std::span(instants).subspan(h, 1), albedo, rays_of_many_suns,
              [&](int, const ShortwaveInstant& alone) {
                EXPECT_TRUE((alone.direct == light.direct).all());
                EXPECT_TRUE((alone.exchange.net == light.exchange.net).all());
                EXPECT_TRUE((alone.point_reflected == light.point_reflected).all());
              });
    const double sky = model.points().sky[0];
    EXPECT_DOUBLE_EQ(light.point_diffuse[0], (100.0 + number) * sky);
    // Symmetry gives each of the two walls half of what the sky leaves, F = (1 - sky) / 2; four
    // standard errors of independent rays.
    const Eigen::ArrayXd E = light.direct + light.diffuse + light.exchange.reflected;
    const double expected = 0.5 * (1.0 - sky) * (0.6 * E[1] + 0.4 * E[2]);
    EXPECT_NEAR(light.point_reflected[0], expected,
                4.0 * std::sqrt(0.25 / 16384.0) * (0.6 * E[1] + 0.4 * E[2]));
  });
  EXPECT_EQ(seen, 40);
}

// Hours of a day under Perez' sky: their sum is that of single solves, and light that arrives is
// absorbed or leaves.
TEST(ShortwaveModel, SumsHoursUnderPerezSkyAsSingleSolvesDo) {
  const FacetViewFactors found = endless_street();
  const ElementCaster caster(found.mesh);
  const std::vector<SurfacePoint> points{
      {.position = {0.5 * width, 5e5, 0.0}, .normal = zenith, .facet = 0}};
  ShortwaveModel model(found, caster, points, zenith);
  model.see_dome();
  const Eigen::Array3d albedo(0.1, 0.6, 0.4);
  std::vector<SunAndSky> hours;
  for (int h = 0; h < 40; ++h) {
    const SunAndSky even{
        .sun = sun_over_second_wall(5.0 + 2.0 * h), .direct = 20.0 * h, .diffuse = 80.0 + h};
    hours.push_back(under_perez_sky(even, zenith, 172));
    EXPECT_TRUE(hours.back().gradation.has_value());
  }
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(3), alone = sum;
  const auto add_to = [&](Eigen::ArrayXd& net) {
    return [&](int, const ShortwaveInstant& light) {
      net += light.exchange.net;
      EXPECT_NEAR(light.exchange.absorbed + light.exchange.escaped, light.exchange.arriving,
                  1e-6 * light.exchange.arriving);
      EXPECT_GT(light.point_diffuse[0], 0.0);
    };
  };
  model.run(hours, albedo, rays_of_many_suns, add_to(sum));
  for (std::size_t h = 0; h < hours.size(); ++h) {
    model.run(std::span(hours).subspan(h, 1), albedo, rays_of_many_suns, add_to(alone));
  }
  // Both solve the same equations, with an error of 1e-8 each (see least_change in shortwave.cpp).
  EXPECT_LT((sum / alone - 1.0).abs().maxCoeff(), 2e-8);
}

TEST(ShortwaveModel, NeedsTheDomeForSkiesThatAreNotEven) {
  const FacetViewFactors found = endless_street();
  const ElementCaster caster(found.mesh);
  const ShortwaveModel model(found, caster, {}, zenith);
  const SunAndSky overcast{.diffuse = 100.0, .gradation = standard_sky(1)};
  const auto ignore = [](int, const ShortwaveInstant&) {};
  EXPECT_THROW(model.run({&overcast, 1}, Eigen::Array3d::Zero(), rays_of_many_suns, ignore),
               std::logic_error);
}

// Dark domes, and suns below the horizon, have no state in Perez' model.
TEST(UnderPerezSky, LeavesDarkSkiesEven) {
  const SunAndSky dark{.direct = 500.0}, night{.sun = -zenith, .diffuse = 10.0};
  EXPECT_FALSE(under_perez_sky(dark, zenith, 1).gradation.has_value());
  EXPECT_FALSE(under_perez_sky(night, zenith, 1).gradation.has_value());
}

TEST(ShortwaveModel, StopsWhereProgressSaysSo) {
  const FacetViewFactors found = endless_street();
  const ElementCaster caster(found.mesh);
  const ShortwaveModel model(found, caster, {}, zenith);
  const Progress stop_at_half = [](std::string_view, double share) { return share < 0.5; };
  const std::vector<SunAndSky> instants(4, {.direct = 1.0});
  const auto ignore = [](int, const ShortwaveInstant&) {};
  EXPECT_THROW(
      model.run(instants, Eigen::Array3d(0, 0, 0), rays_of_many_suns, ignore, stop_at_half),
      Interrupted);
  const Progress never = [](std::string_view, double) { return false; };
  EXPECT_THROW(sky_view_factors(found, zenith, never), Interrupted);
}

TEST(ShortwaveExchange, RefusesNumbersOutOfRange) {
  ViewFactors plates(2);
  const auto solve = [&](double irradiance, double albedo) {
    shortwave_exchange(plates, Eigen::Array2d(1.0, irradiance), Eigen::Array2d(0.5, albedo));
  };
  EXPECT_NO_THROW(solve(0.0, 0.99));
  for (const double wrong : {-0.1, 1.0, std::nan("")}) EXPECT_THROW(solve(0.0, wrong), InputError);
  for (const double wrong : {-0.1, double{INFINITY}}) EXPECT_THROW(solve(wrong, 0.5), InputError);
  EXPECT_THROW(shortwave_exchange(plates, Eigen::ArrayXd(1), Eigen::ArrayXd(2)), InputError);
}

}  // namespace
}  // namespace lightwell::shortwave_test
