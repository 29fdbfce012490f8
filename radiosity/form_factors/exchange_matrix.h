#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "radiosity/rows/symmetric_rows.h"

namespace lightwell {

/// An exchange area S_ij = A_i F_ij and how it was found. Closed forms are told from samples by the
/// sign of the number, which is not needed for anything else.
class Exchange {
 public:
  enum Kind { sampled = 0, known = 1 };
  static Exchange of(int patch, Kind kind, float value) {
    return {patch, kind == known ? -value : value};
  }

  int patch() const { return patch_; }
  float value() const { return std::abs(signed_value_); }
  Kind kind() const { return static_cast<Kind>(std::bit_cast<std::uint32_t>(signed_value_) >> 31); }

 private:
  Exchange(int patch, float signed_value) : patch_(patch), signed_value_(signed_value) {}
  int patch_ = 0;
  float signed_value_ = 0.0f;
};

/// A number for each patch and kind of exchange.
using PerKind = Eigen::Array<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// The symmetric matrix of exchange areas of all patches. Only one of S_ij and S_ji is kept.
class ExchangeMatrix {
 public:
  ExchangeMatrix(std::shared_ptr<MemoryBudget> budget, int patches);

  /// S_ij, j >= i, of row i, columns rising. From many threads.
  void append(int i, std::span<const Exchange> row) { upper_.append(i, row.data(), row.size()); }
  void close() { upper_.close(); }

  /// y_i = sum_j S_ij x_j, of sampled and of known exchange apart.
  PerKind product(const PerKind& x) const;

  /// `visit(i, row)` for every row, complete and in order, from many threads; the last rows come
  /// first. The matrix is empty afterwards.
  template <class Visit>
  void consume(Visit visit) {
    unfold_symmetric(upper_, [&](int i, RecordSpan below, RecordSpan upper) {
      std::vector<Exchange> row;
      row.reserve(below.size() + upper.size());
      for (const RecordSpan part : {below, upper}) {
        const auto records = part.as<Exchange>();
        row.insert(row.end(), records.begin(), records.end());
      }
      visit(i, std::span<const Exchange>(row));
    });
  }

 private:
  RecordStore upper_;
};

}  // namespace lightwell
