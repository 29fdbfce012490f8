#include "standards/emergency.h"

#include <gtest/gtest.h>

namespace lightwell::emergency_test {
namespace {

Verdict of_route(double line_low, double line_high, double band_low) {
  const LuxField line = field_of(Eigen::Array2d(line_low, line_high));
  const LuxField band = field_of(Eigen::Array2d(band_low, line_high));
  return verdict_of(emergency_requirements({.name = "route",
                                            .kind = EmergencyArea::escape_route,
                                            .area = {"band", &band},
                                            .centre_line = {"line", &line}}));
}

/// EN 1838: 1 lx along the middle, 0.5 lx beside it, and no more than 40 to 1.
TEST(Emergency, OfARouteHasThreeLimits) {
  EXPECT_EQ(of_route(1.1, 43.0, 0.6), Verdict::met);
  EXPECT_EQ(of_route(0.9, 20.0, 0.6), Verdict::missed);
  EXPECT_EQ(of_route(1.1, 45.0, 0.6), Verdict::missed);
  EXPECT_EQ(of_route(1.1, 20.0, 0.4), Verdict::missed);
}

Verdict of_area(EmergencyArea kind, double low, double high, double usual) {
  const LuxField field = field_of(Eigen::Array2d(low, high));
  return verdict_of(emergency_requirements(
      {.name = "area", .kind = kind, .area = {"floor", &field}, .usual_lux = usual}));
}

TEST(Emergency, OfAnOpenAreaIsHalfALux) {
  EXPECT_EQ(of_area(EmergencyArea::open_area, 0.6, 20.0, 0.0), Verdict::met);
  EXPECT_EQ(of_area(EmergencyArea::open_area, 0.4, 10.0, 0.0), Verdict::missed);
  EXPECT_EQ(of_area(EmergencyArea::open_area, 0.6, 25.0, 0.0), Verdict::missed);  // 42 : 1
}

/// A tenth of 500 lx, and 15 lx where that is more than a tenth.
TEST(Emergency, OfHighRiskFollowsTheTask) {
  const auto risk = EmergencyArea::high_risk_task_area;
  EXPECT_EQ(of_area(risk, 40.0, 64.0, 500.0), Verdict::met);
  EXPECT_EQ(of_area(risk, 40.0, 56.0, 500.0), Verdict::missed);
  EXPECT_EQ(of_area(risk, 10.0, 22.0, 100.0), Verdict::met);
  EXPECT_EQ(of_area(risk, 10.0, 18.0, 100.0), Verdict::missed);
  EXPECT_EQ(of_area(risk, 5.0, 125.0, 500.0), Verdict::missed);  // U_0 = 0.077
}

}  // namespace
}  // namespace lightwell::emergency_test
