#pragma once

#include <memory>

namespace lightwell {

/// VTK's X11 back end ends the whole program when it finds no X display. Throws std::runtime_error,
/// saying what is missing and what to do, unless the display that DISPLAY names can be opened and
/// draws OpenGL. Does nothing where VTK needs no X display. The result holds a connection: keep it
/// until VTK has drawn, for a server such as xvfb-run starts resets itself when its last client
/// leaves, and refuses the next one meanwhile.
[[nodiscard]] std::shared_ptr<void> require_display();

/// X reports a key held down as a quick series of releases and presses. Asks it for presses alone,
/// until the one release. `display` is an X Display; where that is impossible, nothing changes.
void report_held_keys_once(void* display);

}  // namespace lightwell
