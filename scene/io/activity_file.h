#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace lightwell {

/// Limits of EN 12464-1:2021 for an activity. A limit of 0 is none.
struct Activity {
  std::string key{};              ///< by which scenes name the activity
  std::string title{};            ///< for people
  double mean = 0.0;              ///< least E_m of the task area, lx
  double raised_mean = 0.0;       ///< the same where the standard's reasons to raise it apply, lx
  double uniformity = 0.0;        ///< least U_0 of the task area
  double colour_rendering = 0.0;  ///< least R_a of luminaires
  double glare = 0.0;             ///< greatest R_UG
  double cylindrical = 0.0;       ///< least mean cylindrical illuminance E_m,z, lx
  double walls = 0.0;             ///< least E_m of a wall, lx
  double ceiling = 0.0;           ///< least E_m of the ceiling, lx
};

/// Reads a table of activities (TOML; its keys are in docs/standards.md). Throws InputError naming
/// file, line and remedy.
std::vector<Activity> read_activities(const std::filesystem::path& file);

/// Reads the same from memory; `name` stands in messages for the file.
std::vector<Activity> parse_activities(std::string_view text, const std::filesystem::path& name);

}  // namespace lightwell
