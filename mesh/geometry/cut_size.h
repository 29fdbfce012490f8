#pragma once

namespace lightwell {

/// How finely to cut: patches of at most `patch_size` metres, each edge of a full patch in
/// `elements_per_edge` equal pieces.
struct CutSize {
  double patch_size = 1.0;
  int elements_per_edge = 2;

  double element_size() const { return patch_size / elements_per_edge; }
  /// Pieces of a straight line: whole patches if it is at least one patch long, else elements.
  int pieces(double length) const;
  int patches(double length) const;
};

}  // namespace lightwell
