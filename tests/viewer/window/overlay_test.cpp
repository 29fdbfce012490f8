#include "viewer/window/overlay.h"

#include <gtest/gtest.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <sstream>

#include "viewer/window/vtk_messages.h"
#include "viewer/window/walk_window.h"
#include "viewer/window/x_display.h"

namespace lightwell::overlay_test {
namespace {

double letters(const std::string& line) {
  return static_cast<double>(line.size());
}

TEST(Wrapped, LinesEndAtSpacesAndLongWordsWithin) {
  EXPECT_EQ(wrapped("", 10.0, letters), "");
  EXPECT_EQ(wrapped("one line", 10.0, letters), "one line");
  EXPECT_EQ(wrapped("light spreading: 7 % still to come", 17.0, letters),
            "light spreading:\n7 % still to come");
  EXPECT_EQ(wrapped("saved /a/very/long/path.png", 10.0, letters),
            "saved\n/a/very/lo\nng/path.pn\ng");
  EXPECT_EQ(wrapped("ab", 0.5, letters), "a\nb") << "narrower than a letter";
}

TEST(TextScale, FollowsTheResolutionThatDesktopsSet) {
  EXPECT_EQ(text_scale_in("Xft.antialias:\t1\nXft.dpi:\t192\n"), 2.0);
  EXPECT_EQ(text_scale_in("Xft.dpi: 72"), 1.0) << "never below the plain size";
  EXPECT_EQ(text_scale_in("Xcursor.size:\t24\n"), std::nullopt);
  EXPECT_EQ(text_scale_in("Xft.dpi: none"), std::nullopt);
}

/// Columns and rows of a picture, 240 pixels high, that text has changed.
struct Drawn {
  int first_column = -1, last_column = -1, rows = 0;
};

Drawn draw(const std::string& status, const std::string& help, int width, double scale) {
  const DisplayConnection display;
  const VtkMessages messages;
  constexpr int height = 240;
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(0.0, 0.5, 0.0);
  Overlay overlay(scale);
  overlay.add_to(renderer);
  overlay.set_status(status, width);
  overlay.set_help(help, width, height);
  vtkNew<vtkRenderWindow> window;
  window->OffScreenRenderingOn();
  window->SetMultiSamples(0);
  window->SetSize(width, height);
  window->AddRenderer(renderer);
  window->Render();
  vtkNew<vtkUnsignedCharArray> pixels;
  window->GetPixelData(0, 0, width - 1, height - 1, 0, pixels);
  const unsigned char* const bytes = pixels->GetPointer(0);
  Drawn drawn;
  for (int y = 0; y < height; ++y) {
    bool has_text = false;
    for (int x = 0; x < width; ++x) {
      const unsigned char* const rgb = bytes + 3 * (std::size_t(y) * width + x);
      if (rgb[0] < 128) continue;  // letters are nearly white
      has_text = true;
      drawn.first_column = drawn.first_column < 0 ? x : std::min(drawn.first_column, x);
      drawn.last_column = std::max(drawn.last_column, x);
    }
    drawn.rows += has_text;
  }
  return drawn;
}

/// At each width all letters end before the edge, and what does not fit takes more lines.
TEST(OverlayText, StaysWithinTheWindow) {
  const std::string status =
      "illuminance   light spreading: 7.15 % still to come, step 596, 4.9 s, about 17 s left   "
      "panel 100 %   saved /home/somebody/pictures/of/a/room/with/windows/lightwell-1.png";
  const int lines = draw(status, "", 1600, 1.0).rows;
  EXPECT_GT(lines, 0);
  for (const double scale : {1.0, 2.0}) {
    for (const int width : {160, 320, 640}) {
      const Drawn drawn = draw(status, "", width, scale);
      EXPECT_GT(drawn.first_column, 0);
      EXPECT_LT(drawn.last_column, width - 1) << width << ' ' << scale;
      EXPECT_GT(drawn.rows, lines) << width;
    }
  }
  const Drawn help = draw("", walk_help(), 640, 2.0);
  EXPECT_LT(help.last_column, 639);
}

TEST(OverlayText, IsTwiceAsHighAtTwiceTheScale) {
  const int plain = draw("H", "", 320, 1.0).rows, twice = draw("H", "", 320, 2.0).rows;
  // Letters are whole pixels high: 9 and 18, each to 1.
  EXPECT_NEAR(twice, 2.0 * plain, 3.0);
  EXPECT_GT(plain, 5);
}

}  // namespace
}  // namespace lightwell::overlay_test
