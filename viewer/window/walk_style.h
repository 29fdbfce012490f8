#pragma once

#include <vtkInteractorStyle.h>
#include <vtkSmartPointer.h>

namespace lightwell {

class WalkWindow;

/// Returns the interactor style that passes events of keys, mouse and timer to a window, without
/// VTK's own keys (w, s, e, q, p ...). Keeps a pointer to the window, which must outlive the style.
vtkSmartPointer<vtkInteractorStyle> make_walk_style(WalkWindow* window);

}  // namespace lightwell
