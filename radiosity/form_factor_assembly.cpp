#include "radiosity/form_factor_assembly.h"

#include <algorithm>
#include <cmath>

namespace lightwell {
namespace {

class StoredFormFactors final : public FormFactors {
 public:
  int patch_count() const override { return static_cast<int>(first_.size()) - 1; }
  std::span<const FormFactor> row(int i) const override {
    return {entries_.data() + first_[i], entries_.data() + first_[i + 1]};
  }
  SpecularRow specular_row(int i) const override {
    if (specular_first_.empty()) return {};
    const auto begin = specular_first_[i], count = specular_first_[i + 1] - begin;
    const auto bands = specular_value_.cols();
    return {
        .patch = {specular_patch_.data() + begin, static_cast<std::size_t>(count)},
        .value = Eigen::Map<const BandArray>(specular_value_.data() + begin * bands, count, bands)};
  }
  Spectrum escaped(int i) const override { return escaped_.row(i).transpose(); }
  Spectrum absorbed_by_specular(int i) const override { return absorbed_.row(i).transpose(); }

  std::vector<std::int64_t> first_{0};
  std::vector<FormFactor> entries_;
  std::vector<std::int64_t> specular_first_;
  std::vector<int> specular_patch_;
  BandArray specular_value_;
  BandArray escaped_, absorbed_;  // patches x bands
};

// Works on symmetric exchange areas S_ij = A_i F_ij, band by band where light went by way of
// mirrors and glass.
class Assembly {
 public:
  Assembly(const PatchMesh& mesh, int bands, std::vector<EstimatedRow> rows,
           const KnownExchange& known, bool enforce_closure)
      : mesh_(mesh),
        rows_(std::move(rows)),
        n_(mesh.patch_count()),
        bands_(bands),
        known_(symmetric_rows(n_, known.S)),
        is_whole_(known.is_whole),
        enforce_closure_(enforce_closure) {
    is_whole_.resize(static_cast<std::size_t>(n_), 0);
    closed_forms_ = known_.first.back() / 2;
  }

  std::unique_ptr<FormFactors> build(FormFactorReport* report) {
    auto result = std::make_unique<StoredFormFactors>();
    result->escaped_.setZero(n_, bands_);
    result->absorbed_.setZero(n_, bands_);
    add_direct(*result);
    const bool has_specular = std::any_of(rows_.begin(), rows_.end(), [](const EstimatedRow& row) {
      return row.specular > 0.0 || !row.specular_patch.empty();
    });
    if (has_specular) add_specular(*result);
    if (report) fill_report(*result, *report);
    return result;
  }

 private:
  static void scale(float& value, double factor) { value = static_cast<float>(value * factor); }

  bool is_measured(int i) const { return rows_[i].trust > 0.0; }
  bool is_whole(int i) const { return is_whole_[i] != 0; }
  float weight(int i) const { return static_cast<float>(rows_[i].trust * mesh_.area[i]); }

  bool is_known(int i, int j) const {
    const auto begin = known_.column.begin() + known_.first[i];
    const auto end = known_.column.begin() + known_.first[i + 1];
    return std::binary_search(begin, end, j);
  }

  // S of the pairs that are not known. Both ends estimate it; the sum that gives each its trust has
  // the least variance.
  SparseRows sampled_exchange() {
    std::vector<std::vector<FormFactor>> arrivals(n_);  // transposed, ordered: weight times share
    for (int i = 0; i < n_; ++i) {
      if (is_whole(i)) continue;
      for (const FormFactor& f : rows_[i].shares) {
        if (!is_whole(f.patch)) arrivals[f.patch].push_back({i, weight(i) * f.value});
      }
    }
    std::size_t most = 0;
    for (const EstimatedRow& row : rows_) most += 2 * row.shares.size();
    SparseRows S;
    S.column.reserve(most);
    S.value.reserve(most);
    S.first.push_back(0);
    for (int i = 0; i < n_; ++i) {
      if (!is_whole(i)) {
        const auto add = [&](int j, double own, double other) {
          if (is_whole(j) || is_known(i, j)) return;
          S.column.push_back(j);
          S.value.push_back(
              static_cast<float>((weight(i) * own + other) / (rows_[i].trust + rows_[j].trust)));
        };
        merge(rows_[i].shares, arrivals[i], add);
        arrivals[i] = {};
        rows_[i].shares = {};  // by far the most of a row, and not needed again
      }
      S.first.push_back(static_cast<std::int64_t>(S.column.size()));
    }
    return S;
  }

