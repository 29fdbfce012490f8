#pragma once

#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "mesh/elements/refine_elements.h"
#include "radiosity/refine/interpolated_vertices.h"
#include "radiosity/refine/refine_options.h"
#include "radiosity/refine/vertex_gathers.h"

namespace lightwell {

/// Indirect light inside cells, predicted from their corners.
///
/// Each measured side of a cell has a squared error of interpolated indirect light. Indirect light
/// is *even* in a cell if that error, of the cell or of one that the cell is part of, is at most
/// (0.3 tolerance)^2. Nothing more of it is gathered in the parts of such a cell, which are made
/// for the edges of shadows; vertices there are interpolated.
class CornerPredictions {
 public:
  /// Indirect light on a side of a cell; squared, relative to error_reference().
  struct CellSide {
    /// Error of interpolation, with a share of the noise below; infinite: not measured.
    float indirect = std::numeric_limits<float>::infinity();
    float noise = indirect;         ///< of the two gathers
    bool was_interpolated = false;  ///< when the cell was measured
  };

  /// Keeps references to both.
  CornerPredictions(RefinedElements& elements, const VertexGathers& gathers)
      : elements_(elements), gathers_(gathers) {}

  /// Takes the tolerances and the parts of `options`. Keeps what was measured.
  void set_tolerance(const RefineOptions& options);
  /// True if the indirect light on the cell's side is interpolated: if it is even in the parent.
  bool is_interpolated(int cell, int side) const;
  /// True if the cell was measured with interpolated light that a new measurement would gather.
  bool is_stale(int cell) const;

  /// Makes room for all cells that exist; needed before side() of a new one.
  void make_room() { sides_.resize(elements_.side_total()); }
  CellSide& side(int cell, int side) { return sides_[elements_.side_number(cell, side)]; }

  /// A vertex of the list is interpolated unless some split cell with uneven indirect light needs a
  /// gather there, or one of its ends is not in the list. Vertex numbers of the result are indices
  /// in the list; entries come after their ends.
  std::vector<InterpolatedVertex> interpolated(const std::vector<int>& vertices) const;
  /// Predictions of the vertices whose ends are all in the list; `interpolated` as interpolated()
  /// returned it. A vertex inside several split cells takes the largest error and noise of them.
  /// `reference` returns error_reference() of a cell's side, W/m^2.
  std::vector<VertexPrediction> predictions(
      const std::vector<int>& vertices, std::span<const InterpolatedVertex> interpolated,
      const std::function<double(int cell, int side)>& reference) const;

  /// Gives back memory that was reserved for further cells.
  void shrink_to_fit() { sides_.shrink_to_fit(); }

 private:
  bool is_even(int cell, int side) const;
  const CellSide* known_of(int cell, int side) const;
  // Largest squared errors of the split cells that a vertex is inside of, (W/m^2)^2.
  struct Largest {
    float spread = -1.0f, noise = 0.0f;  // spread below 0: inside of none
  };
  std::vector<Largest> largest_errors(
      const std::function<double(int cell, int side)>& reference) const;
  // Calls visit(vertex, entry) for the vertices of the list whose ends are all in it, after their
  // ends. The entry has indices in the list.
  template <class Visit>
  void for_each_with_ends(const std::vector<int>& vertices, Visit&& visit) const;

  RefinedElements& elements_;
  const VertexGathers& gathers_;
  SceneParts parts_{};
  std::vector<double> even_;     // largest squared error of even light in each part, relative
  std::vector<CellSide> sides_;  // by RefinedElements::side_number()
};

}  // namespace lightwell
