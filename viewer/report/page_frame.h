#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "raytrace/readings/lux_grid.h"

namespace lightwell {

/// The beginning of a page for screens and A4 paper, up to <body>, with the style of tables, plans
/// and curves.
std::string page_begin(const std::string& title);
/// A heading and a list of sentences; empty without sentences.
std::string list_section(const char* title, const std::vector<std::string>& sentences);
inline constexpr const char* page_end = "</body></html>\n";

/// North along u and v of a grid that lies level; empty: `north` is not known, or the grid
/// inclines.
std::optional<Eigen::Vector2d> north_in(const std::optional<Eigen::Vector3d>& north,
                                        const LuxGrid& grid);

}  // namespace lightwell