  template <class Visit>
  static void merge(const std::vector<FormFactor>& a, const std::vector<FormFactor>& b,
                    Visit visit) {
    auto x = a.begin();
    auto y = b.begin();
    while (x != a.end() || y != b.end()) {
      const int patch =
          y == b.end() || (x != a.end() && x->patch <= y->patch) ? x->patch : y->patch;
      double own = 0.0, other = 0.0;
      if (x != a.end() && x->patch == patch) own = (x++)->value;
      if (y != b.end() && y->patch == patch) other = (y++)->value;
      visit(patch, own, other);
    }
  }

  void add_direct(StoredFormFactors& result) {
    SparseRows sampled = sampled_exchange();
    Eigen::ArrayXd target = Eigen::ArrayXd::Zero(n_), open = Eigen::ArrayXd::Zero(n_);
    for (int i = 0; i < n_; ++i) {
      if (!is_measured(i)) continue;
      target[i] = mesh_.area[i] * (1.0 - rows_[i].specular);
      open[i] = mesh_.area[i] * rows_[i].escaped;
    }
    note_corrections(sampled, target, open);
    if (enforce_closure_) {
      close_whole_rows(target, open);
      close_sampled_rows(sampled, target, open);
    }
    SparseRows all = joined(sampled);
    sampled = known_ = {};
    if (enforce_closure_) {
      const Eigen::ArrayXd d = symmetric_scaling(all, open, target);
      for (int i = 0; i < n_; ++i) {
        for (std::int64_t k = all.first[i]; k < all.first[i + 1]; ++k) {
          scale(all.value[k], d[i] * d[all.column[k]]);
        }
        open[i] *= d[i];
      }
    }
    store(result, all, open);
  }

  // A row of closed forms alone; one factor per patch closes it. Patches of that kind that see each
  // other share the correction.
  void close_whole_rows(const Eigen::ArrayXd& target, const Eigen::ArrayXd& open) {
    SparseRows& S = known_;
    SparseRows among;
    among.first.push_back(0);
    Eigen::ArrayXd fixed = Eigen::ArrayXd::Zero(n_), wanted = Eigen::ArrayXd::Zero(n_);
    for (int i = 0; i < n_; ++i) {
      for (std::int64_t k = S.first[i]; is_whole(i) && k < S.first[i + 1]; ++k) {
        if (is_whole(S.column[k])) {
          among.column.push_back(S.column[k]);
          among.value.push_back(S.value[k]);
        } else {
          fixed[i] += S.value[k];
        }
      }
      if (is_whole(i)) wanted[i] = target[i] - open[i];
      among.first.push_back(static_cast<std::int64_t>(among.column.size()));
    }
    const Eigen::ArrayXd c = symmetric_scaling(among, fixed, wanted);
    for (int i = 0; i < n_; ++i) {
      for (std::int64_t k = S.first[i]; k < S.first[i + 1]; ++k) {
        if (is_whole(i)) scale(S.value[k], c[i]);
        if (is_whole(S.column[k])) scale(S.value[k], c[S.column[k]]);
      }
    }
  }

  // What closed forms leave of a row is what its samples are scaled to.
  void close_sampled_rows(SparseRows& sampled, const Eigen::ArrayXd& target,
                          Eigen::ArrayXd& open) const {
    Eigen::ArrayXd left = target, sampled_open = open;
    for (int i = 0; i < n_; ++i) {
      if (is_whole(i)) left[i] = sampled_open[i] = 0.0;
      for (std::int64_t k = known_.first[i]; k < known_.first[i + 1]; ++k) {
        left[i] -= known_.value[k];
      }
    }
    // What little was sampled must not be stretched to fill a gap that closed forms left.
    constexpr double most_stretch = 2.0;
    Eigen::ArrayXd has = sampled_open;
    for (int i = 0; i < n_; ++i) {
      for (std::int64_t k = sampled.first[i]; k < sampled.first[i + 1]; ++k) {
        has[i] += sampled.value[k];
      }
    }
    left = left.max(has / most_stretch).min(has * most_stretch);
    const Eigen::ArrayXd d = symmetric_scaling(sampled, sampled_open, left);
    for (int i = 0; i < n_; ++i) {
      for (std::int64_t k = sampled.first[i]; k < sampled.first[i + 1]; ++k) {
        scale(sampled.value[k], d[i] * d[sampled.column[k]]);
      }
      if (!is_whole(i)) open[i] *= d[i];
    }
  }

