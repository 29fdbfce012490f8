#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace lightwell {

/// Reflection of a road surface towards drivers, who look down by 1 degree: the reduced luminance
/// coefficient r = q cos^3(gamma), where q is luminance over illuminance (CIE 144:2001, 66:1984).
struct RTable {
  std::string name{};
  /// Tangent of the angle between the vertical and the light, rising from 0.
  std::vector<double> tan_gamma{};
  /// Degrees between the vertical planes of sight and of light, rising from 0 to 180; 0: the light
  /// comes from beyond the point.
  std::vector<double> beta{};
  Eigen::ArrayXXd r{};  ///< 1/sr; a row for each tan(gamma), a column for each beta
  double q0 = 0.0;      ///< average luminance coefficient Q_0 by which the table is called, 1/sr
};

/// Luminaires count up to this many heights beyond a point of the road (EN 13201-3), so tables
/// reach to this tan(gamma).
inline constexpr double heights_beyond_point = 12.0;

/// Least and greatest Q_0 of a surface that is taken for a road, 1/sr. Roads lie from about 0.03 to
/// 0.3, also when they are wet; the range is three times wider on either side.
inline constexpr double darkest_road = 0.01, lightest_road = 0.9;

/// r in 1/sr, linear in tan(gamma) and in beta between the entries; 0 beyond the last tan(gamma).
/// `tan_gamma` >= 0, `beta` in [0,180] degrees. Whether CIE 140 and EN 13201-3 ask for another
/// interpolation was not checked.
double reduced_luminance_coefficient(const RTable& table, double tan_gamma, double beta);

/// Q_0 = int q dw / int dw, 1/sr, over the luminaires of a road: for a height of 1, from 4 before
/// the point to 12 beyond it, and 3 to either side (CIE 144:2001). By the midpoint rule on squares
/// of 1/20.
double average_luminance_coefficient(const RTable& table);

/// Specular factor S1 = r(tan gamma = 2, beta = 0) / r(0, 0).
double specular_factor(const RTable& table);

/// The same table for a lighter or darker surface: all r times `q0` over the table's own.
RTable scaled_to(RTable table, double q0);

/// Names of the tables that the program holds: "R1" to "R4" of CIE 30.2, "C1" and "C2" of CIE 66.
std::vector<std::string> r_table_names();

/// A table of r_table_names(), of Q_0 0.10, 0.07, 0.07, 0.08, 0.10 and 0.07. Cells that the
/// publications leave blank are 0. r falls with tan(gamma) beyond 2 but for eight entries: of R3 at
/// (tan gamma, beta) = (6, 25), (9.5, 15) and (10, 20), and of C2 by one last digit at (11.5, 0),
/// (10, 10), (12, 10), (8, 20) and (9.5, 20). Public copies of the tables have them so, too.
RTable standard_r_table(const std::string& name);

/// Reads a table from a text file: numbers between commas, semicolons or blanks. The first line has
/// the angles beta, behind an optional word; each further line has tan(gamma), from 0 to 12 or
/// more, and r times 10^4 for each beta. Lines that begin with # are comments. Q_0 is computed.
/// Throws InputError naming file, line and remedy.
RTable read_r_table(const std::filesystem::path& path);

namespace standards_data {
extern const std::string_view r_tables;  ///< the bytes of r_tables.csv
}  // namespace standards_data

}  // namespace lightwell
