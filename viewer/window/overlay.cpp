#include "viewer/window/overlay.h"

#include <vtkRenderer.h>
#include <vtkStdString.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace lightwell {
namespace {

constexpr double status_size = 13.0, panel_size = 13.0, help_size = 14.0;  // at a scale of 1
constexpr int least_size = 7;
/// Width of a letter and height of a line in VTK's built-in Courier, as shares of the font size.
constexpr double letter_width = 0.62, line_height = 1.25;

vtkSmartPointer<vtkTextActor> make_overlay_text(double size, bool framed) {
  auto text = vtkSmartPointer<vtkTextActor>::New();
  vtkTextProperty* property = text->GetTextProperty();
  property->SetFontSize(std::max(least_size, static_cast<int>(std::lround(size))));
  property->SetColor(0.95, 0.95, 0.95);
  property->SetBackgroundColor(0.05, 0.05, 0.05);
  property->SetBackgroundOpacity(framed ? 0.8 : 0.55);
  text->VisibilityOff();
  return text;
}

void place(vtkTextActor* text, double x, double y, bool from_top) {
  text->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  text->GetPositionCoordinate()->SetValue(x, y);
  if (from_top) text->GetTextProperty()->SetVerticalJustificationToTop();
}

// A space before and after each line keeps letters off the edge of the background.
void show(vtkTextActor* actor, const std::string& text) {
  actor->SetVisibility(!text.empty());
  std::istringstream lines(text);
  std::string padded;
  for (std::string line; std::getline(lines, line);) {
    padded += (padded.empty() ? " " : "\n ") + line + " ";
  }
  actor->SetInput(padded.c_str());
}

/// Width of a line as VTK draws it, pixels.
double drawn_width(vtkTextProperty* property, const std::string& line) {
  constexpr int dots_per_inch = 72;  // a point is a pixel
  std::array<int, 4> box{};
  vtkTextRenderer* const renderer = vtkTextRenderer::GetInstance();
  const bool is_measured =
      renderer && renderer->GetBoundingBox(property, vtkStdString(line), box.data(), dots_per_inch);
  if (is_measured) return box[1] - box[0] + 1;
  return letter_width * property->GetFontSize() * static_cast<double>(line.size());
}

/// Letters of Courier, of at most `wanted` pixels, in which a text fits a window.
int fitting_size(const std::string& text, double wanted, int width, int height) {
  std::size_t columns = 1, rows = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line); ++rows) {
    columns = std::max(columns, line.size());
  }
  const double by_width = 0.96 * width / (letter_width * static_cast<double>(columns + 2));
  const double by_height = 0.96 * height / (line_height * static_cast<double>(rows + 1));
  const int largest = std::max(least_size, static_cast<int>(std::lround(wanted)));
  return std::clamp(static_cast<int>(std::min(by_width, by_height)), least_size, largest);
}

}  // namespace

std::string wrapped(const std::string& text, double most,
                    const std::function<double(const std::string&)>& width_of) {
  std::string result, line;
  const auto end_line = [&] {
    while (!line.empty() && line.back() == ' ') line.pop_back();
    if (!line.empty()) result += (result.empty() ? "" : "\n") + line;
    line.clear();
  };
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = text.find(' ', begin);
    end = end == std::string::npos ? text.size() : text.find_first_not_of(' ', end);
    end = std::min(end, text.size());
    std::string word = text.substr(begin, end - begin);
    begin = end;
    if (width_of(line + word) > most) end_line();
    while (word.size() > 1 && width_of(word) > most) {
      std::size_t fits = 1;
      while (fits < word.size() && width_of(word.substr(0, fits + 1)) <= most) ++fits;
      line = word.substr(0, fits);
      end_line();
      word.erase(0, fits);
    }
    line += word;
  }
  end_line();
  return result;
}

Overlay::Overlay(double scale)
    : scale_(scale),
      status_(make_overlay_text(scale * status_size, false)),
      panel_(make_overlay_text(scale * panel_size, true)),
      cursor_(make_overlay_text(scale * panel_size, true)),
      help_(make_overlay_text(scale * help_size, true)) {
  place(status_, 0.01, 0.015, false);
  place(panel_, 0.01, 0.985, true);
  place(help_, 0.02, 0.98, true);
  panel_->GetTextProperty()->SetFontFamilyToCourier();
  help_->GetTextProperty()->SetFontFamilyToCourier();
  cursor_->GetPositionCoordinate()->SetCoordinateSystemToDisplay();
}

Overlay::~Overlay() = default;

void Overlay::add_to(vtkRenderer* renderer) const {
  for (vtkTextActor* text : {status_.Get(), panel_.Get(), cursor_.Get(), help_.Get()}) {
    renderer->AddViewProp(text);
  }
}

void Overlay::set_status(const std::string& text, int width) {
  constexpr double share = 0.96;  // of the width; margins are 1 % each, and a space each
  vtkTextProperty* const property = status_->GetTextProperty();
  const double space = 2.0 * drawn_width(property, "n");
  show(status_, wrapped(text, share * width - space, [property](const std::string& line) {
         return drawn_width(property, line);
       }));
}

void Overlay::set_panel(const std::string& text, int width, int height) {
  panel_->GetTextProperty()->SetFontSize(fitting_size(text, scale_ * panel_size, width, height));
  show(panel_, text);
}

void Overlay::set_cursor(const std::string& text, int x, int y, int width, int height) {
  constexpr int gap = 16;  // pixels; the pointer hides no letter
  show(cursor_, text);
  vtkTextProperty* property = cursor_->GetTextProperty();
  const bool on_left = x > width / 2, above = y > height / 2;
  on_left ? property->SetJustificationToRight() : property->SetJustificationToLeft();
  above ? property->SetVerticalJustificationToBottom() : property->SetVerticalJustificationToTop();
  cursor_->GetPositionCoordinate()->SetValue(x + (on_left ? -gap : gap),
                                             height - y + (above ? gap : -gap));
}

void Overlay::set_help(const std::string& text, int width, int height) {
  help_->GetTextProperty()->SetFontSize(fitting_size(text, scale_ * help_size, width, height));
  show(help_, text);
  if (!text.empty()) panel_->VisibilityOff();
}

}  // namespace lightwell
