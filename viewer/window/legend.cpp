#include "viewer/window/legend.h"

#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

#include "viewer/window/lux_classes.h"

namespace lightwell {
namespace {

/// A word as VTK draws text: coverage of each pixel by white letters, row 0 on top.
struct Word {
  int width = 0, height = 0;
  std::vector<std::uint8_t> cover{};
};

Word draw(const std::string& text, int font_size) {
  vtkNew<vtkTextProperty> property;
  property->SetFontSize(font_size);
  property->SetColor(1.0, 1.0, 1.0);
  vtkNew<vtkImageData> image;
  std::array<int, 2> size{};
  constexpr int dots_per_inch = 72;  // a point is a pixel
  vtkTextRenderer* const renderer = vtkTextRenderer::GetInstance();
  if (!renderer ||
      !renderer->RenderString(property, vtkStdString(text), image, size.data(), dots_per_inch)) {
    throw std::runtime_error(fmt::format("VTK cannot draw the text '{}'", text));
  }
  // The image may be larger than the text, which begins at the image's lower left corner.
  Word word{.width = size[0], .height = size[1]};
  for (int y = word.height - 1; y >= 0; --y) {
    for (int x = 0; x < word.width; ++x) {
      word.cover.push_back(static_cast<const std::uint8_t*>(image->GetScalarPointer(x, y, 0))[3]);
    }
  }
  return word;
}

class Canvas {
 public:
  Canvas(int width, int height)
      : picture_{width, height, std::vector<std::uint8_t>(std::size_t{3} * width * height)} {}

  void fill(std::uint8_t grey) { std::ranges::fill(picture_.rgb, grey); }

  void set(int x, int y, const std::uint8_t* rgb) {
    if (x < 0 || y < 0 || x >= picture_.width || y >= picture_.height) return;
    std::copy(rgb, rgb + 3, &picture_.rgb[3 * (std::size_t(y) * picture_.width + x)]);
  }
  void write(int left, int top, const Word& word) {
    for (int y = 0; y < word.height; ++y) {
      for (int x = 0; x < word.width; ++x) {
        const std::uint8_t grey = word.cover[std::size_t(y) * word.width + x];
        if (grey > 0) set(left + x, top + y, std::array{grey, grey, grey}.data());
      }
    }
  }
  LegendPicture take() { return std::move(picture_); }

 private:
  LegendPicture picture_;
};

/// A scale's bar: its colour at each place from 0, the low end, to 1, and its ticks.
struct Bar {
  struct Tick {
    double place = 0.0;
    std::string text{};
  };
  std::function<Eigen::Array3f(float)> color{};
  std::vector<Tick> ticks{};
  std::string title{};
};

Bar bar_of(const LuxRange& range, const std::string& unit) {
  Bar bar{.color = [](float place) { return false_color(place); }, .ticks = {}, .title = unit};
  for (const double value : scale_steps(range)) {
    bar.ticks.push_back({place_on_scale(value, range), fmt::format("{:.6g}", value)});
  }
  return bar;
}

Bar bar_of_classes() {
  constexpr auto count = static_cast<float>(class_count);
  Bar bar{.color =
              [](float place) {
                const auto at = static_cast<std::size_t>(place * count);
                return class_color(std::min(at, class_count - 1));
              },
          .ticks = {},
          .title = "lx"};
  for (std::size_t i = 0; i < lux_classes.size(); ++i) {
    bar.ticks.push_back(
        {static_cast<double>(i + 1) / class_count, fmt::format("{:g}", lux_classes[i])});
  }
  return bar;
}

/// The words of a bar and its layout, in pixels.
struct Layout {
  Layout(const Bar& bar, int font_size, int wanted_height)
      : font(font_size),
        margin(font),
        bar_width(font + font / 2),
        bar_top(3 * font),
        bar_height(std::max(wanted_height - bar_top - 2 * margin,
                            static_cast<int>(bar.ticks.size()) * (font + font / 2))),
        title(draw(bar.title, font)) {
    int widest = title.width - bar_width - font / 2;
    for (const Bar::Tick& tick : bar.ticks) {
      labels.push_back(draw(tick.text, font));
      widest = std::max(widest, labels.back().width);
    }
    width = 2 * margin + bar_width + font / 2 + widest;
    height = bar_top + bar_height + 2 * margin;
  }

  int font, margin, bar_width, bar_top, bar_height;
  int width = 0, height = 0;
  Word title{};
  std::vector<Word> labels{};
};

/// Draws a bar whose box begins at column `left`.
void draw_bar(const Bar& bar, const Layout& layout, int left, Canvas& canvas) {
  const int bar_left = left + layout.margin;
  for (int y = 0; y < layout.bar_height; ++y) {
    const float place = 1.0f - (static_cast<float>(y) + 0.5f) / layout.bar_height;
    std::array<std::uint8_t, 3> rgb{};
    const Eigen::Array3f c = bar.color(place);
    for (int k = 0; k < 3; ++k) rgb[k] = static_cast<std::uint8_t>(255.0f * c[k] + 0.5f);
    for (int x = 0; x < layout.bar_width; ++x) {
      canvas.set(bar_left + x, layout.bar_top + y, rgb.data());
    }
  }
  canvas.write(bar_left, layout.margin, layout.title);
  for (std::size_t i = 0; i < bar.ticks.size(); ++i) {
    const double middle = layout.bar_top + (1.0 - bar.ticks[i].place) * layout.bar_height;
    const auto row = static_cast<int>(std::lround(middle));
    const std::array<std::uint8_t, 3> white = {255, 255, 255};
    for (int x = 0; x < layout.font / 3; ++x) {
      canvas.set(bar_left + layout.bar_width + x, row, white.data());
    }
    canvas.write(bar_left + layout.bar_width + layout.font / 2, row - layout.labels[i].height / 2,
                 layout.labels[i]);
  }
}

LegendPicture box_of(const Bar& bar, int font, int height) {
  constexpr std::uint8_t background = 13;  // that of the window's other text
  const Layout layout(bar, font, height);
  Canvas canvas(layout.width, layout.height);
  canvas.fill(background);
  draw_bar(bar, layout, 0, canvas);
  return canvas.take();
}

}  // namespace

LegendPicture with_legend(const std::vector<float>& values, int width, int height,
                          const LuxRange& range, const std::string& unit) {
  const Bar bar = bar_of(range, unit);
  const Layout layout(bar, std::clamp(height / 28, 11, 40), height);
  Canvas canvas(width + layout.width, std::max(height, layout.height));
  const std::vector<std::uint8_t> colours = false_colors(values, range);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      canvas.set(x, y, &colours[3 * (std::size_t(y) * width + x)]);
    }
  }
  draw_bar(bar, layout, width, canvas);
  return canvas.take();
}

LegendPicture draw_legend(const LuxRange& range, const std::string& unit, int font, int height) {
  return box_of(bar_of(range, unit), font, height);
}

LegendPicture draw_class_legend(int font, int height) {
  return box_of(bar_of_classes(), font, height);
}

}  // namespace lightwell
