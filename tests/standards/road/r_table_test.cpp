#include "standards/road/r_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <tuple>

#include "scene/errors.h"
#include "tests/temporary_folder.h"

namespace lightwell::r_table_test {
namespace {

/// CIE 144 prints S1 of the tables with two digits: half a unit is 0.005. Q_0 is called with two
/// digits after the point; tables of integers beyond the last printed cells and the finite area of
/// the integral leave up to 3 % (0.1027 for R1).
TEST(RTable, HasThePublishedSpecularFactorAndLightness) {
  struct Published {
    const char* name;
    double s1, q0;
  };
  for (const auto& [name, s1, q0] :
       {Published{"R1", 0.25, 0.10}, Published{"R2", 0.58, 0.07}, Published{"R3", 1.11, 0.07},
        Published{"R4", 1.55, 0.08}, Published{"C1", 0.24, 0.10}, Published{"C2", 0.97, 0.07}}) {
    const RTable table = standard_r_table(name);
    EXPECT_NEAR(specular_factor(table), s1, 0.005) << name;
    EXPECT_NEAR(average_luminance_coefficient(table), q0, 0.03 * q0) << name;
    EXPECT_EQ(table.q0, q0);
    EXPECT_EQ(table.r.rows(), 29);
    EXPECT_EQ(table.r.cols(), 20);
  }
}

/// Entries of R3 as printed, and the mean of the four around a middle. Values are of order 1e-2, so
/// rounding is below 1e-16.
TEST(RTable, IsLinearBetweenItsEntries) {
  const RTable table = standard_r_table("R3");
  EXPECT_NEAR(reduced_luminance_coefficient(table, 2.0, 0.0), 326e-4, 1e-16);
  EXPECT_NEAR(reduced_luminance_coefficient(table, 12.0, 0.0), 53e-4, 1e-16);
  EXPECT_NEAR(reduced_luminance_coefficient(table, 1.0, 180.0), 100e-4, 1e-16);
  EXPECT_NEAR(reduced_luminance_coefficient(table, 1.125, 97.5), (100 + 100 + 70 + 71) / 4.0 * 1e-4,
              1e-16);
  EXPECT_EQ(reduced_luminance_coefficient(table, 12.01, 0.0), 0.0);
}

/// Entries fall with tan(gamma) beyond 2, where light comes flat, but for those that r_table.h
/// lists. All other rises would be slips of the pen.
TEST(RTable, FallsWithTheDistanceOfTheLight) {
  const std::set<std::tuple<std::string, double, double>> printed_so = {
      {"R3", 6.0, 25.0},  {"R3", 9.5, 15.0},  {"R3", 10.0, 20.0}, {"C2", 11.5, 0.0},
      {"C2", 10.0, 10.0}, {"C2", 12.0, 10.0}, {"C2", 8.0, 20.0},  {"C2", 9.5, 20.0}};
  std::set<std::tuple<std::string, double, double>> rises;
  for (const std::string& name : r_table_names()) {
    const RTable table = standard_r_table(name);
    for (Eigen::Index i = 1; i < table.r.rows(); ++i) {
      const double tangent = table.tan_gamma[static_cast<std::size_t>(i)];
      if (tangent <= 2.0) continue;
      for (Eigen::Index k = 0; k < table.r.cols(); ++k) {
        if (table.r(i, k) <= table.r(i - 1, k)) continue;
        rises.insert({name, tangent, table.beta[static_cast<std::size_t>(k)]});
      }
    }
  }
  EXPECT_EQ(rises, printed_so);
}

/// Q_0 of a matt surface is its q: r = q cos^3. Entries are 1/64 apart in t = tan(gamma), between
/// which r is linear and off by at most h^2 / 8 of the second derivative of (1 + t^2)^-1.5, 3 at
/// most in size. Over an area around the point, int |f''| t dt = 1.29 makes h^2 / 8 times 2 pi 1.29
/// q = 2.5e-4 q, against a solid angle of 4.8: 5.2e-5. Sums over the same squares have the same
/// error of the midpoint rule, and six digits after the point of 800 leave 1e-8. A factor of 2 is
/// left for sums in place of integrals.
TEST(RTable, OfAMattSurfaceIsReadFromAFile) {
  constexpr double q = 0.08;
  std::string text = "# a matt surface\ntan_gamma; 0; 90; 180\n";
  for (double t = 0.0; t <= 13.0; t += 0.015625) {
    const double r = 1e4 * q / std::pow(1.0 + t * t, 1.5);
    text += std::to_string(t);
    for (int k = 0; k < 3; ++k) text += "; " + std::to_string(r);
    text += "\n";
  }
  const TemporaryFolder folder;
  folder.write("matt.csv", text);
  const RTable table = read_r_table(folder / "matt.csv");
  EXPECT_NEAR(table.q0, q, 1e-4 * q);
  EXPECT_NEAR(scaled_to(table, 0.1).r(0, 0), 0.1 * q / table.q0, 1e-6);
}

std::string refusal(const std::string& text) {
  const TemporaryFolder folder;
  folder.write("road.csv", text);
  return message_of<InputError>([&] { read_r_table(folder / "road.csv"); });
}

TEST(RTable, RefusesFilesThatAreNone) {
  const auto expect = [](const std::string& text, const std::string& words) {
    EXPECT_TRUE(says(refusal(text), words));
  };
  expect("", "fewer than two lines");
  expect("0 90 170\n0 300 300 300\n", "road.csv:1: must hold the angles beta");
  expect("0 180\n0 300 300 300\n", "road.csv:2: has 4 numbers");
  expect("0 180\n0 300 300\n0 300 300\n", "road.csv:3: must have a tan(gamma) that rises");
  expect("0 180\n0.5 300 300\n", "must have a tan(gamma) that rises");
  expect("0 180\n0 300 -1\n", "negative");
  expect("0 180\n0 300 x\n", "no number");
  expect("0 180\n0 0.03 0.03\n12 0.01 0.01\n", "write r times 10^4");
  expect("0 180\n0 300 300\n11.5 1 1\n", "ends the table at a tan(gamma) of 11.5");
}

}  // namespace
}  // namespace lightwell::r_table_test
