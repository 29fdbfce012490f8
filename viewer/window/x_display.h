#pragma once

#include <memory>
#include <optional>
#include <string_view>

namespace lightwell {

/// Holds an X display open, from before VTK draws until after. There are two reasons:
/// - VTK's X11 back end ends the whole program if no display can be opened;
/// - a display server such as Xvfb restarts, and refuses clients meanwhile, when its last client
///   leaves.
/// The object is empty if VTK needs no X display.
class DisplayConnection {
 public:
  /// Opens the display that the environment's DISPLAY names. Throws std::runtime_error, with the
  /// cause and advice, if the display cannot be opened or cannot draw OpenGL.
  DisplayConnection();
  ~DisplayConnection();
  DisplayConnection(const DisplayConnection&) = delete;
  DisplayConnection& operator=(const DisplayConnection&) = delete;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

/// Makes X report a key held down as presses alone until the key's release, instead of a quick
/// series of releases and presses. `display` is an X Display or null. No effect if X does not offer
/// this mode.
void report_held_keys_once(void* display);

/// Takes a window of X off the screen at once. `display` is an X Display or null.
void hide_window(void* display, void* window);

/// Size of text for the screen that the environment's DISPLAY names, as a multiple of that at 96
/// dots per inch, from 1 to 4: by the resource Xft.dpi, which desktops set, else by the screen's
/// size in millimetres. 1 if neither is known.
double screen_text_scale();

/// The same of a list of X resources, lines such as "Xft.dpi: 192"; empty: the list has no Xft.dpi.
std::optional<double> text_scale_in(std::string_view resources);

}  // namespace lightwell
