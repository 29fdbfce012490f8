#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace lightwell {

/// A straight line in the plane of a facet.
struct FlatLine {
  std::array<int, 2> point{};            ///< numbers of the ends
  std::array<Eigen::Vector2d, 2> end{};  ///< metres
};

/// Number of places where two of the lines cross, ends aside; at most about `most`, where counting
/// stops.
std::size_t count_crossings(const std::vector<FlatLine>& lines, std::size_t most);

/// Returns per line 1 if it is kept: as many of the longest lines as cross each other in at most
/// `most` places.
std::vector<char> longest_lines(const std::vector<FlatLine>& lines, std::size_t most);

}  // namespace lightwell
