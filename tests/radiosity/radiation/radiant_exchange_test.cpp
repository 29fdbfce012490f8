#include "radiosity/radiation/radiant_exchange.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "radiosity/form_factors/facet_view_factors.h"
#include "scene/errors.h"
#include "scene/io/default_material.h"

namespace lightwell::radiant_exchange_test {
namespace {

constexpr double sigma = stefan_boltzmann;
// Relative error of sums of some dozens of products in doubles, and of systems of so few equations.
constexpr double rounding = 1e-13;

double power(double kelvin) {
  return sigma * std::pow(kelvin, 4.0);
}

ExchangeAreas closed(const Eigen::ArrayXd& area, const Eigen::MatrixXd& F) {
  return exchange_areas(area, F, Eigen::ArrayXd::Zero(area.size()));
}

ExchangeAreas infinite_plates() {
  return closed(Eigen::ArrayXd::Ones(2), (Eigen::MatrixXd(2, 2) << 0, 1, 1, 0).finished());
}

// Symmetric random exchange, of which each surface sends a share to the surroundings.
ExchangeAreas random_enclosure(int n, unsigned seed, double open_share) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Eigen::MatrixXd S(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) S(i, j) = S(j, i) = uniform(random);
  }
  const Eigen::ArrayXd area = S.rowwise().sum().array() / (1.0 - open_share);
  const Eigen::MatrixXd F = area.inverse().matrix().asDiagonal() * S;
  return exchange_areas(area, F, Eigen::ArrayXd::Constant(n, open_share));
}

// Message of the InputError of a call; "" if none is thrown.
template <class Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ExchangeAreas, AreSymmetricAndClosed) {
  Eigen::MatrixXd F(3, 3);
  F << 0.0, 0.4000003, 0.3, 0.2, 0.1, 0.6999997, 0.15, 0.7, 0.1;
  const Eigen::Array3d area(1.0, 2.0, 2.0);
  const ExchangeAreas areas = exchange_areas(area, F, Eigen::Array3d(0.3, 0.0, 0.05));
  EXPECT_EQ((areas.between - areas.between.transpose()).norm(), 0.0);
  const Eigen::ArrayXd sums = areas.between.rowwise().sum().array() + areas.open;
  EXPECT_LT((sums - area).abs().maxCoeff(), rounding);
  EXPECT_EQ(areas.between(0, 1), 0.5 * (0.4000003 + 2.0 * 0.2));
}

TEST(ExchangeAreas, RefuseWhatCannotBe) {
  const Eigen::Array2d ones(1, 1), none(0, 0);
  const Eigen::Matrix2d F = (Eigen::Matrix2d() << 0, 1, 1, 0).finished();
  const auto refused = [](const Eigen::ArrayXd& area, const Eigen::MatrixXd& factors,
                          const Eigen::ArrayXd& open) {
    return refusal([&] { exchange_areas(area, factors, open); });
  };
  EXPECT_EQ(refused(ones, F, none), "");
  EXPECT_NE(refused(ones, 0.9 * F, none).find("row 0 of the view factors and its open share"),
            std::string::npos);
  EXPECT_NE(refused(Eigen::Array2d(1, 2), F, none).find("not reciprocal"), std::string::npos);
  EXPECT_NE(refused(ones, -F, none).find("row 0"), std::string::npos);
  EXPECT_NE(refused(ones, F * std::nan(""), none).find("row 0"), std::string::npos);
  EXPECT_NE(refused(Eigen::Array2d(1, std::nan("")), F, none).find("row 1"), std::string::npos);
  EXPECT_NE(refused(Eigen::Array3d::Ones(), F, none).find("do not fit"), std::string::npos);
  EXPECT_NE(refused({}, Eigen::MatrixXd(0, 0), {}).find("no surfaces"), std::string::npos);
  const int many = most_radiating_surfaces + 1;
  EXPECT_NE(refusal([&] { exchange_areas(ViewFactors(many)); }).find("too many"),
            std::string::npos);
}

