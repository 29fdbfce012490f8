#include "radiosity/form_factors/form_factor_assembly.h"

#include <algorithm>
#include <cmath>

#include "radiosity/form_factors/balance.h"
#include "radiosity/form_factors/exchange_matrix.h"
#include "radiosity/form_factors/specular_assembly.h"

namespace lightwell {
namespace {

using Eigen::ArrayXd;

class Assembly {
 public:
  Assembly(const PatchMesh& mesh, RowEstimates rows, KnownExchange known,
           const AssemblyOptions& options)
      : mesh_(mesh),
        n_(mesh.patch_count()),
        rows_(std::move(rows)),
        known_(std::move(known)),
        options_(options),
        S_(options.budget, n_),
        weight_(PerKind::Ones(n_, 2)),
        target_(ArrayXd::Zero(n_)),
        open_(target_) {
    for (int i = 0; i < n_; ++i) {
      if (!rows_.is_measured(i)) continue;
      target_[i] = mesh_.area[i] * (1.0 - rows_.specular(i));
      open_[i] = mesh_.area[i] * rows_.escaped(i);
    }
  }

  std::unique_ptr<FormFactors> build(FormFactorReport* report) {
    auto result = std::make_unique<StoredFormFactors>(options_.budget, n_, rows_.bands());
    result->squared_indices = options_.squared_index;
    FormFactorReport found;
    found.closed_forms = known_.S.record_count();
    join();
    note_corrections(found);
    if (options_.enforce_closure) {
      close_whole_rows();
      close_sampled_rows();
      close_all_rows();
      settle_rows(found);
    }
    store(*result, found);
    if (rows_.has_specular()) assemble_specular(mesh_, rows_, options_, entering_, *result);
    result->rows.close();
    result->specular.close();
    lightwell::report(options_.progress, "balance", 1.0);
    note_rays(found);
    if (report) *report = std::move(found);
    return result;
  }

 private:
  static constexpr double join_share = 0.3;  // approximate share of the time

  bool is_whole(int i) const { return known_.is_whole[static_cast<std::size_t>(i)] != 0; }

  // Both ends of a pair estimate S. The mean weighted by inverse variances has the least variance.
  void join() {
    const auto weight = [&](int i) {
      return static_cast<float>(rows_.inverse_variance(i) * mesh_.area[i]);
    };
    fold_symmetric(
        rows_.shares(),
        [&](int i, RecordSpan row, RecordSpan column) {
          std::vector<Exchange> joined;
          const auto known = known_.S.row(i);
          auto next = known.begin();
          const auto add_known_before = [&](int j) {
            for (; next != known.end() && next->patch < j; ++next) {
              joined.push_back(Exchange::of(next->patch, Exchange::known, next->value));
            }
          };
          for_each_pair(i, row, column, [&](int j, const std::byte* own, const std::byte* other) {
            add_known_before(j);
            const bool is_known = next != known.end() && next->patch == j;
            if (is_known || is_whole(i) || is_whole(j)) return;
            double sum = 0.0;
            if (own) sum += weight(i) * static_cast<double>(share(own));
            if (other) sum += weight(j) * static_cast<double>(share(other));
            joined.push_back(Exchange::of(
                j, Exchange::sampled,
                static_cast<float>(sum / (rows_.inverse_variance(i) + rows_.inverse_variance(j)))));
          });
          add_known_before(n_);
          S_.append(i, joined);
        },
        [&](int i) {
          known_.S.release(i);
          report(options_.progress, "balance", join_share * i / n_);
        });
    S_.close();
  }
  static float share(const std::byte* record) {
    return reinterpret_cast<const FormFactor*>(record)->value;
  }

  // Row sums of sampled and of known exchange at the present scaling, where patch j counts x_j.
  PerKind sums(const ArrayXd& x) {
    constexpr double most = 3 * 200;  // most steps of the three scalings
    report(options_.progress, "balance",
           join_share + (1.0 - join_share) * std::min(1.0, ++steps_ / most));
    return weight_ * S_.product(weight_.colwise() * x);
  }

  void note_corrections(FormFactorReport& found) {
    const ArrayXd sum = open_ + sums(ArrayXd::Ones(n_)).rowwise().sum();
    double total = 0.0;
    int counted = 0;
    for (int i = 0; i < n_; ++i) {
      if (!(target_[i] > 0.0)) continue;
      const double correction = std::abs(1.0 - sum[i] / target_[i]);
      found.max_closure_correction = std::max(found.max_closure_correction, correction);
      total += correction;
      ++counted;
    }
    found.mean_closure_correction = counted > 0 ? total / counted : 0.0;
  }