  // Known and sampled exchange in one matrix, columns rising.
  SparseRows joined(const SparseRows& sampled) const {
    const SparseRows& known = known_;
    SparseRows all;
    all.first.reserve(static_cast<std::size_t>(n_) + 1);
    all.column.reserve(sampled.column.size() + known.column.size());
    all.value.reserve(all.column.capacity());
    all.first.push_back(0);
    for (int i = 0; i < n_; ++i) {
      std::int64_t a = sampled.first[i], b = known.first[i];
      while (a < sampled.first[i + 1] || b < known.first[i + 1]) {
        const bool from_known = a == sampled.first[i + 1] ||
                                (b < known.first[i + 1] && known.column[b] < sampled.column[a]);
        const SparseRows& source = from_known ? known : sampled;
        std::int64_t& at = from_known ? b : a;
        all.column.push_back(source.column[at]);
        all.value.push_back(source.value[at]);
        ++at;
      }
      all.first.push_back(static_cast<std::int64_t>(all.column.size()));
    }
    return all;
  }

  void store(StoredFormFactors& result, const SparseRows& S, const Eigen::ArrayXd& open) const {
    result.entries_.reserve(S.column.size());
    result.first_.reserve(static_cast<std::size_t>(n_) + 1);
    for (int i = 0; i < n_; ++i) {
      for (std::int64_t k = S.first[i]; k < S.first[i + 1]; ++k) {
        const auto F = static_cast<float>(S.value[k] / mesh_.area[i]);
        if (F > 0.0f) result.entries_.push_back({S.column[k], F});
      }
      result.first_.push_back(static_cast<std::int64_t>(result.entries_.size()));
      result.escaped_.row(i) = static_cast<float>(open[i] / mesh_.area[i]);
    }
  }

  void add_specular(StoredFormFactors& result) {
    // Join both directions: for each row the sorted union of its own and its arrivals' patches.
    std::vector<std::vector<std::pair<int, int>>> arrivals(n_);  // (from, row in its weights)
    for (int i = 0; i < n_; ++i) {
      for (int r = 0; r < static_cast<int>(rows_[i].specular_patch.size()); ++r) {
        arrivals[rows_[i].specular_patch[r]].push_back({i, r});
      }
    }
    std::vector<int> column;
    std::vector<std::int64_t> first{0};
    std::vector<float> values;
    for (int i = 0; i < n_; ++i) {
      const EstimatedRow& row = rows_[i];
      std::size_t a = 0, b = 0;
      while (a < row.specular_patch.size() || b < arrivals[i].size()) {
        const bool own = a < row.specular_patch.size() &&
                         (b == arrivals[i].size() || row.specular_patch[a] <= arrivals[i][b].first);
        const int j = own ? row.specular_patch[a] : arrivals[i][b].first;
        Spectrum sum = Spectrum::Zero(bands_);
        if (own)
          sum += row.specular_share.row(static_cast<Eigen::Index>(a++)).transpose() * weight(i);
        if (b < arrivals[i].size() && arrivals[i][b].first == j) {
          sum += rows_[j].specular_share.row(arrivals[i][b++].second).transpose() * weight(j);
        }
        const auto rate = static_cast<float>(rows_[i].trust + rows_[j].trust);
        column.push_back(j);
        for (int k = 0; k < bands_; ++k) values.push_back(sum[k] / rate);
      }
      first.push_back(static_cast<std::int64_t>(column.size()));
    }
    result.specular_first_ = first;
    result.specular_patch_ = column;
    result.specular_value_ = Eigen::Map<const BandArray>(
        values.data(), static_cast<Eigen::Index>(column.size()), bands_);
    if (enforce_closure_) balance_specular(result);
    for (int i = 0; i < n_; ++i) {
      if (!is_measured(i)) continue;
      result.escaped_.row(i) += rows_[i].specular_escaped.transpose();
      result.absorbed_.row(i) = (rows_[i].absorbed + rows_[i].cut).transpose();
    }
  }

