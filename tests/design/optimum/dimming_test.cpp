#include "design/optimum/dimming.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace lightwell::dimming_test {
namespace {

/// Relative tolerance of a level: rows are kept to 1e-8, and a level here depends on a few rows
/// with factors of about 1.
constexpr double exact = 1e-6;

/// Two luminaires over two points. The first gives 400 lx and 200 lx for 50 W, the second 100 lx
/// and 300 lx for 30 W.
DimmingProblem two_by_two() {
  DimmingProblem problem{.luminaires = {{.name = "a", .cost = 50.0}, {.name = "b", .cost = 30.0}},
                         .grids = {{.name = "desk", .lux = Eigen::MatrixXd(2, 2)}}};
  problem.grids[0].lux << 400.0, 100.0, 200.0, 300.0;
  return problem;
}

/// The least of both points is to be 250 lx. Where both constraints hold, 400 a + 100 b = 250 and
/// 200 a + 300 b = 250, so that a = b = 0.5: 40 W. Along either constraint the cost rises: with the
/// first alone a costs 50/400 and b 30/100 W/lx, with the second alone 50/200 and 30/300 W/lx.
///
/// Dual values y solve 400 y1 + 200 y2 = 50 and 100 y1 + 300 y2 = 30: y1 = 0.09, y2 = 0.07. Both
/// bounds are the same limit, whose price is 0.16 W/lx.
TEST(Dimming, OfTwoLuminairesIsThatByHand) {
  DimmingProblem problem = two_by_two();
  problem.limits = {{.kind = LimitKind::least_at_least, .value = 250.0}};
  const DimmingPlan plan = best_dimming(problem);
  ASSERT_TRUE(plan.is_feasible);
  EXPECT_NEAR(plan.levels[0], 0.5, exact);
  EXPECT_NEAR(plan.levels[1], 0.5, exact);
  EXPECT_NEAR(plan.cost, 40.0, 40.0 * exact);
  EXPECT_NEAR(plan.price[0], 0.16, 0.16 * exact);
  EXPECT_NEAR(plan.reached[0], 250.0, 250.0 * exact);
}

/// The mean, 300 a + 200 b, is cheapest by the second luminaire, 0.15 W/lx, and then by the first,
/// 0.167 W/lx: b = 1 and a = 1/6 for 250 lx. A uniformity of 0.8 needs 400 a + 100 b >= 0.8 (300 a
/// + 200 b), 160 a >= 60 b. With a mean of 250 lx, b = 250 / 312.5 = 0.8 and a = 0.3.
TEST(Dimming, UniformityTakesLightToTheDarkestPoint) {
  DimmingProblem problem = two_by_two();
  problem.limits = {{.kind = LimitKind::mean_at_least, .value = 250.0}};
  const DimmingPlan free = best_dimming(problem);
  EXPECT_NEAR(free.levels[0], 1.0 / 6.0, exact);
  EXPECT_NEAR(free.levels[1], 1.0, exact);
  EXPECT_NEAR(free.price[0], 50.0 / 300.0, exact);
  problem.limits.push_back({.kind = LimitKind::uniformity_at_least, .value = 0.8});
  const DimmingPlan even = best_dimming(problem);
  ASSERT_TRUE(even.is_feasible);
  EXPECT_NEAR(even.levels[0], 0.3, exact);
  EXPECT_NEAR(even.levels[1], 0.8, exact);
  EXPECT_NEAR(even.reached[1], 0.8, exact);
  EXPECT_GT(even.cost, free.cost);
}

/// At full level the mean is 500 lx. No levels reach 600 lx, and the nearest are full.
TEST(Dimming, OutOfReachIsNearestAtFullPower) {
  DimmingProblem problem = two_by_two();
  problem.limits = {{.kind = LimitKind::mean_at_least, .value = 600.0}};
  const DimmingPlan plan = best_dimming(problem);
  EXPECT_FALSE(plan.is_feasible);
  EXPECT_NEAR(plan.levels[0], 1.0, exact);
  EXPECT_NEAR(plan.levels[1], 1.0, exact);
  EXPECT_NEAR(plan.reached[0], 500.0, 500.0 * exact);
}

/// A mean of 400 lx is within reach, but not with 100 lx at most at every point. With E at both
/// points the mean is missed by 1 - E/400 and the most by E/100 - 1, which are alike at E = 160 lx:
/// 400 a + 100 b = 160 and 200 a + 300 b = 160, a = b = 0.32.
TEST(Dimming, OfLimitsThatExcludeEachOtherTheWorstIsAsGoodAsCanBe) {
  DimmingProblem problem = two_by_two();
  problem.limits = {{.kind = LimitKind::mean_at_least, .value = 400.0},
                    {.kind = LimitKind::greatest_at_most, .value = 100.0}};
  const DimmingPlan plan = best_dimming(problem);
  EXPECT_FALSE(plan.is_feasible);
  EXPECT_NEAR(plan.levels[0], 0.32, exact);
  EXPECT_NEAR(plan.levels[1], 0.32, exact);
  EXPECT_NEAR(plan.reached[0], 160.0, 160.0 * exact);
}

/// Uniformity is perfect in the dark, but darkness is far from a mean out of reach: levels are
/// full.
TEST(Dimming, DarknessIsNotNearALimitOutOfReach) {
  DimmingProblem problem = two_by_two();
  problem.grids[0].lux << 400.0, 500.0, 20.0, 10.0;
  problem.limits = {{.kind = LimitKind::mean_at_least, .value = 50000.0},
                    {.kind = LimitKind::uniformity_at_least, .value = 0.9}};
  const DimmingPlan plan = best_dimming(problem);
  EXPECT_FALSE(plan.is_feasible);
  EXPECT_NEAR(plan.levels.minCoeff(), 1.0, 1e-4);  // 1e-8 of 50 000 lx, by one of 255 lx
}

TEST(Dimming, KeepsToLowestAndHighestLevels) {
  DimmingProblem problem = two_by_two();
  problem.luminaires[0].least = 0.25;
  problem.luminaires[1].most = 0.75;
  problem.limits = {{.kind = LimitKind::mean_at_least, .value = 10.0}};
  const DimmingPlan low = best_dimming(problem);
  EXPECT_DOUBLE_EQ(low.levels[0], 0.25);
  EXPECT_DOUBLE_EQ(low.levels[1], 0.0);
  EXPECT_NEAR(low.price[0], 0.0, exact);
  // 300 a + 150 = 300.
  problem.limits[0].value = 300.0;
  const DimmingPlan high = best_dimming(problem);
  EXPECT_NEAR(high.levels[0], 0.5, exact);
  EXPECT_NEAR(high.levels[1], 0.75, exact);
}

/// One level d for all: the mean is 500 d, the cost 80 W d.
TEST(Dimming, EvenLevelsAreOneVariable) {
  DimmingProblem problem = two_by_two();
  problem.limits = {{.kind = LimitKind::mean_at_least, .value = 250.0}};
  const DimmingPlan even = best_dimming(dimmed_evenly(problem));
  ASSERT_EQ(even.levels.size(), 1);
  EXPECT_NEAR(even.levels[0], 0.5, exact);
  EXPECT_NEAR(even.cost, 40.0, 40.0 * exact);
}

/// A root of a function that falls, in [low, high].
double bisect(const std::function<double(double)>& f, double low, double high) {
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (f(middle) > 0.0 ? low : high) = middle;
  }
  return low;
}

