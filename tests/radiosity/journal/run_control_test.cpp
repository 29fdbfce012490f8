#include "radiosity/journal/run_control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lightwell::run_control_test {
namespace {

RunControl with_seconds(double seconds) {
  return {.seconds_left = [seconds] { return seconds; }};
}

TEST(RunControl, TimeIsUpWhenNoneIsLeft) {
  const RunControl without;
  EXPECT_TRUE(std::isinf(without.time_left()));
  EXPECT_FALSE(without.has_limit());
  EXPECT_FALSE(without.is_time_up());
  EXPECT_TRUE(with_seconds(3.0).has_limit());
  EXPECT_FALSE(with_seconds(3.0).is_time_up());
  EXPECT_TRUE(with_seconds(0.0).is_time_up());
  EXPECT_TRUE(with_seconds(-1.0).is_time_up());
  EXPECT_FALSE(with_seconds(std::numeric_limits<double>::infinity()).has_limit());
}

TEST(RunControl, AShareEndsBeforeTheWhole) {
  const RunControl half = with_seconds(1000.0).with_share(0.5);
  EXPECT_LE(half.time_left(), 500.0);
  EXPECT_GT(half.time_left(), 400.0);
  // The end of the whole is the end of each share.
  double left = 1000.0;
  const RunControl whole{.seconds_left = [&left] { return left; }};
  const RunControl share = whole.with_share(0.5);
  left = 0.0;
  EXPECT_TRUE(share.is_time_up());
  EXPECT_TRUE(std::isinf(RunControl{}.with_share(0.5).time_left()));
}

TEST(RunControl, WorkIsStoppedWhenTheTimeIsUp) {
  double left = 2.0;
  int steps = 0;
  const RunControl run{.seconds_left = [&left] { return left; }};
  const auto work = [&](const RunControl& in_time) {
    for (int i = 0; i < 10; ++i) {
      report(in_time.progress, "work", 0.1 * i);
      ++steps;
      left -= 1.0;
    }
  };
  EXPECT_FALSE(finishes_in_time(run, work));
  EXPECT_EQ(steps, 2);
  left = 100.0;
  EXPECT_TRUE(finishes_in_time(run, work));
  EXPECT_EQ(steps, 12);
}

TEST(RunControl, AStopIsNoEndOfTime) {
  const RunControl run{.progress = [](std::string_view, double) { return false; },
                       .seconds_left = [] { return 1.0; }};
  const auto work = [](const RunControl& in_time) { report(in_time.progress, "work", 0.0); };
  EXPECT_THROW(finishes_in_time(run, work), Interrupted);
  EXPECT_THROW(finishes_in_time({.progress = run.progress}, work), Interrupted);
}

}  // namespace
}  // namespace lightwell::run_control_test
