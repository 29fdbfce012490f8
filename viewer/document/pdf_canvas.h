#pragma once

#include <memory>
#include <string>

#include "viewer/document/document.h"

namespace lightwell {

/// Points (1/72 inch) in a millimetre.
inline constexpr double points_per_mm = 72.0 / 25.4;

/// How text is set. Lengths in points.
struct TextStyle {
  double size = 9.0;
  bool is_bold = false;
  bool is_right = false;  ///< aligned at the right end of the width
  double grey = 0.1;      ///< of the letters, 0 black, 1 white
  int most_lines = 0;     ///< the rest is an ellipsis; 0: any number
};

/// Text that is set in lines. Lengths in points.
class SetText {
 public:
  double width() const;  ///< of the longest line
  double height() const;
  int line_count() const;
  double line_height(int line) const;  ///< with the gap below it

 private:
  friend class PdfCanvas;
  std::shared_ptr<void> layout_{};
  double spacing_ = 0.0;
  double grey_ = 0.0;
};

/// A PDF file of A4 pages that is drawn in memory: points from the upper left corner, y downwards.
class PdfCanvas {
 public:
  static constexpr double page_width = 210.0 * points_per_mm;
  static constexpr double page_height = 297.0 * points_per_mm;

  PdfCanvas(const std::string& title, const std::string& author, const std::string& language);
  ~PdfCanvas();
  PdfCanvas(const PdfCanvas&) = delete;
  PdfCanvas& operator=(const PdfCanvas&) = delete;

  /// Sets text in lines of at most `width` points; 0 breaks after every word.
  SetText set(const MarkedText& text, const TextStyle& style, double width) const;
  void draw(const SetText& text, double x, double y);
  /// Draws one line of a text, whose upper end is at y.
  void draw_line(const SetText& text, int line, double x, double y);
  /// A level line of `thickness`, below y.
  void draw_rule(double x, double y, double width, double thickness, double grey);
  /// Size of an SVG whose viewBox is in millimetres. Throws std::runtime_error for another.
  struct Size {
    double width = 0.0, height = 0.0;
  };
  static Size size_of_svg(const std::string& svg);
  void draw_svg(const std::string& svg, double x, double y, const Size& size);
  /// Draws the bytes of a PNG file into a rectangle.
  void draw_png(const std::string& png, double x, double y, const Size& size);
  /// An entry in the table of contents that readers of PDF show beside the pages. `page` from 1.
  void add_bookmark(const std::string& title, int page, double y);
  /// Ends the page.
  void end_page();
  /// Ends the file and returns its bytes.
  std::string finish();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace lightwell