/// A cheap luminaire that dazzles, and a dear one that does not much. A mean of 300 lx by the cheap
/// one alone would be rated above 19, so that as much as possible of it shines: up to UGR = 19,
/// which bisection finds on the line of levels with that mean.
TEST(Dimming, GlareIsKeptWhereBisectionFindsIt) {
  DimmingProblem problem{
      .luminaires = {{.name = "cheap", .cost = 20.0}, {.name = "dear", .cost = 60.0}},
      .grids = {{.name = "desk", .lux = Eigen::MatrixXd(1, 2)}},
      .observers = {{.name = "eye", .glare = Eigen::VectorXd(2), .background = Eigen::VectorXd(2)}},
      .limits = {{.kind = LimitKind::mean_at_least, .value = 300.0},
                 {.kind = LimitKind::ugr_at_most, .value = 19.0}}};
  problem.grids[0].lux << 400.0, 350.0;
  problem.observers[0].glare << 60000.0, 4000.0;
  problem.observers[0].background << 20.0, 25.0;
  const auto levels = [](double cheap) {
    return Eigen::Vector2d(cheap, (300.0 - 400.0 * cheap) / 350.0);
  };
  const auto rating = [&](double cheap) {
    return value_at(problem, problem.limits[1], levels(cheap));
  };
  ASSERT_GT(rating(0.75), 19.0);
  const double cheap = bisect([&](double d) { return 19.0 - rating(d); }, 0.3, 0.75);
  const DimmingPlan plan = best_dimming(problem);
  ASSERT_TRUE(plan.is_feasible);
  // Squares are right to 4e-8, of levels of about 0.5: 1.6e-7 relative, 6e-7 of UGR, whose slope by
  // the level is 8 log10(e) / d = 7.
  EXPECT_NEAR(plan.levels[0], cheap, 1e-6);
  EXPECT_NEAR(plan.reached[1], 19.0, 1e-5);
  // Each tangent divides the error of a square by four: 0.06 becomes 4e-8 in 11 rounds.
  EXPECT_LE(plan.rounds, 15);
}

