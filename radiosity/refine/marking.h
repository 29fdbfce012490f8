#pragma once

#include <cstddef>
#include <vector>

#include "radiosity/refine/cell_errors.h"

namespace lightwell {

/// Marks the leaves to split: those of each part of the scene with the largest squared errors, so
/// many that the others hold at most half of what the part's tolerance allows (Doerfler 1996, "A
/// convergent adaptive algorithm for Poisson's equation").
///
/// Squared errors are times area, m^2; parts are numbered as by SceneParts::group_of(). Keeps
/// references to `elements` and `errors`.
class Marking {
 public:
  /// Leaves of each part, in falling order of squared error.
  using PartMarks = std::vector<std::vector<int>>;

  Marking(const RefinedElements& elements, const CellErrors& errors, int part_count, int max_level,
          bool may_go_on);

  /// Sets the squared error that a part's tolerance allows, over all leaves.
  void allow(int part, double square) { allowed_[static_cast<std::size_t>(part)] = square; }
  /// Sums the errors of all leaves, and marks leaves of the parts that allow less.
  PartMarks mark();
  /// True if the sums of the last mark() are what the tolerances allow.
  bool are_reached() const;
  bool is_reached(int part) const {
    return sum_[static_cast<std::size_t>(part)] <= allowed_[static_cast<std::size_t>(part)];
  }
  /// The leaves of all parts by the share that they hold of the error that is allowed, once each.
  std::vector<int> joined(const PartMarks& by_part) const;
  /// The first of each part's leaves: those above the expected error of the first one's children,
  /// and at most `most` in all. The others wait, so that elements go to the largest errors, however
  /// few there may be. All leaves stay of a part whose measured errors alone are what its tolerance
  /// allows: measured as well, they may be small enough.
  std::vector<int> worst_of(PartMarks by_part, std::size_t most) const;
  /// CellErrors::counted() beside what the part allows.
  double counted(int cell, int part) const {
    return errors_.counted(cell, part, allowed_[static_cast<std::size_t>(part)]);
  }

 private:
  bool may_be_split(int cell) const;
  std::vector<int> worst_half(std::vector<std::pair<double, int>>& by_error, double all,
                              int part) const;

  const RefinedElements& elements_;
  const CellErrors& errors_;
  int max_level_;
  double smallest_;  // area, m^2, above which cells may be split
  double of_children_;
  // Squared errors of each part: allowed, of all leaves, and of the leaves that are measured.
  std::vector<double> allowed_, sum_, measured_;
};

}  // namespace lightwell
