#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "radiosity/rows/row_store.h"

namespace lightwell {

/// Columns [first, last) of the triangle that a RecordStore counts, each ordered by row: a block of
/// the transpose. The patch of a record in a column is the record's row.
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

/// Ranges of columns, each for a ColumnBlock of about `bytes`. Ranges ascend for a triangle below
/// the diagonal and descend for one above. In either order, once a block is done, later blocks do
/// not need its rows [first, last).
struct ColumnRange {
  int first = 0, last = 0;
};
std::vector<ColumnRange> column_ranges(const RecordStore& rows, std::int64_t bytes);

/// Visits pairs (i, j), j >= i, of a symmetric matrix whose triangles were computed independently.
/// `row` is row i; `column` holds the records of column i in rows j > i. `visit(j, own, other)`
/// gets the record of row i and the one of row j, nullptr for a missing record. On the diagonal
/// both are the same record.
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
