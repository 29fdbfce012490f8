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

/// An exchange area S_ij = A_i F_ij >= 0 and its kind: sampled or a closed form. The sign bit of
/// the stored number holds the kind.
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

/// One number per patch and kind of exchange: patches x 2.
using PerKind = Eigen::Array<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// The symmetric matrix of exchange areas of all patches, of which only one of S_ij and S_ji is
/// stored.
class ExchangeMatrix {
 public:
  ExchangeMatrix(std::shared_ptr<MemoryBudget> budget, int patches);

  /// Adds row i: S_ij for j >= i, in ascending order of j. Safe to call from many threads.
  void append(int i, std::span<const Exchange> row) { upper_.append(i, row.data(), row.size()); }
  void close() { upper_.close(); }

  /// y_i = sum_j S_ij x_j, separately for sampled and known exchange.
  PerKind product(const PerKind& x) const;

  /// Calls `visit(i, row)` for every row, complete and in ascending order of j, from many threads;
  /// last rows first. The matrix is empty afterwards.
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
