#include "radiosity/form_factors/view_factors.h"

#include <algorithm>
#include <cmath>

#include "radiosity/rows/column_block.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

/// Patches of every row, as ranges of one list.
struct PatchesOfRows {
  std::vector<std::size_t> first{};
  std::vector<int> patch{};
};

PatchesOfRows sort_patches(const std::vector<int>& row_of_patch, int row_count) {
  PatchesOfRows rows;
  rows.first.assign(static_cast<std::size_t>(row_count) + 1, 0);
  for (const int row : row_of_patch) {
    if (row >= 0) ++rows.first[static_cast<std::size_t>(row) + 1];
  }
  for (std::size_t r = 1; r < rows.first.size(); ++r) rows.first[r] += rows.first[r - 1];
  rows.patch.resize(rows.first.back());
  std::vector<std::size_t> next = rows.first;
  for (std::size_t p = 0; p < row_of_patch.size(); ++p) {
    if (row_of_patch[p] >= 0) {
      rows.patch[next[static_cast<std::size_t>(row_of_patch[p])]++] = static_cast<int>(p);
    }
  }
  return rows;
}

/// Sums of one row, cleared in time proportional to the number of entries.
class RowSum {
 public:
  explicit RowSum(int row_count) : power_(static_cast<std::size_t>(row_count), 0.0) {}

  void add(int row, double power) {
    if (power_[static_cast<std::size_t>(row)] == 0.0) touched_.push_back(row);
    power_[static_cast<std::size_t>(row)] += power;
  }
  void move_to(std::vector<FormFactor>& factors, double area) {
    std::sort(touched_.begin(), touched_.end());
    for (const int row : touched_) {
      double& power = power_[static_cast<std::size_t>(row)];
      // The sum of floats may exceed 1 by rounding.
      const auto value = static_cast<float>(std::min(power / area, 1.0));
      if (value > 0.0f) factors.push_back({row, value});
      power = 0.0;
    }
    touched_.clear();
  }

 private:
  std::vector<double> power_;
  std::vector<int> touched_;
};

}  // namespace

float ViewFactors::factor(int i, int j) const {
  const auto entries = row(i);
  const auto found =
      std::lower_bound(entries.begin(), entries.end(), j,
                       [](const FormFactor& f, int column) { return f.patch < column; });
  return found != entries.end() && found->patch == j ? found->value : 0.0f;
}

ViewFactors sum_form_factors(FormFactors& form_factors, const PatchMesh& mesh,
                             const std::vector<int>& row_of_patch, int row_count,
                             std::shared_ptr<MemoryBudget> budget) {
  const PatchesOfRows rows = sort_patches(row_of_patch, row_count);
  ViewFactors result(row_count, std::move(budget));
  RowSum sum(row_count);
  std::vector<FormFactor> factors;
  for (std::size_t p = 0; p < row_of_patch.size(); ++p) {
    if (row_of_patch[p] < 0) form_factors.release(static_cast<int>(p));
  }
  for (int r = 0; r < row_count; ++r) {
    const auto row = static_cast<std::size_t>(r);
    double area = 0.0, open = 0.0, blocked = 0.0;
    const auto add = [&](double A_i, int patch, double F) {
      const int to = row_of_patch[static_cast<std::size_t>(patch)];
      if (to >= 0) {
        sum.add(to, A_i * F);
      } else {
        blocked += A_i * F;
      }
    };
    for (std::size_t k = rows.first[row]; k < rows.first[row + 1]; ++k) {
      const int i = rows.patch[k];
      const double A_i = mesh.area[i];
      area += A_i;
      open += A_i * static_cast<double>(form_factors.escaped(i)[0]);
      blocked += A_i * static_cast<double>(form_factors.absorbed_by_specular(i)[0]);
      for (const auto [patch, F] : form_factors.row(i)) add(A_i, patch, F);
      const SpecularRow specular = form_factors.specular_row(i);
      for (std::size_t s = 0; s < specular.patch.size(); ++s) {
        add(A_i, specular.patch[s], specular.value(static_cast<Eigen::Index>(s), 0));
      }
      form_factors.release(i);
    }
    factors.clear();
    sum.move_to(factors, area);
    result.factors.append(r, factors);
    result.area[row] = area;
    result.open[row] = area > 0.0 ? open / area : 0.0;
    result.blocked[row] = area > 0.0 ? blocked / area : 0.0;
  }
  result.factors.close();
  return result;
}

