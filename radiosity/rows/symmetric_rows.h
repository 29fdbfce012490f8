#pragma once

#include <algorithm>

#include "radiosity/rows/column_block.h"
#include "scene/parallel.h"

namespace lightwell {

/// Reads a symmetric matrix S whose diagonal and upper triangle are `upper`, to compute y = S x:
///   - `own(i, row)` adds y_i += S_ij x_j over the whole row;
///   - `below(i, k, row)` adds y_j += S_ij x_i for j = row.patch(k) > i.
///
/// Both add to each element of y in the order of rows, whatever the number of threads. No element
/// is added to from two threads at a time if own and below add to different arrays.
template <class Own, class Below>
void read_symmetric(const RecordStore& upper, Own own, Below below) {
  const int n = upper.row_count();
  // Rows that `own` has read are still in the processor's cache when `below` reads them.
  constexpr std::size_t bytes_at_once = 1 << 20;
  for (int begin = 0, end = 0; begin < n; begin = end) {
    std::size_t bytes = 0;
    while (end < n && bytes < bytes_at_once) {
      bytes += upper.row_size(end++) * upper.record_bytes() + sizeof(int);
    }
    parallel_for(end - begin, 64, [&](int low, int high) {
      for (int i = begin + low; i < begin + high; ++i) own(i, upper.row(i));
    });
    const int columns = n - begin;
    const int stripe = (columns + thread_count() - 1) / thread_count();
    parallel_for(columns, stripe, [&](int low, int high) {
      for (int i = begin; i < end; ++i) {
        const RecordSpan row = upper.row(i);
        const std::size_t last = row.lower_bound(begin + high);
        for (std::size_t k = row.lower_bound(std::max(begin + low, i + 1)); k < last; ++k) {
          below(i, k, row);
        }
      }
    });
  }
}

/// Visits the whole rows of the symmetric matrix in `upper`, last rows first. `visit(i, below,
/// upper)` gets the records left of the diagonal and all others. Called from many threads. Rows are
/// released block by block.
template <class Visit>
void unfold_symmetric(RecordStore& upper, Visit visit) {
  for (const ColumnRange range : column_ranges(upper, upper.budget().block_bytes())) {
    const ColumnBlock block(upper, range.first, range.last);
    parallel_for(range.last - range.first, 16, [&](int low, int high) {
      for (int i = range.first + low; i < range.first + high; ++i) {
        visit(i, block.column(i), upper.row(i));
      }
    });
    for (int i = range.first; i < range.last; ++i) upper.release(i);
  }
}

/// Joins both triangles of a matrix whose triangles were computed independently. `join(i, row,
/// column)` gets row i and the records of column i in rows j > i, see for_each_pair. `join` is
/// called from many threads. Rows are released block by block, and `passed(i)` is called after the
/// release of row i.
template <class Join, class Passed>
void fold_symmetric(RecordStore& directed, Join join, Passed passed) {
  for (const ColumnRange range : column_ranges(directed, directed.budget().block_bytes())) {
    const ColumnBlock block(directed, range.first, range.last);
    parallel_for(range.last - range.first, 16, [&](int low, int high) {
      for (int i = range.first + low; i < range.first + high; ++i) {
        join(i, directed.row(i), block.column(i));
      }
    });
    for (int i = range.first; i < range.last; ++i) {
      directed.release(i);
      passed(i);
    }
  }
}

}  // namespace lightwell
