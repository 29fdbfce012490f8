#pragma once

namespace lightwell {

/// VTK's X11 back end ends the whole program when it finds no X display. Throws std::runtime_error,
/// saying what is missing and what to do, unless the display that DISPLAY names can be opened and
/// draws OpenGL. Does nothing where VTK needs no X display.
void require_display();

/// X reports a key held down as a quick series of releases and presses. Asks it for presses alone,
/// until the one release. `display` is an X Display; where that is impossible, nothing changes.
void report_held_keys_once(void* display);

}  // namespace lightwell
