#include "radiosity/balance.h"

#include <algorithm>
#include <cmath>

#include "scene/parallel.h"

namespace lightwell {

SparseRows symmetric_rows(int n, std::span<const SymmetricEntry> entries) {
  struct Cell {
    int column;
    double value;
  };
  std::vector<std::int64_t> first(static_cast<std::size_t>(n) + 1, 0);
  for (const SymmetricEntry& e : entries) {
    ++first[e.i + 1];
    ++first[e.j + 1];
  }
  for (int i = 0; i < n; ++i) first[i + 1] += first[i];
  std::vector<Cell> cells(static_cast<std::size_t>(first[n]));
  std::vector<std::int64_t> at(first.begin(), first.end() - 1);
  for (const SymmetricEntry& e : entries) {
    cells[at[e.i]++] = {e.j, e.value};
    cells[at[e.j]++] = {e.i, e.value};
  }
  SparseRows rows;
  rows.first.push_back(0);
  rows.column.reserve(cells.size());
  rows.value.reserve(cells.size());
  for (int i = 0; i < n; ++i) {
    std::stable_sort(cells.begin() + first[i], cells.begin() + first[i + 1],
                     [](const Cell& a, const Cell& b) { return a.column < b.column; });
    for (std::int64_t k = first[i]; k < first[i + 1]; ++k) {
      if (k + 1 < first[i + 1] && cells[k + 1].column == cells[k].column) continue;
      rows.column.push_back(cells[k].column);
      rows.value.push_back(static_cast<float>(cells[k].value));
    }
    rows.first.push_back(static_cast<std::int64_t>(rows.column.size()));
  }
  return rows;
}

Eigen::ArrayXd symmetric_scaling(const SparseRows& S, const Eigen::ArrayXd& open,
                                 const Eigen::ArrayXd& target, double tolerance,
                                 int max_iterations) {
  const int n = S.rows();
  Eigen::ArrayXd d = Eigen::ArrayXd::Ones(n);
  Eigen::ArrayXd sum(n);
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    parallel_for(n, 256, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        double s = open[i];
        for (std::int64_t e = S.first[i]; e < S.first[i + 1]; ++e)
          s += static_cast<double>(S.value[e]) * d[S.column[e]];
        sum[i] = s;
      }
    });
    double worst = 0.0;
    for (int i = 0; i < n; ++i) {
      if (!(sum[i] > 0.0)) continue;
      const double wanted = std::max(target[i], 0.0);
      if (wanted > 0.0) worst = std::max(worst, std::abs(d[i] * sum[i] / wanted - 1.0));
      d[i] = std::sqrt(d[i] * wanted / sum[i]);
    }
    if (worst < tolerance) break;
  }
  return d;
}

}  // namespace lightwell
