#pragma once

#include <vtkSmartPointer.h>

#include <functional>
#include <string>

class vtkRenderer;
class vtkTextActor;

namespace lightwell {

/// Text over the picture: a status line at the bottom, a panel and the list of keys at the top, and
/// a note beside the cursor. An empty text hides its box. Letters are `scale` times as large as at
/// a resolution of 96 dots per inch; those of boxes with lines of their own shrink where the window
/// is narrow.
class Overlay {
 public:
  explicit Overlay(double scale = 1.0);
  ~Overlay();

  void add_to(vtkRenderer* renderer) const;
  /// Sets the status, in as many lines as a window of `width` pixels needs.
  void set_status(const std::string& text, int width);
  void set_panel(const std::string& text, int width, int height);
  /// Sets the note beside the cursor at (x, y), pixels from the left and from the top of a window
  /// of width x height. The note is on the side of the cursor with more room.
  void set_cursor(const std::string& text, int x, int y, int width, int height);
  /// Sets the list of keys, in letters that fit a window of width x height pixels. A list that is
  /// not empty hides the panel.
  void set_help(const std::string& text, int width, int height);

 private:
  double scale_;
  vtkSmartPointer<vtkTextActor> status_, panel_, cursor_, help_;
};

/// `text` in lines of at most `most`, parted at spaces, or within a word that is longer. `width_of`
/// measures a line.
std::string wrapped(const std::string& text, double most,
                    const std::function<double(const std::string&)>& width_of);

}  // namespace lightwell
