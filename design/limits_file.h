#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "design/optimum/dimming.h"

namespace lightwell {

/// A limit in the words of a file.
struct WordedLimit {
  LimitKind kind = LimitKind::mean_at_least;
  std::string place{};   ///< name of a grid, or of the observer's camera
  double value = 0.0;    ///< lx, U_0 or UGR; > 0
  std::string origin{};  ///< "file:line:column: limits of grid 'desk'", begins messages
};

/// Luminaires that are dimmed together, by names, or by patterns as in a shell.
struct WordedGroup {
  std::vector<std::string> names{};
  std::string origin{};  ///< "file:line:column: group 1"
};

/// Luminaires that may be moved: a [[move]] table.
struct WordedMove {
  std::vector<std::string> names{};  ///< or patterns as in a shell
  std::vector<int> axes{};           ///< 0, 1 and 2 for x, y and z; rising
  /// Bounds along each of `axes`, in the unit of the scene's file; lowest <= highest.
  std::vector<double> lowest{}, highest{};
  double apart = 0.0;    ///< least distance from other lamps, in the same unit, >= 0
  std::string origin{};  ///< "file:line:column: table 1 of move"
};

/// Limits of a lighting design and rules of dimming, as a file has them (docs/design.md).
struct LightingLimits {
  std::vector<WordedLimit> limits{};
  /// Maintenance factor of electric light, (0,1]; empty: that of the scene's design.
  std::optional<double> maintenance_factor{};
  double least_level = 0.0;  ///< of each luminaire, [0,1]
  std::vector<WordedGroup> groups{};
  std::vector<WordedMove> moves{};
};

/// Key of a kind of limit in the file, such as "mean_at_least".
const char* limit_key(LimitKind kind);

/// Reads limits from a TOML file. There is at least one. Throws InputError naming file, line, key
/// and remedy.
LightingLimits read_limits(const std::filesystem::path& path);

}  // namespace lightwell
