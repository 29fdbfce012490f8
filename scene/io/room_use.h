#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lightwell {

/// How lamps follow daylight to the maintained illuminance.
enum class LampControl {
  on_off,   ///< off where daylight suffices, else at full power
  stepped,  ///< by the least of equal steps that suffices
  dimmed    ///< by just the light that daylight lacks
};

/// Electric light of a room, for the share of its energy that daylight saves.
struct RoomLighting {
  std::optional<double> watts{};  ///< installed power, > 0; empty: not known
  double lux = 500.0;             ///< maintained illuminance, > 0
  LampControl control = LampControl::dimmed;
  int steps = 2;         ///< of `stepped`, at least 1
  double standby = 0.0;  ///< share of the power that lamps without output take, [0,1)
  /// True: all lamps follow the darkest sensor of the room. False: those over each sensor follow
  /// it.
  bool is_one_zone = false;
};

/// Use of the rooms whose sensors have a name, for the daylight of a year (a [[rooms]] table).
struct RoomUse {
  std::string sensors{};              ///< name of sensors, or a pattern of names as in a shell
  bool is_regularly_occupied = true;  ///< false: rating systems do not count the room
  std::optional<double> area{};       ///< of the floor, m^2, > 0; empty: that of the grid
  std::optional<RoomLighting> lighting{};
  std::string place{};  ///< "file:line:column: rooms 1 of file", for messages
};

/// Reads the [[rooms]] of a TOML file. Throws InputError naming file, line and remedy.
std::vector<RoomUse> read_room_uses(const std::filesystem::path& file);

}  // namespace lightwell
