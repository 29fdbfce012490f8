#include "radiosity/radiation/dome_views.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "radiosity/radiation/shortwave_model.h"
#include "tests/radiosity/radiation/street.h"

namespace lightwell::dome_views_test {
namespace {

using std::numbers::pi;
using street::height, street::width, street::zenith;

Eigen::Vector3d sun_at(double altitude_degrees, double azimuth_degrees) {
  const double a = altitude_degrees * pi / 180.0, b = azimuth_degrees * pi / 180.0;
  return {std::cos(a) * std::sin(b), std::cos(a) * std::cos(b), std::sin(a)};
}

// A clear sky, a hazy one and an overcast one.
std::vector<SunAndSky> skies() {
  std::vector<SunAndSky> skies;
  for (const auto& [sun, direct, diffuse] : {std::tuple{sun_at(35.0, 90.0), 800.0, 100.0},
                                             {sun_at(60.0, 0.0), 400.0, 250.0},
                                             {sun_at(20.0, 250.0), 0.0, 120.0}}) {
    const SunAndSky light{.sun = sun, .direct = direct, .diffuse = diffuse};
    skies.push_back(under_perez_sky(light, zenith, 80));
  }
  return skies;
}

// An integral over the upper hemisphere, by the midpoint rule in steps of 0.5 degrees.
double over_dome(const std::function<double(const Eigen::Vector3d& d)>& f) {
  constexpr int steps = 180;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double a = (i + 0.5) * 0.5 * pi / steps;
    for (int j = 0; j < 4 * steps; ++j) {
      const double b = (j + 0.5) * 0.5 * pi / steps;
      sum += f({std::cos(a) * std::sin(b), std::cos(a) * std::cos(b), std::sin(a)}) * std::cos(a);
    }
  }
  return sum * 0.25 * pi * pi / (steps * steps);
}

// Irradiance by the dome, and a bound of its noise, of a row that sees the share `open` of each
// direction, which it gets with the cosine `cosine`.
struct Expected {
  double irradiance = 0.0, noise = 0.0;
};
Expected expected(const SunAndSky& light, const std::function<double(const Eigen::Vector3d&)>& open,
                  const std::function<double(const Eigen::Vector3d&)>& cosine) {
  const Sky sky{.up = zenith,
                .north = Eigen::Vector3d::UnitY(),
                .gradation = *light.gradation,
                .bright = light.sun,
                .scale = Spectrum::Ones(1)};
  const auto L = [&](const Eigen::Vector3d& d) { return double{sky_radiance(sky, d)[0]}; };
  const double ground = over_dome([&](const Eigen::Vector3d& d) { return L(d) * d.z(); });
  // The variance of N independent rays is v (1 - v) / (N F) for a patch of the share F that is open
  // to v; the patch counts with F pi L.
  double variance = 0.0;
  Expected of;
  of.irradiance = light.diffuse / ground *
                  over_dome([&](const Eigen::Vector3d& d) { return L(d) * open(d) * cosine(d); });
  variance = over_dome([&](const Eigen::Vector3d& d) {
    const double w = pi * L(d) / ground;
    return w * w * open(d) * (1.0 - open(d)) * cosine(d) / pi;
  });
  of.noise = light.diffuse * std::sqrt(variance / 4096.0);
  return of;
}

double positive(double value) {
  return std::max(0.0, value);
}

TEST(DomeViews, OfOpenGroundGiveTheLightOfTheWeather) {
  const FacetViewFactors found =
      street::factors_between({{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}});
  const ElementCaster caster(found.mesh);
  ShortwaveModel model(found, caster, {}, zenith);
  model.see_dome();
  const auto lights = skies();
  model.run(lights, Eigen::ArrayXd::Zero(1), rays_of_one_sun,
            [&](int number, const ShortwaveInstant& light) {
              const double diffuse = lights[static_cast<std::size_t>(number)].diffuse;
              // A sum of 577 products of floats of one sign.
              EXPECT_NEAR(light.diffuse[0], diffuse, 2.0 * 577 * 0x1p-24 * diffuse);
            });
}

TEST(DomeViews, AddUpToSkyViewFactors) {
  const FacetViewFactors found = street::endless_street();
  const ElementCaster caster(found.mesh);
  const Eigen::ArrayXd sky_view = sky_view_factors(found, zenith);
  const SkyPatches sky(1, zenith, Eigen::Vector3d::UnitY());
  const DomeViews views = dome_views(found, caster, sky, sky_view);
  for (int row = 0; row < 3; ++row) {
    // A sum of 145 floats of one sign.
    EXPECT_NEAR(views.row(row).sum(), sky_view[row], 145 * 0x1p-24);
    EXPECT_GE(views.row(row).minCoeff(), 0.0f);
  }
}

// A ray of the road in the direction d passes over the walls from the share 1 - (h / w) |dx| / dz
// of the road's width on; one of a wall over the other from (w / h) dz / |dx| of its height down.
TEST(DomeViews, OfAStreetGiveTheIntegralsOfPerezSky) {
  // Rays have single precision: 1e-7 of the length of 10 km, 1 mm.
  const FacetViewFactors found = street::endless_street(1e4);
  const ElementCaster caster(found.mesh);
  ShortwaveModel model(found, caster, {}, zenith);
  model.see_dome();
  const auto lights = skies();
  const auto over_road = [](const Eigen::Vector3d& d) {
    return positive(1.0 - height / width * std::abs(d.x()) / d.z());
  };
  const auto over_wall = [](const Eigen::Vector3d& d) {
    return std::min(1.0, width / height * d.z() / std::abs(d.x()));
  };
  model.run(
      lights, Eigen::ArrayXd::Zero(3), rays_of_one_sun,
      [&](int number, const ShortwaveInstant& light) {
        const SunAndSky& sky = lights[static_cast<std::size_t>(number)];
        const std::array rows = {
            expected(sky, over_road, [](const Eigen::Vector3d& d) { return d.z(); }),
            expected(sky, over_wall, [](const Eigen::Vector3d& d) { return positive(d.x()); }),
            expected(sky, over_wall, [](const Eigen::Vector3d& d) { return positive(-d.x()); })};
        for (std::size_t r = 0; r < rows.size(); ++r) {
          const double found_here = light.diffuse[static_cast<Eigen::Index>(r)];
          // Stratified rays err less than independent ones. A product of means over patches that
          // are h = 0.108 rad high is off by h^2 / 12 (L'/L) (v'/v), where radiance falls by e in
          // 1/3 rad about the sun, and openness v in no less low above the horizon: 0.9 %. Through
          // the ends goes less than (width + height) / length = 0.25 % of a row's light.
          EXPECT_NEAR(found_here, rows[r].irradiance,
                      4.0 * rows[r].noise + (0.009 + 0.0025) * sky.diffuse)
              << number << " " << r;
        }
        // The wall that faces the sun is brighter than under an even sky, the other one darker.
        if (number != 0) return;
        EXPECT_GT(light.diffuse[1], sky.diffuse * model.sky_view()[1]);
        EXPECT_LT(light.diffuse[2], sky.diffuse * model.sky_view()[2]);
      });
}

}  // namespace
}  // namespace lightwell::dome_views_test