// Pieces of a sphere have F_ij = A_j / sum A. With areas in another order, any two rows differ by
// less than 1 %, since each of 300 factors is small.
TEST(ExchangeAreas, RefuseManyRowsThatAreNotReciprocal) {
  constexpr int n = 300;
  const Eigen::ArrayXd area = Eigen::ArrayXd::LinSpaced(n, 1.0, 2.0);
  const Eigen::MatrixXd F = Eigen::VectorXd::Ones(n) * (area / area.sum()).matrix().transpose();
  EXPECT_EQ(refusal([&] { closed(area, F); }), "");
  // |A_i F_ij - A_j F_ji| is 3 |A_i - A_j| / 450 then, 0.67 % of the smaller area at most. S_00
  // would change by (2 - 1) / 2, 25 % of the area of 2.
  const Eigen::ArrayXd reversed = area.reverse();
  EXPECT_NE(refusal([&] { closed(reversed, F); }).find("row 0 of the view factors is not recipr"),
            std::string::npos);
}

TEST(ExchangeAreas, RefuseFactorsToSurfacesWithoutArea) {
  const Eigen::Matrix3d F =
      (Eigen::Matrix3d() << 0.0, 0.5, 0.5, 0.5, 0.5, 0.0, 0.0, 0.0, 0.0).finished();
  EXPECT_NE(refusal([&] { closed(Eigen::Array3d(1, 1, 0), F); }).find("view factors 2 to 0"),
            std::string::npos);
}

TEST(TransferFactors, OfInfiniteParallelPlates) {
  for (const double e1 : {0.05, 0.5, 1.0}) {
    for (const double e2 : {0.1, 0.8, 1.0}) {
      const Eigen::MatrixXd F = transfer_factors(infinite_plates(), Eigen::Array2d(e1, e2));
      const double expected = 1.0 / (1.0 / e1 + 1.0 / e2 - 1.0);
      EXPECT_NEAR(F(0, 1), expected, rounding);
      EXPECT_NEAR(F(1, 0), expected, rounding);
      EXPECT_NEAR(F(0, 0) + F(0, 1), e1, rounding);  // all that is emitted is absorbed
      EXPECT_EQ(F(0, 2), 0.0);
    }
  }
}

// F_12 of concentric spheres is 1 / (1 / eps_1 + A_1 / A_2 (1 / eps_2 - 1)), from the view factors
// of the exact shapes.
TEST(TransferFactors, OfConcentricSpheres) {
  NumberedScene numbered;
  Scene& scene = numbered.scene;
  scene.materials.push_back(default_material(scene.bands));
  scene.surfaces = {{.name = "inner", .shape = Sphere{.radius = 1.0}},
                    {.name = "outer", .shape = Sphere{.radius = 2.0}}};
  numbered.rows = {{.name = "inner"}, {.name = "outer"}};
  numbered.row_of_facet = {0, 1};
  // The inside of the outer sphere is the back of its facet: rows 0 and 3 of four.
  // The inner sphere sees the outer one alone, and reciprocity and closure give the rest, so few
  // rays do.
  const FacetViewFactors found = facet_view_factors(
      numbered, check_facets(scene),
      {.method = FormFactorMethod::ray_cast, .target_error = 0.05, .two_sided = true});
  const ExchangeAreas areas = exchange_areas(found.factors);
  for (const double e1 : {0.2, 0.9}) {
    for (const double e2 : {0.1, 0.7}) {
      const Eigen::Array4d emittance(e1, 1.0, 1.0, e2);
      const Eigen::MatrixXd F = transfer_factors(areas, emittance);
      const double expected = 1.0 / (1.0 / e1 + 0.25 * (1.0 / e2 - 1.0));
      // Factors are floats: 6e-8 of each of some hundreds of patches, summed.
      EXPECT_NEAR(F(0, 3), expected, 1e-6);
    }
  }
}