  // Each band's exchange by way of specular surfaces keeps what the row's own rays measured in all.
  void balance_specular(StoredFormFactors& result) {
    SparseRows S{.first = result.specular_first_, .column = result.specular_patch_};
    S.value.resize(S.column.size());
    const Eigen::ArrayXd nothing = Eigen::ArrayXd::Zero(n_);
    for (int k = 0; k < bands_; ++k) {
      for (std::size_t e = 0; e < S.value.size(); ++e) {
        S.value[e] = result.specular_value_(static_cast<Eigen::Index>(e), k);
      }
      Eigen::ArrayXd target = nothing;
      for (int i = 0; i < n_; ++i) {
        if (!is_measured(i) || rows_[i].specular_share.rows() == 0) continue;
        target[i] = mesh_.area[i] * rows_[i].specular_share.col(k).cast<double>().sum();
      }
      const Eigen::ArrayXd d = symmetric_scaling(S, nothing, target);
      for (int i = 0; i < n_; ++i) {
        for (std::int64_t e = S.first[i]; e < S.first[i + 1]; ++e) {
          result.specular_value_(e, k) =
              static_cast<float>(d[i] * S.value[e] * d[S.column[e]] / mesh_.area[i]);
        }
      }
    }
  }

  void note_corrections(const SparseRows& sampled, const Eigen::ArrayXd& target,
                        const Eigen::ArrayXd& open) {
    double total = 0.0;
    int counted = 0;
    for (int i = 0; i < n_; ++i) {
      if (!(target[i] > 0.0)) continue;
      double sum = open[i];
      for (const SparseRows* S : {&sampled, static_cast<const SparseRows*>(&known_)}) {
        for (std::int64_t k = S->first[i]; k < S->first[i + 1]; ++k) sum += S->value[k];
      }
      const double correction = std::abs(1.0 - sum / target[i]);
      max_correction_ = std::max(max_correction_, correction);
      total += correction;
      ++counted;
    }
    mean_correction_ = counted > 0 ? total / counted : 0.0;
  }

  void fill_report(const StoredFormFactors& result, FormFactorReport& report) const {
    report.mean_closure_correction = mean_correction_;
    report.max_closure_correction = max_correction_;
    report.closed_forms = closed_forms_;
    report.rays = 0;
    report.max_closure_error = 0.0;
    double cut = 0.0;
    int counted = 0;
    for (int i = 0; i < n_; ++i) {
      if (!is_measured(i)) continue;
      report.rays += static_cast<std::int64_t>(rows_[i].rays);
      if (rows_[i].cut.size() > 0) cut += rows_[i].cut.mean();
      ++counted;
      double sum = rows_[i].specular;
      for (const FormFactor& f : result.row(i)) sum += f.value;
      const double specular_escaped =
          rows_[i].specular_escaped.size() > 0 ? rows_[i].specular_escaped[0] : 0.0;
      sum += result.escaped_(i, 0) - specular_escaped;
      report.max_closure_error = std::max(report.max_closure_error, std::abs(1.0 - sum));
    }
    report.depth_cut = counted > 0 ? cut / counted : 0.0;
    report.max_reciprocity_error = reciprocity_error(result);
  }

  double reciprocity_error(const StoredFormFactors& result) const {
    double worst = 0.0;
    for (int i = 0; i < n_; ++i) {
      for (const FormFactor& f : result.row(i)) {
        if (f.patch <= i) continue;
        const auto back = result.row(f.patch);
        const auto at =
            std::lower_bound(back.begin(), back.end(), i,
                             [](const FormFactor& entry, int p) { return entry.patch < p; });
        const double there = at != back.end() && at->patch == i ? at->value : 0.0;
        const double difference = mesh_.area[i] * f.value - mesh_.area[f.patch] * there;
        worst =
            std::max(worst, std::abs(difference) / std::min(mesh_.area[i], mesh_.area[f.patch]));
      }
    }
    return worst;
  }

  const PatchMesh& mesh_;
  std::vector<EstimatedRow> rows_;
  int n_ = 0, bands_ = 0;
  SparseRows known_;
  std::vector<char> is_whole_;
  bool enforce_closure_ = true;
  std::int64_t closed_forms_ = 0;
  double mean_correction_ = 0.0, max_correction_ = 0.0;
};

}  // namespace

std::unique_ptr<FormFactors> assemble_form_factors(const PatchMesh& mesh, int bands,
                                                   std::vector<EstimatedRow> rows,
                                                   const KnownExchange& known, bool enforce_closure,
                                                   FormFactorReport* report) {
  return Assembly(mesh, bands, std::move(rows), known, enforce_closure).build(report);
}

}  // namespace lightwell
