#pragma once

namespace lightwell {

/// Sizes of patches and elements: a patch edge is at most `patch_size` metres long, and each edge
/// of a full patch has `elements_per_edge` equal pieces.
struct CutSize {
  double patch_size = 1.0;
  int elements_per_edge = 2;

  double element_size() const { return patch_size / elements_per_edge; }
  /// Number of equal pieces of a straight line of `length` metres: elements_per_edge *
  /// patches(length) where the line is at least one patch long, else ceil(length / element_size()).
  int pieces(double length) const;
  /// Number of patches along a line of `length` metres: ceil(length / patch_size), at least 1.
  int patches(double length) const;
};

}  // namespace lightwell
