#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "radiosity/rows/row_store.h"

namespace lightwell {

/// Columns [first, last) of the triangle of a RecordStore that it counts, ordered by row: a block
/// of its transpose. A record's patch becomes the row it comes from.
class ColumnBlock {
 public:
  ColumnBlock(const RecordStore& rows, int first, int last);

  RecordSpan column(int j) const {
    const std::size_t begin = begin_[static_cast<std::size_t>(j - first_)];
    const std::size_t end = begin_[static_cast<std::size_t>(j - first_) + 1];
    return {records_.data() + begin * record_bytes_, end - begin, record_bytes_};
  }

 private:
  void fill(const RecordStore& rows, int row, int low, int high, std::size_t* at);

  int first_ = 0;
  std::size_t record_bytes_ = 0;
  std::vector<std::size_t> begin_;
  std::vector<std::byte> records_;
};

/// Ranges of columns, each of which makes a ColumnBlock of about `bytes`. Those of a triangle below
/// the diagonal rise, those above fall: so that, block by block, rows [first, last) are not needed
/// for later ones.
struct ColumnRange {
  int first = 0, last = 0;
};
std::vector<ColumnRange> column_ranges(const RecordStore& rows, std::int64_t bytes);

/// Visits pairs (i, j), j >= i, of a symmetric matrix of which both triangles were found out apart:
/// row i and, from column i, what rows j > i say. `visit(j, own, other)` gets the two records;
/// nullptr: there is none. The diagonal's record is both.
template <class Visit>
void for_each_pair(int i, RecordSpan row, RecordSpan column, Visit visit) {
  constexpr int none = std::numeric_limits<int>::max();
  std::size_t a = row.lower_bound(i), b = 0;
  while (a < row.size() || b < column.size()) {
    const int from_row = a < row.size() ? row.patch(a) : none;
    const int from_column = b < column.size() ? column.patch(b) : none;
    const int j = std::min(from_row, from_column);
    const std::byte* const own = from_row == j ? row[a++] : nullptr;
    const std::byte* const other = from_column == j ? column[b++] : nullptr;
    visit(j, own, j == i ? own : other);
  }
}

}  // namespace lightwell
