#pragma once

#include "mesh/elements/refine_elements.h"

namespace lightwell {

/// Calls visit(vertex) for the vertices that a split of `cell` uses on `side`: the middles of its
/// edges, then its centre if the cell has four corners. Makes the vertices that do not exist yet.
template <class Visit>
void for_each_inner_vertex(RefinedElements& elements, int cell, int side, Visit&& visit) {
  const int n = elements.corner_count(cell);
  for (int i = 0; i < n; ++i) visit(elements.edge_vertex(cell, side, i));
  if (n == 4) visit(elements.center_vertex(cell, side));
}

/// Calls visit(vertex) for the corners of `cell` on `side`, then for its inner vertices.
template <class Visit>
void for_each_vertex(RefinedElements& elements, int cell, int side, Visit&& visit) {
  for (int i = 0; i < elements.corner_count(cell); ++i) {
    visit(elements.corner_vertex(cell, side, i));
  }
  for_each_inner_vertex(elements, cell, side, visit);
}

}  // namespace lightwell
