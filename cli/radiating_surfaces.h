#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "radiosity/form_factors/view_factor_rows.h"
#include "radiosity/radiation/radiant_exchange.h"

namespace lightwell {

/// The surface of each row, as a CSV file of surfaces describes them. Its first line names columns:
///
/// - `surface`: a name or a pattern, see matches_glob(). Later lines go before earlier ones.
/// - `emittance`, 0 to 1; where it is empty or missing, that of the scene file, else 1.
/// - `kelvin`, `celsius` or `heat` (W, net, away from the surface): one of them in each line. Heat
///   is spread over all rows of its line by area.
///
/// `area`: m^2, of each row. Throws InputError that names file and line
///   - for columns and values that are missing or out of range;
///   - for a line that describes no row, and for rows that no line describes.
std::vector<RadiatingSurface> read_radiating_surfaces(const std::filesystem::path& csv,
                                                      const ViewFactorRows& rows,
                                                      const std::vector<double>& area);

/// The albedo of each row, 0 to highest_albedo, from a CSV file with the columns `surface`, as
/// above, and `albedo`. Throws as read_radiating_surfaces().
Eigen::ArrayXd read_albedos(const std::filesystem::path& csv, const ViewFactorRows& rows);

}  // namespace lightwell
