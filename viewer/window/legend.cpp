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
#include <stdexcept>
#include <utility>

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

  void set(int x, int y, const std::uint8_t* rgb) {
    if (x < 0 || y < 0 || x >= picture_.width || y >= picture_.height) return;
    std::copy(rgb, rgb + 3, &picture_.rgb[3 * (std::size_t(y) * picture_.width + x)]);
  }
  void write(int left, int top, const Word& word) {
    for (int y = 0; y < word.height; ++y) {
      for (int x = 0; x < word.width; ++x) {
        const std::uint8_t grey = word.cover[std::size_t(y) * word.width + x];
        set(left + x, top + y, std::array{grey, grey, grey}.data());
      }
    }
  }
  LegendPicture take() { return std::move(picture_); }

 private:
  LegendPicture picture_;
};

/// The scale's layout, in pixels.
struct Layout {
  explicit Layout(int picture_height, std::size_t steps)
      : font(std::clamp(picture_height / 28, 11, 40)),
        margin(font),
        bar_width(font + font / 2),
        bar_top(3 * font),
        bar_height(std::max(picture_height - bar_top - 2 * margin,
                            static_cast<int>(steps) * (font + font / 2))) {}
  int height() const { return bar_top + bar_height + 2 * margin; }

  int font, margin, bar_width, bar_top, bar_height;
};

/// Position of a value on the bar: 0 at the low end, 1 at the high end.
double place_of(double value, const LuxRange& range) {
  return range.is_even() ? value / range.high
                         : std::log(value / range.low) / std::log(range.high / range.low);
}

}  // namespace

LegendPicture with_legend(const std::vector<float>& values, int width, int height,
                          const LuxRange& range, const std::string& unit) {
  const std::vector<double> steps = scale_steps(range);
  const Layout layout(height, steps.size());
  const Word title = draw(unit, layout.font);
  std::vector<Word> labels;
  int widest = title.width - layout.bar_width - layout.font / 2;
  for (const double step : steps) {
    labels.push_back(draw(fmt::format("{:.6g}", step), layout.font));
    widest = std::max(widest, labels.back().width);
  }
  const int bar_left = width + layout.margin;
  const int label_left = bar_left + layout.bar_width + layout.font / 2;
  Canvas canvas(label_left + widest + layout.margin, std::max(height, layout.height()));

  const std::vector<std::uint8_t> colours = false_colors(values, range);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      canvas.set(x, y, &colours[3 * (std::size_t(y) * width + x)]);
    }
  }
  for (int y = 0; y < layout.bar_height; ++y) {
    const float place = 1.0f - (static_cast<float>(y) + 0.5f) / layout.bar_height;
    std::array<std::uint8_t, 3> rgb{};
    const Eigen::Array3f c = false_color(place);
    for (int k = 0; k < 3; ++k) rgb[k] = static_cast<std::uint8_t>(255.0f * c[k] + 0.5f);
    for (int x = 0; x < layout.bar_width; ++x) {
      canvas.set(bar_left + x, layout.bar_top + y, rgb.data());
    }
  }
  canvas.write(bar_left, layout.margin, title);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double middle = layout.bar_top + (1.0 - place_of(steps[i], range)) * layout.bar_height;
    const std::array<std::uint8_t, 3> white = {255, 255, 255};
    for (int x = 0; x < layout.font / 3; ++x) {
      canvas.set(bar_left + layout.bar_width + x, static_cast<int>(std::lround(middle)),
                 white.data());
    }
    canvas.write(label_left, static_cast<int>(std::lround(middle)) - labels[i].height / 2,
                 labels[i]);
  }
  return canvas.take();
}

}  // namespace lightwell
