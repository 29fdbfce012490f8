#pragma once

#include <vtkSmartPointer.h>

#include <string>

class vtkRenderer;
class vtkTextActor;

namespace lightwell {

/// The text over the picture: a status line below, a panel and the list of keys above, and what
/// goes with the cursor. An empty text shows nothing.
class Overlay {
 public:
  Overlay();
  ~Overlay();

  void add_to(vtkRenderer* renderer) const;
  void set_status(const std::string& text);
  void set_panel(const std::string& text);
  /// At a place of a window of width x height, pixels from the left and from the top: beside it, on
  /// the side that has room.
  void set_cursor(const std::string& text, int x, int y, int width, int height);
  /// In letters that fit a window of width x height; hides the panel meanwhile.
  void set_help(const std::string& text, int width, int height);

 private:
  vtkSmartPointer<vtkTextActor> status_, panel_, cursor_, help_;
};

}  // namespace lightwell