  // Closes rows that consist of closed forms alone, by one factor per patch. The correction of a
  // pair of such patches is shared between both.
  void close_whole_rows() {
    ArrayXd whole(n_);
    for (int i = 0; i < n_; ++i) whole[i] = is_whole(i) ? 1.0 : 0.0;
    if (!(whole > 0.0).any()) return;
    const ArrayXd fixed = whole * sums(1.0 - whole).col(Exchange::known);
    const ArrayXd wanted = whole * (target_ - open_);
    weight_.col(Exchange::known) = symmetric_scaling(
        [&](const ArrayXd& x) -> Eigen::ArrayXXd {
          return whole * sums(whole * x).col(Exchange::known);
        },
        fixed, wanted, options_.phase_of("balance of closed forms"));
  }

  // Scales the samples of a row to the part that closed forms leave.
  void close_sampled_rows() {
    const PerKind sum = sums(ArrayXd::Ones(n_));
    ArrayXd left = target_ - sum.col(Exchange::known), open = open_;
    for (int i = 0; i < n_; ++i) {
      if (is_whole(i)) left[i] = open[i] = 0.0;
    }
    // A bound on the scaling: few samples must not be stretched to fill a gap that closed forms
    // left.
    constexpr double most_stretch = 2.0;
    const ArrayXd has = open + sum.col(Exchange::sampled);
    ArrayXd least = has / most_stretch, most = has * most_stretch;
    for (int i = 0; i < n_; ++i) {
      const double slack = is_whole(i) ? 0.0 : ray_noise(i, has[i], left[i]);
      if (!(slack > 0.0)) continue;
      least[i] = std::min(least[i], has[i] - slack);
      most[i] = std::max(most[i], has[i] + slack);
      // No ray of the row found what the closed forms leave: it escapes.
      if (!(has[i] > 0.0)) open_[i] = open[i] = std::min(left[i], most[i]);
    }
    left = left.max(least).min(most);
    weight_.col(Exchange::sampled) = symmetric_scaling(
        [&](const ArrayXd& x) -> Eigen::ArrayXXd { return sums(x).col(Exchange::sampled); }, open,
        left, options_.phase_of("balance of samples"));
    for (int i = 0; i < n_; ++i) {
      if (!is_whole(i)) open_[i] *= weight_(i, Exchange::sampled);
    }
  }

  // Difference between what the rays of a row found, `has`, and what closed forms leave, `left`,
  // that the number of rays explains, m^2. 0 where the errors of the closed forms explain `left`,
  // or are unknown: then the rays say more.
  double ray_noise(int i, double has, double left) const {
    if (known_.error.empty() || !rows_.is_measured(i)) return 0.0;
    const double known_error = static_cast<double>(known_.error[static_cast<std::size_t>(i)]);
    if (!(left > mesh_.area[i] * known_error)) return 0.0;
    // Five standard errors of a count. Not one of n rays meets a share of 14 / n once in a million
    // rows.
    constexpr double deviations = 5.0, rare = 14.0;
    const double rays = rows_.rays(i), share = has / mesh_.area[i];
    return mesh_.area[i] * (deviations * std::sqrt(share / rays) + rare / rays);
  }

  void close_all_rows() {
    const ArrayXd d = symmetric_scaling(
        [&](const ArrayXd& x) -> Eigen::ArrayXXd { return sums(x).rowwise().sum(); }, open_,
        target_, options_.phase_of("balance"));
    weight_.colwise() *= d;
    open_ *= d;
  }

