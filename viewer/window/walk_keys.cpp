#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>

#include "viewer/window/walk_window.h"

namespace lightwell {
namespace {

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace

std::span<const WalkWindow::Key> WalkWindow::keys() {
  using W = WalkWindow;
  static const std::array table = {
      Key{"W S  Up Down", "walk"},
      Key{"A D  Left Right", "step aside"},
      Key{"Q E", "turn"},
      Key{"Space C", "up, down; Space on foot: jump", {"space"}, &W::jump},
      Key{"Shift", "run"},
      Key{"G", "walk on foot, fly", {"g"}, &W::switch_walking},
      Key{"drag", "look around"},
      Key{"O", "orbit what is in the middle", {"o"}, &W::switch_orbit},
      Key{"wheel", "move along the view"},
      Key{"1 ... 9", "go to a bookmark or camera"},
      Key{"Ctrl+1 ... 9", "keep this view as a bookmark"},
      Key{"J", "record a path, stop", {"j"}, &W::switch_recording},
      Key{"Y", "play it, stop", {"y"}, &W::switch_playing},
      Key{"Home", "back to the start", {"home"}, &W::go_to_start},
      Key{"F", "see the whole scene", {"f"}, &W::show_all},
      Key{"+ -", "exposure, 1/3 stop", {"plus", "equal", "kp_add"}, &W::brighter},
      Key{"", "", {"minus", "kp_subtract"}, &W::darker},
      Key{"0", "expose for this view", {"0"}, &W::expose_for_view},
      Key{"F2", "white by the light, as lit", {"f2"}, &W::switch_white},
      Key{"V", "false colours of illuminance", {"v"}, &W::switch_false_colours},
      Key{"U", "luminance; light to come", {"u"}, &W::switch_measure},
      Key{"F5", "fit their scale to the view", {"f5"}, &W::fit_range},
      Key{"F6", "linear, logarithmic scale", {"f6"}, &W::switch_scaling},
      Key{"F7", "100 ... 750 lx of standards", {"f7"}, &W::switch_classes},
      Key{"I", "isolux lines", {"i"}, &W::switch_isolux},
      Key{"M", "mesh", {"m"}, &W::switch_mesh},
      Key{"X", "look through unlit surfaces", {"x"}, &W::switch_unlit},
      Key{"R", "ray-trace this view, cancel", {"r"}, &W::switch_still},
      Key{"P  F12", "save a picture", {"p", "f12"}, &W::save_screenshot},
      Key{"Esc", "close", {"escape"}, &W::close},
      Key{"click", "read the light at a point"},
      Key{"T", "read under the pointer", {"t"}, &W::switch_probe},
      Key{"L", "measure, click to click", {"l"}, &W::switch_measuring},
      Key{"Backspace", "forget what was clicked", {"backspace"}, &W::forget_clicks},
      Key{"] [", "choose a light channel", {"bracketright"}, &W::next_channel},
      Key{"", "", {"bracketleft"}, &W::previous_channel},
      Key{"+ -", "brighten, dim the chosen"},
      Key{"\\", "switch it on, off", {"backslash"}, &W::switch_channel},
      Key{"K", "its colour", {"k"}, &W::next_colour},
      Key{". ,", "next, previous lighting cue", {"period"}, &W::next_cue},
      Key{"", "", {"comma"}, &W::previous_cue},
      Key{";", "play the cues, stop", {"semicolon"}, &W::switch_cues},
      Key{"Ctrl+S", "save the solution as shown", {"ctrl+s"}, &W::save_solution},
      Key{"Z", "pause solving, go on", {"z"}, &W::switch_pause},
      Key{"N", "one step of solving", {"n"}, &W::shoot_once},
      Key{"B", "guess of the light to come", {"b"}, &W::switch_ambient},
      Key{"Enter", "good enough: finish, save", {"return", "kp_enter"}, &W::stop_shooting},
      Key{"H  ?", "this list", {"h", "question"}, &W::switch_help},
  };
  return table;
}

std::string walk_help() {
  std::vector<std::string> lines;
  for (const WalkWindow::Key& key : WalkWindow::keys()) {
    if (*key.shown) lines.push_back(fmt::format("{:<16} {:<29}", key.shown, key.does));
  }
  const std::size_t rows = (lines.size() + 1) / 2;
  std::string text;
  for (std::size_t i = 0; i < rows; ++i) {
    const std::string& right = rows + i < lines.size() ? lines[rows + i] : "";
    text += fmt::format("{}  {}\n", lines[i], right);
  }
  return text +
         "\n"
         "Light still to come: what lamps and surfaces have not yet sent on while the scene is\n"
         "solved. Key B adds a guess of it, spread evenly over the room.\n"
         "Mirrors are drawn as if matte, glass as a veil: what they show depends on the eye,\n"
         "and is left to the ray-traced picture.";
}

WalkKeys WalkWindow::held_keys() const {
  const auto any = [&](std::initializer_list<const char*> keys) {
    return std::any_of(keys.begin(), keys.end(), [&](const char* key) { return held_.count(key); });
  };
  return {.forward = any({"w", "up", "kp_up"}),
          .back = any({"s", "down", "kp_down"}),
          .left = any({"a", "left", "kp_left"}),
          .right = any({"d", "right", "kp_right"}),
          .up = any({"space", "prior"}),
          .down = any({"c", "next"}),
          .turn_left = any({"q"}),
          .turn_right = any({"e"}),
          .run = any({"shift_l", "shift_r"})};
}

void WalkWindow::press(const std::string& key_symbol) {
  std::string key = lower_case(key_symbol);
  const bool with_control = held_.count("control_l") > 0 || held_.count("control_r") > 0;
  if (with_control && key.rfind("control", 0) != 0) key = "ctrl+" + key;
  // A key held down is reported repeatedly, but acts once.
  if (!held_.insert(key).second) return;
  const char last = key.back();
  if (last >= '1' && last <= '9' && (key.size() == 1 || key == std::string("ctrl+") + last)) {
    return key.size() == 1 ? press_digit(last - '0') : keep_bookmark(last - '0');
  }
  for (const Key& known : keys()) {
    if (std::find(known.symbols.begin(), known.symbols.end(), key) == known.symbols.end()) continue;
    return (this->*known.act)();
  }
}

void WalkWindow::release(const std::string& key_symbol) {
  const std::string key = lower_case(key_symbol);
  held_.erase(key);
  held_.erase("ctrl+" + key);
  // If Shift is released first, the key reports its other symbol.
  if (key == "plus") held_.erase("equal");
  if (key == "equal") held_.erase("plus");
  if (key == "slash") held_.erase("question");
}

void WalkWindow::press_digit(int digit) {
  const auto index = static_cast<std::size_t>(digit - 1);
  if (views_.bookmarks[index]) {
    go_to(*views_.bookmarks[index]);
    say(fmt::format("bookmark {}", digit));
  } else if (index < options_.cameras.size()) {
    go_to(options_.cameras[index]);
    say(options_.cameras[index].name);
  } else {
    say(fmt::format("the scene has {} cameras; Ctrl+{} keeps this view as a bookmark",
                    options_.cameras.size(), digit));
  }
}

}  // namespace lightwell
