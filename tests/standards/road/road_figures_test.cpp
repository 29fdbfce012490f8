#include "standards/road/road_figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "standards/road/road_spacing.h"
#include "tests/standards/road/road_of_lamps.h"

namespace lightwell::road_figures_test {
namespace {

const std::string street = LIGHTWELL_TEST_DATA "/../../examples/road/street.toml";

/// L_m, U_o, U_l, f_TI of the drivers; E_m and E_min of the carriageway; R_EI right and left.
struct Reference {
  std::array<std::array<double, 4>, 2> drivers;
  std::array<double, 2> lux, edges;
};

/// The references come from road_reference.py beside this file, which shares no code with the
/// program and prints 8 digits.
void expect_near(const RoadFigures& figures, const Reference& reference) {
  const auto near = [](double value, double wanted) { EXPECT_NEAR(value, wanted, 1e-7 * wanted); };
  for (std::size_t i = 0; i < 2; ++i) {
    const RoadObserver& seen = figures.observers[i];
    near(seen.luminance, reference.drivers[i][0]);
    near(seen.uniformity, reference.drivers[i][1]);
    near(seen.longitudinal_uniformity, reference.drivers[i][2]);
    near(seen.threshold_increment, reference.drivers[i][3]);
    near(figures.edges[i].value, reference.edges[i]);
  }
  near(figures.illuminance.front().field.mean, reference.lux[0]);
  near(figures.illuminance.front().field.least, reference.lux[1]);
}

TEST(RoadFigures, AreThoseOfAnIndependentComputation) {
  Road road = read_road(street);
  expect_near(road_figures(road), {{{{0.90839282, 0.50769934, 0.65085429, 8.8229194},
                                     {0.96459416, 0.50861134, 0.83758947, 4.7581509}}},
                                   {14.953786, 7.4347696},
                                   {0.24469968, 0.42196715}});
  road.width = 7.5;
  road.oncoming = 0;
  road.surface = standard_r_table("R2");
  road.luminaires.arrangement = RoadArrangement::staggered;
  road.luminaires.spacing = 40.0;
  road.luminaires.height = 9.0;
  road.luminaires.overhang = 1.0;
  road.luminaires.tilt = 10.0;
  road.luminaires.maintenance = 0.75;
  expect_near(road_figures(road), {{{{0.98460979, 0.63524838, 0.81384742, 6.0539927},
                                     {0.98351278, 0.61758427, 0.81384742, 6.0593942}}},
                                   {14.501241, 9.3421403},
                                   {0.46890816, 0.46890816}});
}

/// A carriageway beside a median of 3 m, and one of more than 5 cd/m^2, where f_TI has another
/// formula, with tilted luminaires on the left.
TEST(RoadFigures, OfMediansAndBrightRoadsAreThoseOfAnIndependentComputation) {
  Road road = read_road(street);
  road.strips.clear();
  road.oncoming = 0;
  road.median = 3.0;
  road.surface = standard_r_table("C2");
  road.luminaires.arrangement = RoadArrangement::median;
  road.luminaires.spacing = 32.0;
  road.luminaires.height = 10.0;
  expect_near(road_figures(road), {{{{0.82451881, 0.6221496, 0.91316066, 4.7514539},
                                     {0.77758369, 0.609154, 0.77866333, 5.9410296}}},
                                   {11.636889, 7.0144213},
                                   {0.6142473, 0.70362905}});
  road = read_road(street);
  road.surface = standard_r_table("R1");
  road.luminaires.arrangement = RoadArrangement::single_left;
  road.luminaires.tilt = 5.0;
  road.luminaires.flux_factor = 10.0;
  expect_near(road_figures(road), {{{{12.882186, 0.64582239, 0.68496525, 5.6984249},
                                     {12.741143, 0.65742473, 0.76659388, 7.4709757}}},
                                   {139.65777, 64.119733},
                                   {0.5322931, 0.16748664}});
}

/// D_P = P / sum(E A) and D_E = P t / (1000 A) over the areas that have a class: of 40 m by 7 m,
/// and of a strip of 2 m once a class makes it an area to be lit. Of two carriageways everything
/// counts twice but a strip in the median. Rounding of a few products is below 1e-12.
TEST(RoadFigures, OfPowerCountTheAreasToBeLit) {
  Road road = road_of_even_lamps();
  road.classes = {*find_road_class("C3")};
  road.luminaires.watts = 50.0;
  road.hours = 4000.0;
  road.strips = {{.name = "verge", .is_left = true, .width = 2.0}};
  const auto expect_power = [&](double watts, double carriageways, double strips) {
    const RoadFigures figures = road_figures(road);
    const double area = carriageways * 280.0, strip = strips * 80.0;
    const double flux =
        area * figures.illuminance[0].field.mean + strip * figures.illuminance[1].field.mean;
    EXPECT_NEAR(*figures.power_density, watts / flux, 1e-12);
    EXPECT_NEAR(*figures.energy, watts * 4.0 / (area + strip), 1e-12);
  };
  expect_power(50.0, 1.0, 0.0);
  road.strips.front().classes = {*find_road_class("P5")};
  expect_power(50.0, 1.0, 1.0);
  road.luminaires.arrangement = RoadArrangement::median;
  road.median = 3.0;
  expect_power(100.0, 2.0, 1.0);
  road.strips.front().is_left = false;
  expect_power(100.0, 2.0, 2.0);
}

/// Half a metre apart up to 400 points: a spacing of 40 m has 80 columns, and one of 500 m 400; 7 m
/// and a lane of 3.5 m on either side have 28 rows.
TEST(RoadFigures, AreMappedByAFewThousandPoints) {
  Road road = road_of_even_lamps();
  EXPECT_EQ(illuminance_map(road).grid.columns, 80);
  EXPECT_EQ(illuminance_map(road).grid.rows, 28);
  road.luminaires.spacing = 500.0;
  EXPECT_EQ(illuminance_map(road).grid.columns, 400);
}

/// The same requirements with the same figures, in the order of their areas and symbols; `swaps`:
/// right and left are exchanged.
void expect_same_limits(const RoadFigures& a, const RoadFigures& b) {
  ASSERT_EQ(a.requirements.size(), b.requirements.size());
  for (std::size_t i = 0; i < a.requirements.size(); ++i) {
    EXPECT_EQ(a.requirements[i].figure, b.requirements[i].figure);
    EXPECT_EQ(a.requirements[i].area, b.requirements[i].area);
    EXPECT_NEAR(*a.requirements[i].value, *b.requirements[i].value,
                1e-9 * *a.requirements[i].value);
  }
}

/// A luminaire that is the same on both sides of the plane C90 to C270 gives a road and its mirror
/// image the same figures: traffic on the other side, masts and strips on the other side. Rounding
/// of sums of some hundred values is below 1e-9.
TEST(RoadFigures, OfAMirroredRoadAreTheSame) {
  Road road = read_road(street);
  Road mirrored = road;
  mirrored.drives_on_left = true;
  mirrored.luminaires.arrangement = RoadArrangement::single_left;
  for (RoadStrip& strip : mirrored.strips) strip.is_left = !strip.is_left;
  expect_same_limits(road_figures(road), road_figures(mirrored));
  road.median = mirrored.median = 3.0;
  road.oncoming = mirrored.oncoming = 0;
  road.luminaires.arrangement = mirrored.luminaires.arrangement = RoadArrangement::median;
  expect_same_limits(road_figures(road), road_figures(mirrored));
}

/// Traffic the other way meets the same road, turned by 180 degrees, where masts stand on both
/// sides; lanes change places.
TEST(RoadFigures, OfATurnedRoadAreTheSame) {
  Road road = road_of_even_lamps();
  road.luminaires.arrangement = RoadArrangement::opposite;
  road.classes = {*find_road_class("M3")};
  Road turned = road;
  turned.oncoming = 2;
  const RoadFigures a = road_figures(road), b = road_figures(turned);
  expect_same_limits(a, b);
  EXPECT_NEAR(a.observers[0].luminance, b.observers[1].luminance, 1e-9);
  EXPECT_NEAR(a.observers[0].glare_eye_x, 40.0 - b.observers[1].glare_eye_x, 1e-9);
}

/// Luminaires of the other carriageway light this one only within 5 heights: 200 m away they give
/// nothing, 3 m away they add their light.
TEST(RoadFigures, OfTwoCarriagewaysHaveTheLightOfBothRows) {
  Road road = road_of_even_lamps();
  road.classes = {*find_road_class("C3")};
  road.luminaires.arrangement = RoadArrangement::single_left;
  const double alone = road_figures(road).illuminance.front().field.mean;
  road.luminaires.arrangement = RoadArrangement::median;
  road.median = 200.0;
  EXPECT_NEAR(road_figures(road).illuminance.front().field.mean, alone, 1e-12);
  road.median = 3.0;
  EXPECT_GT(road_figures(road).illuminance.front().field.mean, 1.5 * alone);
}

/// EN 13201-3: 10 points along up to 30 m, then at most 3 m apart; 3 rows in a lane; rows of
/// illuminance at most 1.5 m apart, and at least 3.
TEST(RoadFigures, HaveTheGridsOfTheStandard) {
  Road road = road_of_even_lamps();
  road.luminaires.spacing = 30.0;
  EXPECT_EQ(road_grid(road, 0.0, 7.0, 6).columns, 10);
  road.luminaires.spacing = 30.1;
  EXPECT_EQ(road_grid(road, 0.0, 7.0, 6).columns, 11);
  road.luminaires.spacing = 36.0;
  EXPECT_EQ(road_grid(road, 0.0, 7.0, 6).columns, 12);
  EXPECT_EQ(road_figures(road).luminance.grid.rows, 6);
  EXPECT_EQ(illuminance_rows(7.0), 5);
  EXPECT_EQ(illuminance_rows(7.5), 5);
  EXPECT_EQ(illuminance_rows(2.0), 3);
  const LuxGrid grid = road_grid(road, -2.0, 2.0, 4);
  EXPECT_NEAR((grid.points.front().position - Eigen::Vector3d(1.5, -1.75, 0.0)).norm(), 0.0, 1e-12);
}

/// Flux is power over lamps: with all light doubled, L_m and E double, uniformities stay, and f_TI
/// grows by 2^0.2 while L_m stays below 5 cd/m^2. Maintenance does not change f_TI.
TEST(RoadFigures, FollowTheFlux) {
  Road road = read_road(street);
  const RoadFigures once = road_figures(road);
  road.luminaires.flux_factor *= 2.0;
  const RoadFigures twice = road_figures(road);
  const RoadObserver &a = once.observers[0], &b = twice.observers[0];
  EXPECT_NEAR(b.luminance, 2.0 * a.luminance, 1e-12);
  EXPECT_NEAR(b.uniformity, a.uniformity, 1e-12);
  EXPECT_NEAR(b.threshold_increment, std::pow(2.0, 0.2) * a.threshold_increment, 1e-9);
  EXPECT_NEAR(*twice.power_density, 0.5 * *once.power_density, 1e-12);
  road.luminaires.maintenance *= 0.5;
  EXPECT_NEAR(road_figures(road).observers[0].threshold_increment, b.threshold_increment, 1e-9);
}

std::vector<Figure> figures_of(const Road& road) {
  std::vector<Figure> figures;
  for (const Requirement& one : road_figures(road).requirements) figures.push_back(one.figure);
  return figures;
}

/// The figures that the classes of EN 13201-2 limit. An edge ratio is asked for at edges where no
/// strip with a class of its own begins, and not at a median.
TEST(RoadFigures, AreHeldToTheLimitsOfTheClasses) {
  Road road = road_of_even_lamps();
  road.classes = {*find_road_class("M3")};
  using enum Figure;
  EXPECT_EQ(figures_of(road), (std::vector{luminance, overall_uniformity, longitudinal_uniformity,
                                           threshold_increment, edge_ratio, edge_ratio}));
  road.strips = {{.name = "path", .width = 2.0, .classes = {*find_road_class("P4")}}};
  EXPECT_EQ(figures_of(road), (std::vector{luminance, overall_uniformity, longitudinal_uniformity,
                                           threshold_increment, edge_ratio, mean, mean, least}));
  road.wet_surface = standard_r_table("R4");
  road.strips.front().classes = {*find_road_class("EV3"), *find_road_class("SC2")};
  EXPECT_EQ(figures_of(road),
            (std::vector{luminance, overall_uniformity, longitudinal_uniformity, wet_uniformity,
                         threshold_increment, edge_ratio, least_vertical, least_vertical,
                         least_semicylindrical, least_semicylindrical}));
  road.strips.clear();
  road.classes = {*find_road_class("C2")};
  EXPECT_EQ(figures_of(road), (std::vector{mean, uniformity}));
}

/// The greatest spacing meets the classes, and the next one tried does not.
TEST(RoadSpacing, IsTheGreatestThatMeetsTheClasses) {
  Road road = read_road(street);
  const auto ranges = spacings_that_meet(road);
  ASSERT_FALSE(ranges.empty());
  for (const SpacingRange& range : ranges) {
    const auto meets = [&](double spacing) {
      road.luminaires.spacing = spacing;
      return road_figures(road).meets_all();
    };
    EXPECT_TRUE(meets(range.greatest));
    EXPECT_TRUE(meets(range.least));
    EXPECT_FALSE(meets(range.greatest + spacing_step));
    EXPECT_FALSE(meets(range.least - spacing_step));
  }
  road.classes = {*find_road_class("M1")};
  road.luminaires.flux_factor *= 0.01;
  EXPECT_TRUE(spacings_that_meet(road).empty());
}

/// A mean luminance of almost nothing is met at any spacing, so the greatest spacing is the last
/// one that is tried: 17 heights of 2 m, and twice that of staggered rows.
TEST(RoadSpacing, OfStaggeredRowsIsTriedToTwiceTheDistance) {
  Road road = road_of_even_lamps();
  road.luminaires.height = 2.0;
  road.luminaires.flux_factor = 1e6;
  road.classes = {{.key = "of luminance", .luminance = 1e-6}};
  const auto greatest = [&](RoadArrangement arrangement) {
    road.luminaires.arrangement = arrangement;
    return spacings_that_meet(road).back().greatest;
  };
  EXPECT_EQ(greatest(RoadArrangement::opposite), 34.0);
  EXPECT_EQ(greatest(RoadArrangement::staggered), 68.0);
}

}  // namespace
}  // namespace lightwell::road_figures_test
