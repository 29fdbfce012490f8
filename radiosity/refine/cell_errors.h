#pragma once

#include <array>
#include <vector>

#include "mesh/elements/refine_elements.h"
#include "radiosity/refine/interpolation_error.h"
#include "radiosity/solution/scene_parts.h"

namespace lightwell {

/// The squared errors of cells: those that InterpolationError has measured, and those that are
/// expected of cells not measured yet. Squared errors are relative to error_reference() squared.
/// Parts are numbered as by SceneParts::group_of(). Keeps references to `elements` and `parts`.
class CellErrors {
 public:
  /// The expected share of a cell's squared error that is left in its children: a sixteenth in
  /// smooth light, a half along the edge of a shadow, for which most cells (not all) are split.
  static constexpr double of_a_split = 0.4;

  /// Children are expected to have of_a_split of their parent's squared error, if refinement
  /// `may_go_on` later. Otherwise they are taken to be as bad as their parent until they are
  /// measured, and share_left() alone expects less.
  CellErrors(const RefinedElements& elements, const SceneParts& parts, bool may_go_on);

  /// Sets the squared errors that are expected of a cell of the start.
  void expect(int cell, const std::array<double, 2>& of_sides);
  /// Sets what was measured at a cell.
  void set_measured(int cell, const InterpolationError::Measured& squares);
  /// Expects errors of the leaves that splits have made, by those of their parents.
  void expect_of_parents();
  bool is_measured(int cell) const { return state_[cell] == State::measured; }
  /// Asks for another measurement of a cell; its errors stay until then.
  void measure_again(int cell) { state_[cell] = State::expected; }

  /// Squared error times area of the sides of a cell in a part, weighted by their importance. The
  /// error that noise may hide in a cell is nothing for the most part, and counts only if it could
  /// be a notable share of `allowed`, the part's. Such a cell is split, and its parts are measured.
  double counted(int cell, int part, double allowed) const;
  /// Calls visit(part) for the parts that the sides of a cell are in, once each.
  template <class Visit>
  void for_each_part(int cell, Visit&& visit) const {
    const int first = part_of(cell, 0);
    visit(first);
    if (elements_.side_count(cell) < 2) return;
    if (const int second = part_of(cell, 1); second != first) visit(second);
  }
  /// The share of a cell's squared error that is there when nothing is split any more.
  double share_left(int cell) const;
  /// RMS error of a side when nothing is split any more; includes half of the squared error that
  /// noise may hide, which is between none and all of it.
  float relative_error(int cell, int side) const;

 private:
  struct Square {
    float known = 0.0f, hidden = 0.0f;
  };
  void make_room();
  int part_of(int cell, int side) const {
    return parts_.group_of(elements_.base().patch[elements_.element(cell, side)]);
  }

  const RefinedElements& elements_;
  const SceneParts& parts_;
  double of_children_, in_the_end_;
  std::vector<Square> squares_{};  // per side
  enum class State : char { unknown, expected, measured };
  std::vector<State> state_{};  // per cell
};

}  // namespace lightwell
