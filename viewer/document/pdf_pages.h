#pragma once

#include <string>

#include "viewer/document/document.h"
#include "viewer/document/pdf_canvas.h"

namespace lightwell {

/// Pages of a document that are filled from above, with a footer: text at the left, "3 / 7" at the
/// right. Lengths in points.
class PdfPages {
 public:
  static constexpr double left = 13.0 * points_per_mm;
  static constexpr double top = 16.0 * points_per_mm;
  static constexpr double bottom = PdfCanvas::page_height - 18.0 * points_per_mm;
  static constexpr double width = PdfCanvas::page_width - 2.0 * left;

  /// `page_count` is the number of all pages, for the footer.
  PdfPages(PdfCanvas& canvas, MarkedText footer, int page_count);

  PdfCanvas& canvas() { return canvas_; }
  /// The upper end of what is still free of the page.
  double y() const { return y_; }
  int page() const { return page_; }
  double room() const { return bottom - y_; }
  /// True if nothing stands on the page.
  bool is_fresh() const { return y_ <= top; }
  void skip(double height) { y_ += height; }
  /// Begins another page unless `height` fits on this one, or nothing stands on it.
  void need(double height);
  void begin_page();
  /// The section in the footers of this page and of those that follow, after the text.
  void name_section(const MarkedText& title) { section_ = title; }
  /// Draws the lines of a text, over pages where they do not fit.
  void flow(const SetText& text, double x);
  void end();

 private:
  void draw_footer();

  PdfCanvas& canvas_;
  MarkedText footer_, section_{};
  int page_count_, page_ = 1;
  double y_ = top;
};

/// Draws a table, over pages where it does not fit, with its head on each page.
void draw_table(const DocumentTable& table, char decimal_sign, PdfPages& pages);

}  // namespace lightwell
