#pragma once

namespace lightwell {

/// VTK's X11 back end ends the whole program when it finds no X display. Throws std::runtime_error,
/// saying what is missing and what to do, unless the display that DISPLAY names can be opened and
/// draws OpenGL. Does nothing where VTK needs no X display.
void require_display();

}  // namespace lightwell
