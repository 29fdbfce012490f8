#pragma once

#include <memory>

namespace lightwell {

/// Holds an X display open. VTK's X11 back end ends the whole program when it finds none, and a
/// display server such as Xvfb starts anew, turning clients away, when its last client leaves: so
/// this is opened before VTK draws and closed after. Holds nothing where VTK needs no X display.
class DisplayConnection {
 public:
  /// Throws std::runtime_error, saying what is missing and what to do, unless the display that the
  /// environment's DISPLAY names can be opened and draws OpenGL.
  DisplayConnection();
  ~DisplayConnection();
  DisplayConnection(const DisplayConnection&) = delete;
  DisplayConnection& operator=(const DisplayConnection&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// X reports a key held down as a quick series of releases and presses. Asks it for presses alone,
/// until the one release. `display` is an X Display; where that is impossible, nothing changes.
void report_held_keys_once(void* display);

}  // namespace lightwell
