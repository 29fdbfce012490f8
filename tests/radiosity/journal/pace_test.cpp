#include "radiosity/journal/pace.h"

#include <gtest/gtest.h>

#include <limits>

namespace lightwell::pace_test {
namespace {

TEST(Pace, IsNeverTooSlowWithoutALimit) {
  Pace pace(std::numeric_limits<double>::infinity());
  EXPECT_FALSE(pace.is_too_slow(0.0));
  EXPECT_FALSE(pace.is_too_slow(0.0));
}

TEST(Pace, IsNotJudgedBeforeATenthOfTheTime) {
  constexpr double years = 1e9;
  Pace pace(years);
  EXPECT_FALSE(pace.is_too_slow(0.0));
  EXPECT_FALSE(pace.is_too_slow(0.0));
}

// Half of the work is done when 0.6 of the allowed time has passed, and more passes before the
// clock's next tick.
TEST(Pace, IsTooSlowOnceMuchMoreTimePassesThanIsAllowed) {
  Pace pace(1e-12);
  while (!pace.is_too_slow(0.5)) {
  }
  EXPECT_TRUE(pace.is_too_slow(1.0)) << "which took more than 1.2 of the time";
}

}  // namespace
}  // namespace lightwell::pace_test