double closure_error(const ViewFactors& view_factors) {
  double worst = 0.0;
  for (int i = 0; i < view_factors.row_count(); ++i) {
    const auto r = static_cast<std::size_t>(i);
    if (!(view_factors.area[r] > 0.0)) continue;
    double sum = view_factors.open[r] + view_factors.blocked[r];
    for (const auto [j, F] : view_factors.row(i)) sum += static_cast<double>(F);
    worst = std::max(worst, std::abs(1.0 - sum));
  }
  return worst;
}

double reciprocity_error(const ViewFactors& view_factors) {
  const RecordStore& rows = view_factors.factors.records();
  const auto share = [](const std::byte* record) {
    return record ? static_cast<double>(reinterpret_cast<const FormFactor*>(record)->value) : 0.0;
  };
  std::vector<double> worst(view_factors.area.size(), 0.0);
  for (const ColumnRange range : column_ranges(rows, rows.budget().block_bytes())) {
    const ColumnBlock block(rows, range.first, range.last);
    parallel_for(range.last - range.first, 16, [&](int low, int high) {
      for (int i = range.first + low; i < range.first + high; ++i) {
        const double A_i = view_factors.area[static_cast<std::size_t>(i)];
        double& worst_of_row = worst[static_cast<std::size_t>(i)];
        for_each_pair(i, rows.row(i), block.column(i),
                      [&](int j, const std::byte* there, const std::byte* back) {
                        const double A_j = view_factors.area[static_cast<std::size_t>(j)];
                        const double difference = std::abs(A_i * share(there) - A_j * share(back));
                        worst_of_row = std::max(worst_of_row, difference / std::min(A_i, A_j));
                      });
      }
    });
  }
  return worst.empty() ? 0.0 : *std::max_element(worst.begin(), worst.end());
}

double error_estimate(const FormFactorReport& report, const FormFactors& form_factors,
                      const PatchMesh& mesh, const std::vector<int>& row_of_patch) {
  int row_count = 0;
  for (const int row : row_of_patch) row_count = std::max(row_count, row + 1);
  std::vector<double> area(static_cast<std::size_t>(row_count), 0.0), squares = area, bias = area;
  std::vector<int> in_row(static_cast<std::size_t>(row_count), 0);
  for (int i = 0; i < form_factors.patch_count(); ++i) {
    const int row = row_of_patch[static_cast<std::size_t>(i)];
    if (row < 0) continue;
    int most = 1;
    const auto for_each_row = [&](auto visit) {
      for (const auto [j, F] : form_factors.row(i)) {
        const int to = row_of_patch[static_cast<std::size_t>(j)];
        if (to >= 0) visit(in_row[static_cast<std::size_t>(to)]);
      }
    };
    for_each_row([&](int& count) { most = std::max(most, ++count); });
    for_each_row([](int& count) { count = 0; });
    const auto error = static_cast<double>(report.row_error[static_cast<std::size_t>(i)]);
    double variance = most * error * error;
    if (!report.count_error.empty()) {
      const auto of_share = static_cast<double>(report.count_error[static_cast<std::size_t>(i)]);
      variance = std::min(variance, std::max(error * error, of_share * of_share));
    }
    area[static_cast<std::size_t>(row)] += mesh.area[i];
    squares[static_cast<std::size_t>(row)] += mesh.area[i] * mesh.area[i] * variance;
    if (report.row_bias.empty()) continue;
    bias[static_cast<std::size_t>(row)] +=
        mesh.area[i] * static_cast<double>(report.row_bias[static_cast<std::size_t>(i)]);
  }
  double worst = 0.0;
  for (std::size_t row = 0; row < area.size(); ++row) {
    if (!(area[row] > 0.0)) continue;
    worst = std::max(worst, (std::sqrt(squares[row]) + bias[row]) / area[row]);
  }
  return worst;
}

double mean_open_share(const ViewFactors& view_factors) {
  double open = 0.0, area = 0.0;
  for (std::size_t i = 0; i < view_factors.area.size(); ++i) {
    open += view_factors.area[i] * view_factors.open[i];
    area += view_factors.area[i];
  }
  return area > 0.0 ? open / area : 0.0;
}

}  // namespace lightwell