/// In sight of a black background every luminaire dazzles without bound, so it stays off.
TEST(Dimming, LuminaireBeforeABlackBackgroundStaysOff) {
  DimmingProblem problem = two_by_two();
  problem.observers = {
      {.name = "eye", .glare = Eigen::Vector2d(100.0, 0.0), .background = Eigen::Vector2d::Zero()}};
  problem.limits = {{.kind = LimitKind::mean_at_least, .value = 150.0},
                    {.kind = LimitKind::ugr_at_most, .value = 19.0}};
  const DimmingPlan plan = best_dimming(problem);
  ASSERT_TRUE(plan.is_feasible);
  // The root of 4e-8 is 2e-4, of which 300 lx, or 0.3 of a level, is made up by the other.
  EXPECT_NEAR(plan.levels[0], 0.0, 1e-3);
  EXPECT_NEAR(plan.levels[1], 0.75, 1e-3);
}

/// A room's worth of luminaires and points, with a binding limit of each kind.
DimmingProblem office() {
  constexpr int luminaires = 6, points = 8;
  DimmingProblem problem{.grids = {{.name = "desk", .lux = Eigen::MatrixXd(points, luminaires)},
                                   {.name = "room", .lux = Eigen::MatrixXd(points, luminaires)}},
                         .observers = {{.name = "eye",
                                        .glare = Eigen::VectorXd(luminaires),
                                        .background = Eigen::VectorXd(luminaires)}}};
  for (int i = 0; i < luminaires; ++i) {
    problem.luminaires.push_back({.cost = 20.0 + 3.0 * i + 5.0 * std::sin(2.0 * i)});
    problem.observers[0].glare[i] = i % 2 == 0 ? 9000.0 + 700.0 * i : 1500.0 + 90.0 * i;
    problem.observers[0].background[i] = 9.0 + 0.5 * i;
    for (int p = 0; p < points; ++p) {
      const double near = (p - 0.9 * i - 1.1) / 2.0, far = (p - 1.4 * i) / 4.0;
      problem.grids[0].lux(p, i) = 60.0 + 300.0 * std::exp(-near * near);
      problem.grids[1].lux(p, i) = 40.0 + 90.0 * std::exp(-far * far);
    }
  }
  problem.limits = {{.kind = LimitKind::mean_at_least, .place = 0, .value = 400.0},
                    {.kind = LimitKind::uniformity_at_least, .place = 0, .value = 0.6},
                    {.kind = LimitKind::greatest_at_most, .place = 1, .value = 220.0},
                    {.kind = LimitKind::ugr_at_most, .place = 0, .value = 16.5}};
  return problem;
}