TEST(TransferFactors, AreReciprocalAndRowsOfGebhartFactorsAddUpToOne) {
  const int n = 40;
  const ExchangeAreas areas = random_enclosure(n, 1, 0.2);
  Eigen::ArrayXd emittance(n);
  for (int i = 0; i < n; ++i) emittance[i] = (i % 5) / 4.0;  // 0 and 1 are among them
  const Eigen::MatrixXd B = gebhart_factors(areas, emittance);
  EXPECT_LT((B.rowwise().sum().array() - 1.0).abs().maxCoeff(), n * rounding);
  EXPECT_GE(B.minCoeff(), 0.0);
  const Eigen::MatrixXd exchange =
      areas.area.matrix().asDiagonal() * transfer_factors(areas, emittance).leftCols(n);
  EXPECT_LT((exchange - exchange.transpose()).cwiseAbs().maxCoeff(), n * rounding);
}

// Long parallel sides of a triangle: surfaces of 0.7 and 0.4 at 1000 and 500 K, and an adiabatic
// one between. The network of surface and space resistances gives the heat.
TEST(RadiantExchange, OfThreeSurfacesIsThatOfTheNetwork) {
  const Eigen::Array3d area(3.0, 4.0, 5.0);
  // Crossed strings in a triangle (Hottel 1954): A_1 F_12 = (A_1 + A_2 - A_3) / 2.
  Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
  S(0, 1) = S(1, 0) = 1.0, S(0, 2) = S(2, 0) = 2.0, S(1, 2) = S(2, 1) = 3.0;
  const ExchangeAreas areas = closed(area, area.inverse().matrix().asDiagonal() * S);
  const std::vector<RadiatingSurface> surfaces = {{.emittance = 0.7, .kelvin = 1000.0},
                                                  {.emittance = 0.4, .kelvin = 500.0},
                                                  {.emittance = 0.9}};
  const RadiantExchange found = radiant_exchange(areas, surfaces, 0.0);
  const double between =
      1.0 + 1.0 / (1.0 / 2.0 + 1.0 / 3.0);  // by way of the adiabatic surface too
  const double resistance = 0.3 / (3.0 * 0.7) + 1.0 / between + 0.6 / (4.0 * 0.4);
  const double heat = (power(1000.0) - power(500.0)) / resistance;
  EXPECT_NEAR(found.heat[0], heat, rounding * heat);
  EXPECT_NEAR(found.heat[1], -heat, rounding * heat);
  EXPECT_NEAR(found.heat[2], 0.0, rounding * heat);
  // The adiabatic surface is as warm as its irradiation, whatever its emittance.
  EXPECT_NEAR(power(found.kelvin[2]), found.irradiation[2], rounding * power(1000.0));
  EXPECT_GT(found.kelvin[2], 500.0);
  EXPECT_LT(found.kelvin[2], 1000.0);
}

TEST(RadiantExchange, HeatsAddUpToZero) {
  const int n = 60;
  for (const double open_share : {0.0, 0.3}) {
    const ExchangeAreas areas = random_enclosure(n, 2, open_share);
    std::vector<RadiatingSurface> surfaces;
    for (int i = 0; i < n; ++i) {
      surfaces.push_back({.emittance = 0.05 + 0.9 * (i % 7) / 6.0});
      if (i % 3 == 0) {
        surfaces.back().heat = 500.0 * (i % 5);
      } else {
        surfaces.back().kelvin = 280.0 + 10.0 * (i % 4);
      }
    }
    const RadiantExchange found = radiant_exchange(areas, surfaces, 250.0);
    const double scale = found.heat.abs().sum();
    EXPECT_NEAR(found.heat.sum(), found.to_surroundings, 1e-12 * scale);
    // The same heats by the transfer factors and the temperatures found.
    Eigen::ArrayXd emittance(n);
    for (int i = 0; i < n; ++i) emittance[i] = surfaces[static_cast<std::size_t>(i)].emittance;
    const Eigen::MatrixXd F = transfer_factors(areas, emittance);
    for (int i = 0; i < n; ++i) {
      double heat = areas.area[i] * F(i, n) * (power(found.kelvin[i]) - power(250.0));
      for (int j = 0; j < n; ++j) {
        heat += areas.area[i] * F(i, j) * (power(found.kelvin[i]) - power(found.kelvin[j]));
      }
      EXPECT_NEAR(heat, found.heat[i], 1e-11 * scale);
      if (i % 3 == 0) {
        EXPECT_NEAR(found.heat[i], 500.0 * (i % 5), 1e-11 * scale);
      }
    }
  }
}

