#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lightwell {

/// A level that a cue gives to light channels.
struct WordedLevel {
  std::string channels{};  ///< name of a channel, or a pattern of names as in a shell
  std::string value{};     ///< setting of a channel, such as "0.3", "off" or "0.3,#ffd9b0"
  std::string place{};     ///< "file:line:column: level 'desk' of cue 'dusk'", for messages
};

/// A lighting cue in the words of a file. Times are seconds, finite and >= 0.
struct WordedCue {
  std::string name{};  ///< that files can be called after; unique in the file
  std::vector<WordedLevel> levels{};
  std::optional<WordedLevel> others{};  ///< of all channels without a level; unset: they track
  double fade_up = 0.0, fade_down = 0.0;
  double wait = 0.0;  ///< before the fade
  double hold = 0.0;  ///< after the fade, before the next cue follows
};

/// Reads the [[cues]] of a TOML file, in their order (docs/relighting.md). Throws InputError naming
/// file, line, cue and remedy.
std::vector<WordedCue> read_cues(const std::filesystem::path& path);

}  // namespace lightwell
