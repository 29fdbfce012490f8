#include "scene/io/weather/clock_time.h"

#include <gtest/gtest.h>

#include <string>

#include "scene/errors.h"

namespace lightwell::clock_time_test {

TEST(ClockTime, IsReadWithABlankOrAT) {
  for (const char* const text : {"2024-11-21 15:30", "2024-11-21T15:30"}) {
    const ClockTime when = read_clock_time(text);
    EXPECT_EQ(when.year, 2024);
    EXPECT_EQ(when.month, 11);
    EXPECT_EQ(when.day, 21);
    EXPECT_EQ(when.hour, 15.5);
  }
  EXPECT_EQ(read_clock_time("2024-02-29 00:00").day, 29);
}

TEST(ClockTime, OtherTextIsRefused) {
  for (const std::string text :
       {"", "2024", "2024-11-21", "2024-11-21 15", "2024-11-21 24:00", "2024-11-21 15:60",
        "2023-02-29 12:00", "2024-13-01 12:00", "1949-12-31 12:00", "2051-01-01 12:00",
        "2024-11-21 15:30 h", "2024-11-21 15:30:00", "2024/11/21 15:30", "99999999999-1-1 1:00",
        "2024-11-21 -1:30", "nan-01-01 12:00"}) {
    EXPECT_THROW(read_clock_time(text), InputError) << text;
  }
}

}  // namespace lightwell::clock_time_test
