#include "viewer/window/legend.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace lightwell::legend_test {
namespace {

const std::uint8_t* pixel(const LegendPicture& picture, int x, int y) {
  return &picture.rgb[3 * (static_cast<std::size_t>(y) * picture.width + x)];
}

std::vector<float> rising(int width, int height) {
  std::vector<float> values;
  for (int i = 0; i < width * height; ++i) values.push_back(static_cast<float>(i % width));
  return values;
}

class Legend : public testing::Test {
 protected:
  // Text is drawn without a display; the variable is restored for other tests.
  Legend() {
    if (const char* display = std::getenv("DISPLAY")) display_ = display;
    ::unsetenv("DISPLAY");
  }
  ~Legend() override {
    if (!display_.empty()) ::setenv("DISPLAY", display_.c_str(), 1);
  }

 private:
  std::string display_{};
};

TEST_F(Legend, LeavesThePictureInTheWindowsColoursOnTheLeft) {
  const LuxRange range{.low = 0, .high = 100};
  const LegendPicture shown = with_legend(rising(120, 300), 120, 300, range, "lx");
  EXPECT_GT(shown.width, 120);
  EXPECT_EQ(shown.height, 300);
  ASSERT_EQ(shown.rgb.size(), std::size_t{3} * shown.width * shown.height);
  const std::vector<std::uint8_t> colours = false_colors(rising(120, 300), range);
  for (int y = 0; y < 300; ++y) {
    EXPECT_EQ(std::memcmp(pixel(shown, 0, y), &colours[std::size_t{3} * 120 * y], 3 * 120), 0);
  }
}

TEST_F(Legend, BarRisesFromTheLowEndToTheHighEndAsTheColoursDo) {
  const LegendPicture shown =
      with_legend(rising(50, 400), 50, 400, {.low = 1, .high = 1000}, "cd/m\u00b2");
  // The bar is located by the colours of its two ends, one above the other.
  const auto shows = [&](int x, int y, float place) {
    const Eigen::Array3f c = false_color(place);
    for (int k = 0; k < 3; ++k) {
      // Half a row of a bar of more than 100 moves a colour by less than 2 bytes.
      if (std::abs(pixel(shown, x, y)[k] - 255.0f * c[k]) > 2.5f) return false;
    }
    return true;
  };
  bool found = false;
  for (int x = 50; x < shown.width && !found; ++x) {
    int top = -1, bottom = -1;
    for (int y = 0; y < shown.height; ++y) {
      if (shows(x, y, 1.0f) && top < 0) top = y;
      if (shows(x, y, 0.0f)) bottom = y;
    }
    if (top < 0 || bottom < top + 100) continue;
    found = true;
    for (const float place : {0.25f, 0.5f, 0.75f}) {
      const double y = top + (1.0 - place) * (bottom - top);
      EXPECT_TRUE(shows(x, static_cast<int>(y), place)) << place;
    }
  }
  EXPECT_TRUE(found);
}

TEST_F(Legend, SmallPictureIsPutBesideAScaleThatIsWhole) {
  const LegendPicture shown = with_legend(rising(4, 3), 4, 3, {.low = 0, .high = 500}, "lx");
  EXPECT_GT(shown.height, 60);
  EXPECT_EQ(*std::max_element(pixel(shown, 0, 50), pixel(shown, 0, 50) + 3), 0);
  // Beside the rows of the ticks, pixels of digits are lit.
  int lit = 0;
  for (int y = 0; y < shown.height; ++y) {
    for (int x = 4; x < shown.width; ++x) {
      const std::uint8_t* rgb = pixel(shown, x, y);
      if (std::min({rgb[0], rgb[1], rgb[2]}) >= 128) ++lit;
    }
  }
  const int ticks = 4 * static_cast<int>(scale_steps({.low = 0, .high = 500}).size());
  EXPECT_GT(lit, ticks + 20);
}

/// Ticks and numbers, the brightest pixels, end a pixel or more before each edge of the box.
TEST_F(Legend, TicksAndNumbersAreInsideTheBox) {
  for (const int font : {6, 14, 28}) {
    for (const LegendPicture& box : {draw_legend({.low = 1, .high = 100000}, "lx", font, 300),
                                     draw_legend({.low = 0, .high = 20}, "cd/m\u00b2", font, 100),
                                     draw_class_legend(font, 200)}) {
      int lit = 0;
      for (int y = 0; y < box.height; ++y) {
        for (int x = 0; x < box.width; ++x) {
          const std::uint8_t* rgb = pixel(box, x, y);
          if (std::min({rgb[0], rgb[1], rgb[2]}) < 128) continue;
          ++lit;
          EXPECT_TRUE(x > 0 && y > 0 && x < box.width - 1 && y < box.height - 1) << x << ' ' << y;
        }
      }
      EXPECT_GT(lit, 20);
    }
  }
}

}  // namespace
}  // namespace lightwell::legend_test