  // Brings rows that no scaling closes to their sums, so that energy is kept. Rows that are too
  // long get shorter; since each pair is scaled by the factors of both rows, which are at most 1,
  // no row gets longer. What rows then lack escapes, and is reported.
  void settle_rows(FormFactorReport& found) {
    constexpr double closed = 1e-6;
    const ArrayXd sum = open_ + sums(ArrayXd::Ones(n_)).rowwise().sum();
    ArrayXd shorter = ArrayXd::Ones(n_);
    bool is_closed = true;
    for (int i = 0; i < n_; ++i) {
      if (!rows_.is_measured(i)) continue;
      is_closed = is_closed && std::abs(sum[i] - target_[i]) <= closed * mesh_.area[i];
      // The target of a row of dimmed light alone is 0 but for rounding.
      if (sum[i] > std::max(target_[i], 0.0)) shorter[i] = std::max(target_[i], 0.0) / sum[i];
    }
    if (is_closed) return;
    weight_.colwise() *= shorter;
    open_ *= shorter;
    const ArrayXd left = target_ - open_ - sums(ArrayXd::Ones(n_)).rowwise().sum();
    found.lost_share.assign(static_cast<std::size_t>(n_), 0.0f);
    for (int i = 0; i < n_; ++i) {
      if (!rows_.is_measured(i) || !(left[i] > 0.0)) continue;
      open_[i] += left[i];
      found.lost_share[static_cast<std::size_t>(i)] = static_cast<float>(left[i] / mesh_.area[i]);
    }
  }

  void store(StoredFormFactors& result, FormFactorReport& found) {
    ArrayXd closure_error = ArrayXd::Zero(n_), reciprocity_error = closure_error;
    const BandArray& mirrored = options_.mirrored;
    if (mirrored.size() > 0) entering_.setZero(n_, mirrored.cols());
    found.closure_shift.assign(static_cast<std::size_t>(n_), 0.0f);
    S_.consume([&](int i, std::span<const Exchange> row) {
      std::vector<FormFactor> factors;
      factors.reserve(row.size());
      const auto escaped = static_cast<float>(open_[i] / mesh_.area[i]);
      double sum = rows_.specular(i) + escaped;
      for (const Exchange& e : row) {
        const int j = e.patch();
        const double S = e.value() * (weight_(i, e.kind()) * weight_(j, e.kind()));
        const auto F = static_cast<float>(S / mesh_.area[i]);
        if (!(F > 0.0f)) continue;
        factors.push_back({j, F});
        if (e.kind() == Exchange::known && !is_whole(i) && !is_whole(j)) {
          const double shift = std::abs(S - double{e.value()}) / mesh_.area[i];
          float& worst = found.closure_shift[static_cast<std::size_t>(i)];
          worst = std::max(worst, static_cast<float>(shift));
        }
        sum += F;
        if (mirrored.size() > 0) {
          entering_.row(i) += static_cast<double>(F) * mirrored.row(j).cast<double>();
        }
        // Row j computes its F_ji from the same S.
        const auto back = static_cast<float>(S / mesh_.area[j]);
        const double difference = std::abs(mesh_.area[i] * F - mesh_.area[j] * back);
        reciprocity_error[i] =
            std::max(reciprocity_error[i], difference / std::min(mesh_.area[i], mesh_.area[j]));
      }
      result.rows.append(i, factors);
      result.escaped_share.row(i) = escaped;
      if (rows_.is_measured(i)) closure_error[i] = std::abs(1.0 - sum);
    });
    found.max_closure_error = closure_error.maxCoeff();
    found.max_reciprocity_error = reciprocity_error.maxCoeff();
  }

  void note_rays(FormFactorReport& found) const {
    double cut = 0.0;
    int counted = 0;
    for (int i = 0; i < n_; ++i) {
      if (!rows_.is_measured(i)) continue;
      found.rays += static_cast<std::int64_t>(rows_.rays(i));
      if (rows_.has_specular()) cut += static_cast<double>(rows_.cut(i).mean());
      ++counted;
    }
    found.depth_cut = counted > 0 ? cut / counted : 0.0;
  }

  const PatchMesh& mesh_;
  int n_ = 0;
  RowEstimates rows_;
  KnownExchange known_;
  const AssemblyOptions& options_;
  int steps_ = 0;
  ExchangeMatrix S_;
  PerKind weight_;              // S_ij is scaled by weight_ of i and of j
  Eigen::ArrayXXd entering_{};  // share of row i that patches which also diffuse mirror at once
  ArrayXd target_, open_;  // wanted row sum, and its part that leaves the scene, both times A_i
};

}  // namespace

std::unique_ptr<FormFactors> assemble_form_factors(const PatchMesh& mesh, RowEstimates rows,
                                                   KnownExchange known,
                                                   const AssemblyOptions& options,
                                                   FormFactorReport* report) {
  return Assembly(mesh, std::move(rows), std::move(known), options).build(report);
}

}  // namespace lightwell
