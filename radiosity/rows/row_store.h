#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "radiosity/rows/memory_budget.h"

namespace lightwell {

/// Some records of a row, ordered by the patch that each begins with.
class RecordSpan {
 public:
  RecordSpan() = default;
  RecordSpan(const std::byte* data, std::size_t count, std::size_t record_bytes)
      : data_(data), count_(count), record_bytes_(record_bytes) {}

  std::size_t size() const { return count_; }
  const std::byte* operator[](std::size_t k) const { return data_ + k * record_bytes_; }
  int patch(std::size_t k) const { return *reinterpret_cast<const int*>((*this)[k]); }
  /// The first record of a patch not below this one.
  std::size_t lower_bound(int patch) const;
  /// Where they are what a store of `Record` holds.
  template <class Record>
  std::span<const Record> as() const {
    assert(count_ == 0 || record_bytes_ == sizeof(Record));
    return {reinterpret_cast<const Record*>(data_), count_};
  }

 private:
  const std::byte* data_ = nullptr;
  std::size_t count_ = 0, record_bytes_ = 0;
};

/// Rows of records that begin with the number of a patch (an int) and are multiples of 4 bytes
/// long. Rows are added in any order, each at most once, then only read. They are kept in memory as
/// far as the budget allows and in its file else, in chunks that no row straddles.
class RecordStore {
 public:
  /// Of which triangle of the matrix the records of every column are counted.
  enum class Count { none, below_diagonal, above_diagonal };

  /// `budget`: null for one of its own.
  RecordStore(std::shared_ptr<MemoryBudget> budget, int rows, std::size_t record_bytes,
              Count count = Count::none);
  RecordStore(RecordStore&&) noexcept;
  RecordStore& operator=(RecordStore&&) noexcept;
  ~RecordStore();

  /// Adds row i; from many threads if need be. Throws std::runtime_error if the disk is full.
  void append(int i, const void* records, std::size_t count);
  /// All rows are in; from now on they may be read.
  void close();

  int row_count() const;
  std::size_t record_bytes() const;
  /// Records of all rows.
  std::int64_t record_count() const;
  std::size_t row_size(int i) const;
  /// Valid until the row is released. Empty for rows that were not added.
  RecordSpan row(int i) const;
  /// Row i is not needed any more. Memory is given back once that is true of all of a chunk. Not
  /// from two threads at a time.
  void release(int i);

  Count counted() const;
  /// Records of column j in the triangle that is counted.
  int column_size(int j) const;
  MemoryBudget& budget() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A RecordStore of one kind of record.
template <class Record>
class RowStore {
 public:
  using Count = RecordStore::Count;
  RowStore(std::shared_ptr<MemoryBudget> budget, int rows, Count count = Count::none)
      : records_(std::move(budget), rows, sizeof(Record), count) {}

  void append(int i, std::span<const Record> row) { records_.append(i, row.data(), row.size()); }
  void close() { records_.close(); }
  int row_count() const { return records_.row_count(); }
  std::int64_t record_count() const { return records_.record_count(); }
  std::span<const Record> row(int i) const { return records_.row(i).template as<Record>(); }
  void release(int i) { records_.release(i); }
  const RecordStore& records() const { return records_; }

 private:
  RecordStore records_;
};

}  // namespace lightwell
