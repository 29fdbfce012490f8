#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// A state of a group of windows, such as open, or with a blind down.
struct WindowState {
  std::string name{};
  /// Index into OperatedWindows::materials: what the group's surfaces are made of in this state.
  /// Empty: each surface keeps the material that the scene gives it.
  std::optional<int> material{};
};

/// The rule by which a group changes its state.
enum class WindowOperation {
  always,       ///< one state in all hours
  schedule,     ///< a state for each hour, by a table or a file
  lm_83,        ///< closed while the group lets direct sunlight onto the sensors (IES LM-83-12)
  illuminance,  ///< closed above an illuminance of the panes, open again below a lower one
};

/// A span of the year with a state of its own.
struct ScheduleSpan {
  int state = 0;
  int from_month = 1, from_day = 1, to_month = 12, to_day = 31;  ///< both days are within
  int from_hour = 0, to_hour = 24;                               ///< of every day, standard time

  /// True if the span holds an hour. Spans may go round the end of the year, and of the day.
  bool contains(int month, int day, int hour) const;
};

/// Windows that are operated together.
struct WindowGroup {
  std::string name{};
  std::vector<int> surfaces{};        ///< ascending indices into Scene::surfaces
  std::vector<WindowState> states{};  ///< at least two; the first is the open one
  WindowOperation operation = WindowOperation::lm_83;
  /// The state of `always`; the closed state of `lm_83` and `illuminance`.
  int state = 1;
  double close_above = 0.0, open_below = 0.0;  ///< lx, of `illuminance`; open_below <= close_above
  /// Spans of `schedule`: later ones go before earlier ones, and hours in none have the first
  /// state.
  std::vector<ScheduleSpan> spans{};
  /// State of each hour of the year, 8760 or 8784, of a `schedule` by a file.
  std::vector<int> hours{};
};

/// The windows of a scene that people or motors operate.
struct OperatedWindows {
  std::vector<WindowGroup> groups{};
  std::vector<Material> materials{};  ///< of the states
};

/// Most states of one group.
inline constexpr int most_window_states = 16;

/// Reads the windows of the file of `scene`: the [[windows]] tables of a native file, or the
/// openings with states of a Honeybee model; none from files of other formats. Throws InputError
/// naming file, line, group and remedy.
OperatedWindows read_windows(const Scene& scene);
/// read_windows() of a native file.
OperatedWindows read_toml_windows(const Scene& scene);
/// read_windows() of a Honeybee model. A group is the openings of one dynamic group whose states
/// have the same modifiers, by the rule of LM-83 with the second state closed. States change
/// modifiers alone: further geometry of states is left out.
OperatedWindows read_honeybee_windows(const Scene& scene);

/// Reads the [[windows]] of a TOML file beside a scene of any format. Materials are those of the
/// file's own [materials], then those of the scene. Throws what read_windows() throws.
OperatedWindows read_windows(const std::filesystem::path& file, const Scene& scene);

}  // namespace lightwell