TEST(RadiantExchange, OfAnIsothermalEnclosureIsNone) {
  const ExchangeAreas areas = random_enclosure(20, 3, 0.1);
  const std::vector<RadiatingSurface> surfaces(20, {.emittance = 0.3, .kelvin = 300.0});
  const RadiantExchange found = radiant_exchange(areas, surfaces, 300.0);
  EXPECT_LT(found.heat.abs().maxCoeff(), 20 * rounding * power(300.0) * areas.area.maxCoeff());
  EXPECT_NEAR(found.radiosity.mean(), power(300.0), rounding * power(300.0));
}

TEST(RadiantExchange, RefusesWhatNothingDecides) {
  const auto refused = [](const ExchangeAreas& areas, std::vector<RadiatingSurface> surfaces) {
    return refusal([&] { radiant_exchange(areas, surfaces, 300.0); });
  };
  const ExchangeAreas plates = infinite_plates();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refused(plates, {{.heat = 1.0}, {.heat = -1.0}}).find("nothing decides"),
            std::string::npos);
  EXPECT_NE(refused(plates, {{.heat = 1.0}, {.emittance = 0.0, .kelvin = 300.0}}).find("nothing"),
            std::string::npos);
  EXPECT_NE(refused(plates, {{.heat = -1000.0}, {.kelvin = 300.0}}).find("colder than 0 K"),
            std::string::npos);
  EXPECT_NE(refused(plates, {{.emittance = 1.1}, {.kelvin = 300.0}}).find("emittance is 1.1"),
            std::string::npos);
  EXPECT_NE(refused(plates, {{.kelvin = -1.0}, {.kelvin = 300.0}}).find("-1 K"), std::string::npos);
  EXPECT_NE(refused(plates, {{.kelvin = nan}, {.kelvin = 300.0}}).find("nan K"), std::string::npos);
  EXPECT_NE(refused(plates, {{.heat = nan}, {.kelvin = 300.0}}).find("heat"), std::string::npos);
  EXPECT_NE(refused(plates, {{.emittance = 0.0, .heat = 1.0}, {.kelvin = 300.0}}).find("emittance"),
            std::string::npos);
  EXPECT_NE(refused(plates, {{.kelvin = 300.0}}).find("1 surfaces"), std::string::npos);
  EXPECT_NE(refusal([&] { gebhart_factors(plates, Eigen::Array2d(0, 0)); }).find("absorbs"),
            std::string::npos);
}

TEST(RadiantExchange, LeavesSurfacesWithoutAreaAlone) {
  Eigen::Matrix3d F = Eigen::Matrix3d::Zero();
  F(0, 1) = F(1, 0) = 1.0;
  const ExchangeAreas areas = closed(Eigen::Array3d(1, 1, 0), F);
  const RadiantExchange found = radiant_exchange(
      areas, std::vector<RadiatingSurface>{{.kelvin = 400.0}, {.kelvin = 300.0}, {}}, 0.0);
  EXPECT_NEAR(found.heat[0], power(400.0) - power(300.0), rounding * power(400.0));
  EXPECT_EQ(found.heat[2], 0.0);
  EXPECT_TRUE(std::isnan(found.kelvin[2]));
  EXPECT_EQ(gebhart_factors(areas, Eigen::Array3d(1, 1, 1)).row(2).norm(), 0.0);
}

}  // namespace
}  // namespace lightwell::radiant_exchange_test
