#pragma once

#include <vtkInteractorStyle.h>
#include <vtkSmartPointer.h>

namespace lightwell {

class WalkWindow;

/// Hands what happens in the window on, and keeps VTK's own keys (w, s, e, q, p ...) from acting.
/// Points at the window, which must outlive it.
vtkSmartPointer<vtkInteractorStyle> make_walk_style(WalkWindow* window);

}  // namespace lightwell
