#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "radiosity/rows/memory_budget.h"

namespace lightwell {

/// Records of a row, in ascending order of the patch number at the start of each record.
class RecordSpan {
 public:
  RecordSpan() = default;
  RecordSpan(const std::byte* data, std::size_t count, std::size_t record_bytes)
      : data_(data), count_(count), record_bytes_(record_bytes) {}

  std::size_t size() const { return count_; }
  const std::byte* operator[](std::size_t k) const { return data_ + k * record_bytes_; }
  int patch(std::size_t k) const { return *reinterpret_cast<const int*>((*this)[k]); }
  /// Index of the first record whose patch number is at least `patch`.
  std::size_t lower_bound(int patch) const;
  /// The records as an array. Precondition: the store holds records of type Record.
  template <class Record>
  std::span<const Record> as() const {
    assert(count_ == 0 || record_bytes_ == sizeof(Record));
    return {reinterpret_cast<const Record*>(data_), count_};
  }

 private:
  const std::byte* data_ = nullptr;
  std::size_t count_ = 0, record_bytes_ = 0;
};

/// Rows of records. A record begins with the number of a patch (an int) and is a multiple of 4
/// bytes long. Each row is added at most once, in any order. After close() rows are only read. Rows
/// stay in memory as far as the budget allows, otherwise in the budget's file, in chunks that no
/// row straddles.
class RecordStore {
 public:
  /// Triangle of the matrix in which the records of each column are counted.
  enum class Count { none, below_diagonal, above_diagonal };

  /// `budget`: null: a budget of the store's own.
  RecordStore(std::shared_ptr<MemoryBudget> budget, int rows, std::size_t record_bytes,
              Count count = Count::none);
  RecordStore(RecordStore&&) noexcept;
  RecordStore& operator=(RecordStore&&) noexcept;
  ~RecordStore();

  /// Adds row i. Safe to call from many threads. Throws std::runtime_error if the disk is full.
  void append(int i, const void* records, std::size_t count);
  /// Ends the adding of rows. Rows may be read from then on.
  void close();

  int row_count() const;
  std::size_t record_bytes() const;
  /// Number of records of all rows.
  std::int64_t record_count() const;
  std::size_t row_size(int i) const;
  /// Row i, valid until release(i). Empty for rows that were not added.
  RecordSpan row(int i) const;
  /// Gives up row i. Memory is freed once all rows of a chunk are released. Not safe from several
  /// threads at once.
  void release(int i);

  Count counted() const;
  /// Number of records of column j in the counted triangle.
  int column_size(int j) const;
  MemoryBudget& budget() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A RecordStore of records of one type.
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
