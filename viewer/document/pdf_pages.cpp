#include "viewer/document/pdf_pages.h"

#include <fmt/format.h>

#include <utility>

namespace lightwell {

PdfPages::PdfPages(PdfCanvas& canvas, MarkedText footer, int page_count)
    : canvas_(canvas), footer_(std::move(footer)), page_count_(page_count) {}

void PdfPages::need(double height) {
  if (height > room() && !is_fresh()) begin_page();
}

void PdfPages::begin_page() {
  draw_footer();
  canvas_.end_page();
  ++page_;
  y_ = top;
}

void PdfPages::end() {
  draw_footer();
  canvas_.end_page();
}

void PdfPages::flow(const SetText& text, double x) {
  for (int line = 0; line < text.line_count(); ++line) {
    const double height = text.line_height(line);
    need(height);
    canvas_.draw_line(text, line, x, y_);
    y_ += height;
  }
}

void PdfPages::draw_footer() {
  constexpr double size = 7.5, grey = 0.4, gap = 4.0 * points_per_mm,
                   number_width = 30.0 * points_per_mm;
  constexpr double y = bottom + gap;
  canvas_.draw(canvas_.set(section_.empty() ? footer_ : footer_ + " · " + section_,
                           {.size = size, .grey = grey, .most_lines = 1}, width - number_width),
               left, y);
  canvas_.draw(canvas_.set(fmt::format("{} / {}", page_, page_count_),
                           {.size = size, .is_right = true, .grey = grey}, number_width),
               left + width - number_width, y);
}

}  // namespace lightwell
