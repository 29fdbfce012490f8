#include "radiosity/rows/column_block.h"

#include <cstring>

#include "scene/parallel.h"

namespace lightwell {
namespace {

bool is_below(const RecordStore& rows) {
  return rows.counted() == RecordStore::Count::below_diagonal;
}

}  // namespace

ColumnBlock::ColumnBlock(const RecordStore& rows, int first, int last)
    : first_(first), record_bytes_(rows.record_bytes()) {
  begin_.push_back(0);
  for (int j = first; j < last; ++j) {
    begin_.push_back(begin_.back() + static_cast<std::size_t>(rows.column_size(j)));
  }
  records_.resize(begin_.back() * record_bytes_);
  std::vector<std::size_t> at(begin_.begin(), begin_.end() - 1);
  const int first_row = is_below(rows) ? first : 0;
  const int last_row = is_below(rows) ? rows.row_count() : last;
  // Each thread fills columns of its own, and all threads walk down the same rows.
  const int stripe = (last - first + thread_count() - 1) / thread_count();
  constexpr int rows_at_once = 512;
  for (int begin = first_row; begin < last_row; begin += rows_at_once) {
    const int end = std::min(begin + rows_at_once, last_row);
    parallel_for(last - first, stripe, [&](int low, int high) {
      for (int i = begin; i < end; ++i) fill(rows, i, first + low, first + high, at.data());
    });
  }
}

void ColumnBlock::fill(const RecordStore& rows, int row, int low, int high, std::size_t* at) {
  if (is_below(rows)) {
    high = std::min(high, row);
  } else {
    low = std::max(low, row + 1);
  }
  if (low >= high) return;
  const RecordSpan records = rows.row(row);
  for (std::size_t k = records.lower_bound(low); k < records.size(); ++k) {
    const int j = records.patch(k);
    if (j >= high) break;
    std::byte* const to = records_.data() + at[j - first_]++ * record_bytes_;
    std::memcpy(to, &row, sizeof row);
    for (std::size_t b = sizeof row; b < record_bytes_; b += 4) {
      std::memcpy(to + b, records[k] + b, 4);
    }
  }
}

std::vector<ColumnRange> column_ranges(const RecordStore& rows, std::int64_t bytes) {
  std::vector<ColumnRange> ranges;
  const int n = rows.row_count();
  const bool rising = is_below(rows);
  std::int64_t taken = 0;
  for (int k = 0; k < n; ++k) {
    const int j = rising ? k : n - 1 - k;
    const auto column = rows.column_size(j) * static_cast<std::int64_t>(rows.record_bytes());
    if (ranges.empty() || taken + column > bytes) {
      ranges.push_back(rising ? ColumnRange{j, j} : ColumnRange{j + 1, j + 1});
      taken = 0;
    }
    taken += column;
    (rising ? ranges.back().last : ranges.back().first) = rising ? j + 1 : j;
  }
  return ranges;
}

}  // namespace lightwell
