#include "validation/cases/sky_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "validation/cases/reference_data.h"

namespace lightwell::sky_scenes_test {
namespace {

// The quadrature that stands for panes in the cases of CIE 171, with the report's own polynomial
// (Tregenza & Sharples, algorithm 2.34), beside the stored numbers of another quadrature. Gauss's
// rule over 32 x 32 pieces of the opening leaves the cusp of skies about the sun, 5e-4 of the light
// at most.
TEST(LightThroughAnOpening, IsThatOfTheStoredQuadrature) {
  const std::array<double, 6> c = {-0.028378, 3.156075, -3.058376, -1.428919, 4.014235, -1.775827};
  const auto polynomial = [&c](double x) {
    double sum = 0.0;
    for (std::size_t i = c.size(); i-- > 0;) sum = sum * x + c[i];
    return sum;
  };
  int compared = 0;
  for (const ReferenceValue& one : reference_cases(validation_data::cie171_json)) {
    if (one.at("kind") != "cie171-daylight" || one.at("photometry").at("glazing").is_null())
      continue;
    const ReferenceValue& g = one.at("geometry");
    const Opening opening{.origin = reference_point(g.at("opening").at("origin")),
                          .u = reference_point(g.at("opening").at("u")),
                          .v = reference_point(g.at("opening").at("v"))};
    for (const int number : {1, 5, 12, 16}) {
      const std::string name = std::to_string(number);
      const Sky sky = numbered_sky(number, reference_point(g.at("sun_direction")));
      const double E = one.at("Ehz_relative").at(name);
      for (const auto& [point, SC] : one.at("SC_percent").at(name).items()) {
        const SurfacePoint at{.position = reference_point(g.at("points").at(point)),
                              .normal = reference_point(g.at("normals").at(point))};
        const double expected = SC;
        const double found = 100.0 / E * light_through(opening, sky, at, polynomial);
        EXPECT_NEAR(found, expected, 5e-4 * expected + 1e-9) << one.at("id") << " " << point;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 100);
}

// Given by construction, and Fresnel's limits: T falls to 0 at grazing incidence.
TEST(PaneOfTransmittance, HasItAlongTheNormal) {
  const ClearPane pane = pane_of_transmittance(0.8788);
  EXPECT_NEAR(pane_transmittance(pane, 1.0), 0.8788, 1e-12);
  EXPECT_LT(pane.transmissivity, 1.0);
  EXPECT_NEAR(pane_transmittance(pane, 1e-9), 0.0, 1e-6);
}

}  // namespace
}  // namespace lightwell::sky_scenes_test
