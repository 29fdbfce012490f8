#include "viewer/window/overlay.h"

#include <vtkRenderer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <sstream>

namespace lightwell {
namespace {

constexpr int status_size = 13, panel_size = 13, help_size = 14, least_size = 7;
/// Width of a letter and height of a line in VTK's built-in Courier, as shares of the font size.
constexpr double letter_width = 0.62, line_height = 1.25;

vtkSmartPointer<vtkTextActor> make_overlay_text(int size, bool framed) {
  auto text = vtkSmartPointer<vtkTextActor>::New();
  vtkTextProperty* property = text->GetTextProperty();
  property->SetFontSize(size);
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

}  // namespace

Overlay::Overlay()
    : status_(make_overlay_text(status_size, false)),
      panel_(make_overlay_text(panel_size, true)),
      cursor_(make_overlay_text(panel_size, true)),
      help_(make_overlay_text(help_size, true)) {
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

void Overlay::set_status(const std::string& text) {
  show(status_, text);
}

void Overlay::set_panel(const std::string& text) {
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
  std::size_t columns = 1, rows = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line); ++rows)
    columns = std::max(columns, line.size());
  const double by_width = 0.96 * width / (letter_width * static_cast<double>(columns + 2));
  const double by_height = 0.96 * height / (line_height * static_cast<double>(rows + 1));
  help_->GetTextProperty()->SetFontSize(
      std::clamp(static_cast<int>(std::min(by_width, by_height)), least_size, help_size));
  show(help_, text);
  if (!text.empty()) panel_->VisibilityOff();
}

}  // namespace lightwell
