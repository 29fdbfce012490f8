#include "raytrace/readings/isolux_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "raytrace/readings/round_step.h"

namespace lightwell {
namespace {

// An edge between two neighbouring points of the grid, by their cells; the lower number first.
using Edge = std::pair<int, int>;

struct Field {
  const LuxGrid& grid;
  std::vector<double> of_cell;  // NaN where the grid has no point

  double at(int cell) const { return of_cell[static_cast<std::size_t>(cell)]; }
};

Field field_of(const LuxGrid& grid, const Eigen::ArrayXd& lux) {
  Field field{grid, std::vector<double>(static_cast<std::size_t>(grid.rows) *
                                            static_cast<std::size_t>(grid.columns),
                                        std::nan(""))};
  for (std::size_t i = 0; i < grid.cell.size(); ++i) {
    field.of_cell[static_cast<std::size_t>(grid.cell[i])] = lux[static_cast<Eigen::Index>(i)];
  }
  return field;
}

Eigen::Vector2d center_of(const LuxGrid& grid, int cell) {
  return {grid.step_u * (cell % grid.columns + 0.5), grid.step_v * (cell / grid.columns + 0.5)};
}

Eigen::Vector2d crossing(const Field& field, const Edge& edge, double value) {
  const double a = field.at(edge.first), b = field.at(edge.second);
  const double t = (value - a) / (b - a);
  return (1.0 - t) * center_of(field.grid, edge.first) + t * center_of(field.grid, edge.second);
}

// Pairs of edges that a line joins within the square whose lowest corner is `cell`.
std::vector<std::pair<Edge, Edge>> pieces(const Field& field, int cell, double value) {
  const int up = field.grid.columns;
  const std::array<int, 4> corner = {cell, cell + 1, cell + up + 1, cell + up};
  std::array<bool, 4> above{};
  double mean = 0.0;
  for (std::size_t c = 0; c < 4; ++c) {
    const double lux = field.at(corner[c]);
    if (std::isnan(lux)) return {};
    above[c] = lux >= value;
    mean += 0.25 * lux;
  }
  std::vector<Edge> cut;
  for (std::size_t c = 0; c < 4; ++c) {
    const std::size_t next = (c + 1) % 4;
    if (above[c] != above[next]) cut.push_back(std::minmax(corner[c], corner[next]));
  }
  if (cut.size() == 2) return {{cut[0], cut[1]}};
  if (cut.size() != 4) return {};
  // Edges 0 and 3 meet in corner 0. The line cuts corner 0 off unless the middle is on its side.
  if ((mean >= value) == above[0]) return {{cut[0], cut[1]}, {cut[2], cut[3]}};
  return {{cut[3], cut[0]}, {cut[1], cut[2]}};
}

using Neighbours = std::map<Edge, std::vector<Edge>>;

// Walks from `start` along unused pieces, and takes them out.
std::vector<Edge> chain_from(const Edge& start, Neighbours& next) {
  std::vector<Edge> chain = {start};
  for (Edge at = start; !next[at].empty();) {
    const Edge to = next[at].back();
    next[at].pop_back();
    std::vector<Edge>& back = next[to];
    back.erase(std::ranges::find(back, at));
    chain.push_back(at = to);
  }
  return chain;
}

}  // namespace

std::vector<Isoline> isolux_lines(const LuxGrid& grid, const Eigen::ArrayXd& lux, double value) {
  const Field field = field_of(grid, lux);
  Neighbours next;
  for (int row = 0; row + 1 < grid.rows; ++row) {
    for (int column = 0; column + 1 < grid.columns; ++column) {
      for (const auto& [a, b] : pieces(field, row * grid.columns + column, value)) {
        next[a].push_back(b);
        next[b].push_back(a);
      }
    }
  }
  std::vector<Edge> starts;  // ends of open lines first
  for (const auto& [edge, others] : next) {
    if (others.size() == 1) starts.push_back(edge);
  }
  for (const auto& [edge, others] : next) {
    if (others.size() == 2) starts.push_back(edge);
  }
  std::vector<Isoline> lines;
  for (const Edge& start : starts) {
    const std::vector<Edge> chain = chain_from(start, next);
    if (chain.size() < 2) continue;
    Isoline line{.lux = value, .is_closed = chain.front() == chain.back()};
    for (const Edge& edge : chain) line.points.push_back(crossing(field, edge, value));
    if (line.is_closed) line.points.pop_back();
    lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<double> isolux_values(double least, double greatest, int most) {
  std::vector<double> values;
  constexpr double even = 0.01;  // light that differs by less has no lines worth a label
  if (!(greatest - least > even * greatest)) return values;
  const auto add = [&](double value) {
    if (value > least && value < greatest) values.push_back(value);
  };
  for (double decade = 0.1; decade < 1e7; decade *= 10.0) {
    for (const double step : {1.0, 1.5, 2.0, 3.0, 5.0, 7.5}) add(step * decade);
  }
  constexpr int fewest = 3;
  if (static_cast<int>(values.size()) < fewest) {
    values.clear();
    constexpr double wanted = 5.0;
    const double step = round_step((greatest - least) / wanted);
    for (double k = std::ceil(least / step); k * step < greatest; k += 1.0) add(k * step);
  }
  // The highest values have the most to say about a working plane.
  if (static_cast<int>(values.size()) > most) values.erase(values.begin(), values.end() - most);
  return values;
}

}  // namespace lightwell
