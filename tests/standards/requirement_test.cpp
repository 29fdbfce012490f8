#include "standards/requirement.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

namespace lightwell::requirement_test {
namespace {

/// Four points, of which the darkest is known to 4 lx and the brightest to 10 lx; their mean, 250
/// lx, to 2 %.
LuxField four_points() {
  LuxField field = field_of(Eigen::Array4d(100, 200, 300, 400));
  field.lux_within = Eigen::Array4d(4, 5, 6, 10);
  field.mean_within = 0.02;
  return field;
}

/// The mean is 250 +- 5 lx.
TEST(Requirement, IsMetOrMissedByMoreThanItsError) {
  const LuxField field = four_points();
  const GridField of{"desk", &field};
  EXPECT_EQ(verdict_of(mean_at_least(244.0, of)), Verdict::met);
  EXPECT_EQ(verdict_of(mean_at_least(246.0, of)), Verdict::too_close);
  EXPECT_EQ(verdict_of(mean_at_least(254.0, of)), Verdict::too_close);
  EXPECT_EQ(verdict_of(mean_at_least(256.0, of)), Verdict::missed);
}

/// U_0 = 100/250 = 0.40, E_max/E_min = 4. Relative bounds: E_min 4 %, E_m 2 %, E_max 2.5 %. The
/// tolerances are those of arithmetic on numbers of a few units.
TEST(Requirement, OfARatioAddsTheErrorsOfBoth) {
  const LuxField field = four_points();
  const GridField of{"desk", &field};
  const Requirement uniformity = uniformity_at_least(0.6, of);
  EXPECT_NEAR(*uniformity.value, 0.40, 1e-12);
  EXPECT_NEAR(uniformity.within, 0.40 * (0.04 + 0.02), 1e-12);
  EXPECT_EQ(verdict_of(uniformity), Verdict::missed);
  const Requirement diversity = diversity_at_most(40.0, of);
  EXPECT_NEAR(*diversity.value, 4.0, 1e-12);
  EXPECT_NEAR(diversity.within, 4.0 * (0.04 + 0.025), 1e-12);
  EXPECT_EQ(verdict_of(diversity), Verdict::met);
}

/// The error of a point without any light is not known; the limit is missed all the same.
TEST(Requirement, IsMissedInTheDark) {
  LuxField field = field_of(Eigen::Array3d(0, 10, 20));
  const GridField of{"stairs", &field};
  EXPECT_EQ(verdict_of(least_at_least(1.0, of)), Verdict::missed);
  EXPECT_EQ(verdict_of(diversity_at_most(40.0, of)), Verdict::missed);
  EXPECT_EQ(verdict_of(uniformity_at_least(0.1, of)), Verdict::missed);
}

TEST(Requirement, WithoutAFigureIsMet) {
  EXPECT_EQ(verdict_of(Requirement{.figure = Figure::glare, .is_upper = true, .limit = 19.0}),
            Verdict::met);
}

/// A missed limit weighs more than one that is too close; a recommendation does not count.
TEST(Requirement, StandsWithOthersAsTheWorstOfThem) {
  const Requirement met{.limit = 1.0, .value = 2.0};
  const Requirement close{.limit = 1.0, .value = 2.0, .within = 3.0};
  const Requirement missed{.limit = 3.0, .value = 2.0};
  Requirement advice = missed;
  advice.is_recommended = true;
  EXPECT_EQ(verdict_of(std::array{met, advice}), Verdict::met);
  EXPECT_EQ(verdict_of(std::array{met, close}), Verdict::too_close);
  EXPECT_EQ(verdict_of(std::array{close, missed, met}), Verdict::missed);
}

/// R_a 81 +- 0.1 is surely above 80, and 81.5 +- 3 may lie below. A luminaire whose R_a is not
/// defined leaves the requirement open, and is named before all others.
TEST(Requirement, OfColourRenderingIsThatOfTheLuminaireWhichMayHaveTheLeast) {
  const auto worst_of = [](const std::vector<NamedRating>& luminaires) {
    std::vector<Requirement> requirements;
    add_colour_rendering(80.0, luminaires, "hall", requirements);
    return requirements.at(0);
  };
  const NamedRating sure{"sure", 81.0, 0.1}, vague{"vague", 81.5, 3.0};
  EXPECT_EQ(verdict_of(worst_of({sure})), Verdict::met);
  EXPECT_EQ(worst_of({sure, vague}).place, "vague");
  EXPECT_EQ(verdict_of(worst_of({sure, vague})), Verdict::too_close);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const NamedRating undefined{"green", nan, nan}, unbounded{"coarse", 95.0, nan};
  EXPECT_EQ(worst_of({sure, undefined, vague}).place, "green");
  EXPECT_EQ(verdict_of(worst_of({sure, undefined, vague})), Verdict::too_close);
  EXPECT_EQ(worst_of({sure, unbounded}).place, "coarse");
}

TEST(Requirement, OfOneAreaAreToldTogether) {
  const std::array all = {Requirement{.area = "a"}, Requirement{.area = "a"},
                          Requirement{.area = "b"}};
  const auto areas = by_area(all);
  ASSERT_EQ(areas.size(), 2u);
  EXPECT_EQ(areas[0].size(), 2u);
  EXPECT_EQ(areas[1].front().area, "b");
}

}  // namespace
}  // namespace lightwell::requirement_test