/// Prices are derivatives of the least cost. Between changes of the basis the cost is linear in
/// limits of illuminance; in U_0 and UGR it is smooth, and central differences over 1e-4 of the
/// value are off by some 1e-8 of the derivative. Squares of levels are right to 4e-8, and the
/// slopes of their tangents, 2 d, to 2 * 2e-4: 4e-4 of the price of UGR at levels near 1.
TEST(Dimming, PricesAreDerivativesOfTheCost) {
  const DimmingProblem problem = office();
  const DimmingPlan plan = best_dimming(problem);
  ASSERT_TRUE(plan.is_feasible);
  int binding = 0;
  for (std::size_t k = 0; k < problem.limits.size(); ++k) {
    const double step = 1e-4 * problem.limits[k].value;
    DimmingProblem more = problem, less = problem;
    more.limits[k].value += step;
    less.limits[k].value -= step;
    const double slope = (best_dimming(more).cost - best_dimming(less).cost) / (2.0 * step);
    EXPECT_NEAR(plan.price[k], slope, 1e-3 * std::abs(slope) + 1e-9 * plan.cost) << k;
    binding += std::abs(slope) * problem.limits[k].value > 1e-3 * plan.cost ? 1 : 0;
    // A stricter limit never makes light cheaper.
    EXPECT_GE(is_lower_limit(problem.limits[k].kind) ? plan.price[k] : -plan.price[k], -1e-9);
  }
  EXPECT_EQ(binding, 4);
}

/// The objective of a problem: the least cost, or what the worst limit is missed by.
double objective(const DimmingProblem& problem) {
  const DimmingPlan plan = best_dimming(problem);
  return plan.is_feasible ? plan.cost : plan.worst_miss;
}

/// Central difference of the objective by an entry of the light, over 1e-4 of the largest.
double slope_by(DimmingProblem problem, double& (*entry)(DimmingProblem&, int), int i,
                double largest) {
  const double step = 1e-4 * largest;
  double& light = entry(problem, i);
  const double middle = light;
  light = middle + step;
  const double above = objective(problem);
  light = middle - step;
  return (above - objective(problem)) / (2.0 * step);
}

/// Prices of light are derivatives of the objective by each entry of the light. Central differences
/// over 1e-4 are off by some 1e-8; slopes of tangents of squares by 4e-4 (see above).
void expect_light_prices(const DimmingProblem& problem) {
  constexpr double of_tangents = 4e-4;
  const LightPrices prices = best_dimming(problem).light_price;
  for (const bool is_room : {false, true}) {
    const Eigen::MatrixXd& price = prices.lux[is_room ? 1 : 0];
    const double largest = std::max(1e-9, prices.lux[0].cwiseAbs().maxCoeff());
    for (int i = 0; i < price.size(); ++i) {
      const double slope =
          is_room
              ? slope_by(
                    problem,
                    [](DimmingProblem& p, int k) -> double& { return p.grids[1].lux.data()[k]; }, i,
                    100.0)
              : slope_by(
                    problem,
                    [](DimmingProblem& p, int k) -> double& { return p.grids[0].lux.data()[k]; }, i,
                    100.0);
      EXPECT_NEAR(price.data()[i], slope, of_tangents * largest)
          << "grid " << is_room << ", entry " << i;
    }
  }
  const double of_glare = prices.glare[0].cwiseAbs().maxCoeff();
  const double of_background = prices.background[0].cwiseAbs().maxCoeff();
  for (int i = 0; i < prices.glare[0].size(); ++i) {
    EXPECT_NEAR(
        prices.glare[0][i],
        slope_by(
            problem, [](DimmingProblem& p, int k) -> double& { return p.observers[0].glare[k]; }, i,
            9000.0),
        of_tangents * of_glare + 1e-12)
        << i;
    EXPECT_NEAR(
        prices.background[0][i],
        slope_by(
            problem,
            [](DimmingProblem& p, int k) -> double& { return p.observers[0].background[k]; }, i,
            10.0),
        of_tangents * of_background + 1e-12)
        << i;
  }
}

TEST(Dimming, LightPricesAreDerivativesOfTheCost) {
  expect_light_prices(office());
}

/// Out of reach, the worst miss is what light is worth something for.
TEST(Dimming, LightPricesOutOfReachAreDerivativesOfTheWorstMiss) {
  DimmingProblem problem = office();
  problem.limits[0].value = 1500.0;
  problem.limits[1].value = 0.9;
  ASSERT_FALSE(best_dimming(problem).is_feasible);
  EXPECT_GT(best_dimming(problem).worst_miss, 0.1);
  expect_light_prices(problem);
}

}  // namespace
}  // namespace lightwell::dimming_test
