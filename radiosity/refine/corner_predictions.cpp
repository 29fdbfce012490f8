#include "radiosity/refine/corner_predictions.h"

#include <algorithm>
#include <cmath>

#include "radiosity/refine/cell_vertices.h"

namespace lightwell {

void CornerPredictions::set_tolerance(const RefineOptions& options) {
  constexpr double share = 0.3;  // at worst a tenth of the squared error that is allowed
  parts_ = options.parts;
  even_.clear();
  for (int p = 0; p < parts_.judged_count(); ++p) {
    even_.push_back(std::pow(share * options.tolerance_of(p), 2));
  }
}

// Null for a cell that was made after the last make_room().
const CornerPredictions::CellSide* CornerPredictions::known_of(int cell, int side) const {
  const auto number = static_cast<std::size_t>(elements_.side_number(cell, side));
  return number < sides_.size() ? &sides_[number] : nullptr;
}

bool CornerPredictions::is_even(int cell, int side) const {
  const double even =
      even_[parts_.judged_with(elements_.base().patch[elements_.element(cell, side)])];
  for (int c = cell; c >= 0; c = elements_.parent(c)) {
    const CellSide* known = known_of(c, side);
    if (known && known->indirect <= even) return true;
  }
  return false;
}

bool CornerPredictions::is_interpolated(int cell, int side) const {
  return elements_.parent(cell) >= 0 && is_even(elements_.parent(cell), side);
}

bool CornerPredictions::is_stale(int cell) const {
  for (int side = 0; side < elements_.side_count(cell); ++side) {
    const CellSide* known = known_of(cell, side);
    if (known && known->was_interpolated && !is_interpolated(cell, side)) return true;
  }
  return false;
}

template <class Visit>
void CornerPredictions::for_each_with_ends(const std::vector<int>& vertices, Visit&& visit) const {
  std::vector<int> index(elements_.vertex_count(), -1);
  for (std::size_t i = 0; i < vertices.size(); ++i) index[vertices[i]] = static_cast<int>(i);
  for (int v = 0; v < elements_.vertex_count(); ++v) {
    if (index[v] < 0 || elements_.ends(v)[0] < 0) continue;
    InterpolatedVertex at{.vertex = index[v]};
    bool has_ends = true;
    for (int i = 0; i < 4; ++i) {
      const int end = elements_.ends(v)[i];
      if (end < 0) continue;
      at.ends[i] = index[end];
      has_ends = has_ends && index[end] >= 0;
    }
    if (has_ends) visit(v, at);
  }
}

std::vector<InterpolatedVertex> CornerPredictions::interpolated(
    const std::vector<int>& vertices) const {
  // Vertices inside a split cell whose indirect light is uneven.
  std::vector<char> is_gathered(elements_.vertex_count(), 0);
  for (int cell = 0; cell < elements_.cell_count(); ++cell) {
    if (!elements_.is_split(cell)) continue;
    for (int side = 0; side < elements_.side_count(cell); ++side) {
      if (is_even(cell, side)) continue;
      for_each_inner_vertex(elements_, cell, side, [&](int v) {
        is_gathered.resize(elements_.vertex_count(), 0);
        is_gathered[v] = 1;
      });
    }
  }
  is_gathered.resize(elements_.vertex_count(), 0);
  std::vector<InterpolatedVertex> interpolated;
  for_each_with_ends(vertices, [&](int v, const InterpolatedVertex& at) {
    if (!is_gathered[v]) interpolated.push_back(at);
  });
  return interpolated;
}

std::vector<CornerPredictions::Largest> CornerPredictions::largest_errors(
    const std::function<double(int cell, int side)>& reference) const {
  std::vector<Largest> largest(elements_.vertex_count());
  for (int cell = 0; cell < elements_.cell_count(); ++cell) {
    if (!elements_.is_split(cell)) continue;
    for (int side = 0; side < elements_.side_count(cell); ++side) {
      const CellSide* found = known_of(cell, side);
      const CellSide known = found ? *found : CellSide{};
      const auto unit = static_cast<float>(std::pow(reference(cell, side), 2));
      for_each_inner_vertex(elements_, cell, side, [&](int v) {
        if (largest.size() <= static_cast<std::size_t>(v)) largest.resize(elements_.vertex_count());
        largest[v].spread = std::max(largest[v].spread, unit * known.indirect);
        largest[v].noise = std::max(largest[v].noise, unit * known.noise);
      });
    }
  }
  largest.resize(elements_.vertex_count());
  return largest;
}

std::vector<VertexPrediction> CornerPredictions::predictions(
    const std::vector<int>& vertices, std::span<const InterpolatedVertex> interpolated,
    const std::function<double(int cell, int side)>& reference) const {
  const std::vector<Largest> largest = largest_errors(reference);
  std::vector<char> is_interpolated(vertices.size(), 0);
  for (const InterpolatedVertex& t : interpolated) is_interpolated[t.vertex] = 1;
  std::vector<VertexPrediction> predictions;
  predictions.reserve(vertices.size());
  for_each_with_ends(vertices, [&](int v, const InterpolatedVertex& at) {
    VertexPrediction b{.at = at, .is_interpolated = is_interpolated[at.vertex] != 0};
    if (largest[v].spread >= 0.0f && gathers_.has_gathered_indirect(v)) {
      b.spread = largest[v].spread;
      b.noise = largest[v].noise;
    }
    predictions.push_back(b);
  });
  return predictions;
}

}  // namespace lightwell
