#pragma once

#include <vtkSmartPointer.h>

#include <string>

class vtkRenderer;
class vtkTextActor;

namespace lightwell {

/// Text over the picture: a status line at the bottom, a panel and the list of keys at the top, and
/// a note beside the cursor. An empty text hides its box.
class Overlay {
 public:
  Overlay();
  ~Overlay();

  void add_to(vtkRenderer* renderer) const;
  void set_status(const std::string& text);
  void set_panel(const std::string& text);
  /// Sets the note beside the cursor at (x, y), pixels from the left and from the top of a window
  /// of width x height. The note is on the side of the cursor with more room.
  void set_cursor(const std::string& text, int x, int y, int width, int height);
  /// Sets the list of keys, in letters that fit a window of width x height pixels. A list that is
  /// not empty hides the panel.
  void set_help(const std::string& text, int width, int height);

 private:
  vtkSmartPointer<vtkTextActor> status_, panel_, cursor_, help_;
};

}  // namespace lightwell
