#include <algorithm>
#include <bit>
#include <cmath>

#include "radiosity/balance.h"
#include "radiosity/form_factors.h"
#include "radiosity/light_path.h"
#include "radiosity/ray_cast_rows.h"
#include "scene/parallel.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr std::uint64_t emitter_points_key = 3;  // purpose of random keys

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

// Assembles symmetric exchange areas S_ij = A_i F_ij from the rays of both ends, band by band where
// light went by way of mirrors and glass, puts closed forms in the place of counts for emitters,
// and balances.
class Assembly {
 public:
  Assembly(const Scene& scene, const ElementCaster& caster, const DirectLight& direct_light,
           const FormFactorOptions& options)
      : mesh_(caster.mesh()),
        caster_(caster),
        direct_light_(direct_light),
        options_(options),
        paths_(scene, caster, options.max_specular_depth),
        n_(mesh_.patch_count()),
        bands_(scene.bands.count()) {
    find_emitter_patches();
    rows_ = cast_rows(caster, paths_, ray_counts(), options.progress);
  }

  std::unique_ptr<FormFactors> build(FormFactorReport* report) {
    auto result = std::make_unique<StoredFormFactors>();
    result->escaped_.setZero(n_, bands_);
    result->absorbed_.setZero(n_, bands_);
    add_direct(*result);
    if (paths_.has_specular()) add_specular(*result);
    if (report) fill_report(*result, *report);
    return result;
  }

 private:
  // Which patches belong to the lit side of an emitter that DirectLight owns: -1, or the emitter's
  // number.
  void find_emitter_patches() {
    emitter_of_.assign(n_, -1);
    std::vector<int> emitter_of_facet;
    for (std::size_t e = 0; e < direct_light_.emitters().size(); ++e) {
      const int facet = direct_light_.emitters()[e].facet;
      if (facet >= static_cast<int>(emitter_of_facet.size()))
        emitter_of_facet.resize(facet + 1, -1);
      emitter_of_facet[facet] = static_cast<int>(e);
    }
    for (int i = 0; i < n_; ++i) {
      const int facet = mesh_.facet[i];
      if (facet >= static_cast<int>(emitter_of_facet.size()) || emitter_of_facet[facet] < 0)
        continue;
      const int e = emitter_of_facet[facet];
      if (!mesh_.is_back[i] || direct_light_.emitters()[e].emits_both_sides) emitter_of_[i] = e;
    }
  }

  std::vector<int> ray_counts() const {
    const int base = std::max(1, options_.rays_per_patch);
    std::vector<int> counts(n_, base);
    if (!paths_.has_specular()) return counts;
    for (int i = 0; i < n_; ++i) {
      if (emitter_of_[i] < 0) continue;
      const double share = mesh_.area[i] / direct_light_.emitters()[emitter_of_[i]].area;
      const auto wanted = static_cast<unsigned>(std::ceil(share * options_.rays_per_emitter));
      counts[i] = std::max(base, static_cast<int>(std::bit_ceil(std::max(1u, wanted))));
    }
    return counts;
  }

  double rays_per_area(int i) const { return rows_[i].rays / mesh_.area[i]; }

  // S of the sampled pairs. Both counts are Poisson-like around (rays per area) * S, so their sum
  // over the sum of the rates is the estimate of least variance.
  SparseRows sampled_exchange() const {
    std::vector<std::vector<RayCastRow::Count>> arrivals(n_);  // transposed counts, ordered
    for (int i = 0; i < n_; ++i) {
      if (emitter_of_[i] >= 0) continue;
      for (const auto& c : rows_[i].counts) {
        if (emitter_of_[c.patch] < 0) arrivals[c.patch].push_back({i, c.rays});
      }
    }
    SparseRows S;
    S.first.push_back(0);
    for (int i = 0; i < n_; ++i) {
      if (emitter_of_[i] < 0) {
        merge(rows_[i].counts, arrivals[i], [&](int j, int rays) {
          if (emitter_of_[j] >= 0) return;
          S.column.push_back(j);
          S.value.push_back(rays / (rays_per_area(i) + rays_per_area(j)));
        });
      }
      S.first.push_back(static_cast<std::int64_t>(S.column.size()));
    }
    return S;
  }

  template <class Visit>
  static void merge(const std::vector<RayCastRow::Count>& a,
                    const std::vector<RayCastRow::Count>& b, Visit visit) {
    auto x = a.begin();
    auto y = b.begin();
    while (x != a.end() || y != b.end()) {
      const int patch =
          y == b.end() || (x != a.end() && x->patch <= y->patch) ? x->patch : y->patch;
      int rays = 0;
      if (x != a.end() && x->patch == patch) rays += (x++)->rays;
      if (y != b.end() && y->patch == patch) rays += (y++)->rays;
      visit(patch, rays);
    }
  }

  // S_ip for receiver i and every patch p of the emitters' lit sides, from closed form times
  // visibility averaged over points of i. An emitter's light is even, so its patches share it in
  // proportion to their area.
  SparseRows emitter_exchange() const {
    const auto emitter_count = static_cast<int>(direct_light_.emitters().size());
    // exchange(i, 2 e + side): from i to the front (0) or back (1) of emitter e.
    Eigen::ArrayXXd exchange = Eigen::ArrayXXd::Zero(2 * emitter_count, n_);
    const SobolPoints sobol(options_.emitter_points);
    parallel_for(n_, 16, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        if (!paths_.is_diffuse(mesh_.facet[i])) continue;
        const std::uint64_t key = random_key(static_cast<std::uint64_t>(i), emitter_points_key);
        const PatchSampler sampler(mesh_, i);
        for (int s = 0; s < options_.emitter_points; ++s) {
          const Eigen::Array4f u = sobol.point(s, key);
          const PatchPoint at = sampler.point(u[0], u[1]);
          for (int e = 0; e < emitter_count; ++e) {
            const Emitter& emitter = direct_light_.emitters()[e];
            const bool behind =
                !emitter.is_sphere && (at.position - emitter.loops[0][0]).dot(emitter.normal) < 0.0;
            exchange(2 * e + behind, i) +=
                mesh_.area[i] / options_.emitter_points *
                direct_light_.form_factor(emitter, caster_, at.position, at.normal, mesh_.facet[i],
                                          random_key(key, s, e), options_.shadows);
          }
        }
      }
    });
    SparseRows S;
    S.first.push_back(0);
    std::vector<int> lit;
    for (int p = 0; p < n_; ++p) {
      if (emitter_of_[p] >= 0) lit.push_back(p);
    }
    for (int i = 0; i < n_; ++i) {
      for (int p : lit) {
        const int e = emitter_of_[p];
        if (p == i || e == emitter_of_[i]) continue;
        const double share = mesh_.area[p] / direct_light_.emitters()[e].area;
        double value = exchange(2 * e + mesh_.is_back[p], i) * share;
        if (emitter_of_[i] >= 0) {  // two emitters: both ends were computed, keep them equal
          const double back_share = mesh_.area[i] / direct_light_.emitters()[emitter_of_[i]].area;
          value = 0.5 * (value + exchange(2 * emitter_of_[i] + mesh_.is_back[i], p) * back_share);
        }
        if (value > 0.0) {
          S.column.push_back(p);
          S.value.push_back(value);
        }
      }
      S.first.push_back(static_cast<std::int64_t>(S.column.size()));
    }
    return S;
  }

  double first_hit_area(int i, int rays) const {
    return rows_[i].rays > 0 ? mesh_.area[i] * rays / rows_[i].rays : 0.0;
  }

  void add_direct(StoredFormFactors& result) {
    SparseRows sampled = sampled_exchange();
    SparseRows emitted = emitter_exchange();
    Eigen::ArrayXd target(n_), open(n_);
    for (int i = 0; i < n_; ++i) {
      target[i] = rows_[i].rays > 0 ? mesh_.area[i] - first_hit_area(i, rows_[i].specular) : 0.0;
      open[i] = first_hit_area(i, rows_[i].escaped);
    }
    note_corrections(sampled, emitted, target, open);
    const Eigen::ArrayXd c = close_emitters(emitted, target, open);

    // Receivers: what the emitters leave of the row is scaled.
    Eigen::ArrayXd left = target;
    for (int i = 0; i < n_; ++i) {
      if (emitter_of_[i] >= 0) {
        left[i] = 0.0;
        continue;
      }
      for (std::int64_t k = emitted.first[i]; k < emitted.first[i + 1]; ++k) {
        emitted.value[k] *= c[emitted.column[k]];
        left[i] -= emitted.value[k];
      }
    }
    Eigen::ArrayXd sampled_open = open;
    for (int i = 0; i < n_; ++i) {
      if (emitter_of_[i] >= 0) sampled_open[i] = 0.0;
    }
    const Eigen::ArrayXd d = symmetric_scaling(sampled, sampled_open, left);
    store_direct(result, sampled, emitted, c, d, open);
  }

  // An emitter's row is made of closed forms alone; one factor per emitter patch closes it.
  // Emitters that see each other share the correction.
  Eigen::ArrayXd close_emitters(const SparseRows& emitted, const Eigen::ArrayXd& target,
                                const Eigen::ArrayXd& open) const {
    std::vector<double> to_receivers(n_, 0.0);
    for (int i = 0; i < n_; ++i) {
      if (emitter_of_[i] >= 0) continue;
      for (std::int64_t k = emitted.first[i]; k < emitted.first[i + 1]; ++k) {
        to_receivers[emitted.column[k]] += emitted.value[k];
      }
    }
    SparseRows among;  // emitter to emitter
    among.first.push_back(0);
    Eigen::ArrayXd fixed = Eigen::ArrayXd::Zero(n_), wanted = Eigen::ArrayXd::Zero(n_);
    for (int i = 0; i < n_; ++i) {
      if (emitter_of_[i] >= 0) {
        for (std::int64_t k = emitted.first[i]; k < emitted.first[i + 1]; ++k) {
          among.column.push_back(emitted.column[k]);
          among.value.push_back(emitted.value[k]);
        }
        fixed[i] = to_receivers[i];
        wanted[i] = target[i] - open[i];
      }
      among.first.push_back(static_cast<std::int64_t>(among.column.size()));
    }
    return symmetric_scaling(among, fixed, wanted);
  }

  void store_direct(StoredFormFactors& result, const SparseRows& sampled, const SparseRows& emitted,
                    const Eigen::ArrayXd& c, const Eigen::ArrayXd& d, const Eigen::ArrayXd& open) {
    std::vector<std::vector<FormFactor>> from_emitter(n_);  // rows of emitters to receivers
    for (int i = 0; i < n_; ++i) {
      if (emitter_of_[i] >= 0) continue;
      for (std::int64_t k = emitted.first[i]; k < emitted.first[i + 1]; ++k) {
        const int p = emitted.column[k];
        from_emitter[p].push_back({i, static_cast<float>(emitted.value[k] / mesh_.area[p])});
      }
    }
    for (int i = 0; i < n_; ++i) {
      const bool is_emitter = emitter_of_[i] >= 0;
      const auto begin = result.entries_.size();
      for (std::int64_t k = sampled.first[i]; k < sampled.first[i + 1]; ++k) {
        const int j = sampled.column[k];
        push(result, i, j, d[i] * sampled.value[k] * d[j]);
      }
      for (std::int64_t k = emitted.first[i]; k < emitted.first[i + 1]; ++k) {
        const int p = emitted.column[k];
        push(result, i, p, emitted.value[k] * (is_emitter ? c[i] * c[p] : 1.0));
      }
      result.entries_.insert(result.entries_.end(), from_emitter[i].begin(), from_emitter[i].end());
      std::sort(result.entries_.begin() + static_cast<std::ptrdiff_t>(begin), result.entries_.end(),
                [](const FormFactor& a, const FormFactor& b) { return a.patch < b.patch; });
      result.first_.push_back(static_cast<std::int64_t>(result.entries_.size()));
      result.escaped_.row(i) =
          static_cast<float>(open[i] * (is_emitter ? 1.0 : d[i]) / mesh_.area[i]);
    }
  }

  void push(StoredFormFactors& result, int i, int j, double S) const {
    if (S > 0.0) result.entries_.push_back({j, static_cast<float>(S / mesh_.area[i])});
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
    std::vector<Spectrum> weight;  // of one row, summed over both directions
    std::vector<float> values;
    for (int i = 0; i < n_; ++i) {
      const RayCastRow& row = rows_[i];
      std::size_t a = 0, b = 0;
      while (a < row.specular_patch.size() || b < arrivals[i].size()) {
        const bool own = a < row.specular_patch.size() &&
                         (b == arrivals[i].size() || row.specular_patch[a] <= arrivals[i][b].first);
        const int j = own ? row.specular_patch[a] : arrivals[i][b].first;
        Spectrum sum = Spectrum::Zero(bands_);
        if (own) sum += row.specular_weight.row(static_cast<Eigen::Index>(a++)).transpose();
        if (b < arrivals[i].size() && arrivals[i][b].first == j) {
          sum += rows_[j].specular_weight.row(arrivals[i][b++].second).transpose();
        }
        const auto rate = static_cast<float>(rays_per_area(i) + rays_per_area(j));
        column.push_back(j);
        for (int k = 0; k < bands_; ++k) values.push_back(sum[k] / rate);
      }
      first.push_back(static_cast<std::int64_t>(column.size()));
    }
    result.specular_first_ = first;
    result.specular_patch_ = column;
    result.specular_value_ = Eigen::Map<const BandArray>(
        values.data(), static_cast<Eigen::Index>(column.size()), bands_);
    balance_specular(result);
    for (int i = 0; i < n_; ++i) {
      if (rows_[i].rays == 0) continue;
      const auto rays = static_cast<float>(rows_[i].rays);
      result.escaped_.row(i) += rows_[i].specular_escaped.transpose() / rays;
      result.absorbed_.row(i) = (rows_[i].absorbed + rows_[i].cut).transpose() / rays;
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
        if (rows_[i].rays == 0 || rows_[i].specular_weight.rows() == 0) continue;
        target[i] =
            mesh_.area[i] * rows_[i].specular_weight.col(k).cast<double>().sum() / rows_[i].rays;
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

  void note_corrections(const SparseRows& sampled, const SparseRows& emitted,
                        const Eigen::ArrayXd& target, const Eigen::ArrayXd& open) {
    double total = 0.0;
    int counted = 0;
    for (int i = 0; i < n_; ++i) {
      if (emitter_of_[i] >= 0 || !(target[i] > 0.0)) continue;
      double sum = open[i];
      for (std::int64_t k = sampled.first[i]; k < sampled.first[i + 1]; ++k)
        sum += sampled.value[k];
      for (std::int64_t k = emitted.first[i]; k < emitted.first[i + 1]; ++k)
        sum += emitted.value[k];
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
    double cut = 0.0;
    int counted = 0;
    for (int i = 0; i < n_; ++i) {
      if (rows_[i].rays == 0) continue;
      report.rays += rows_[i].rays;
      cut += rows_[i].cut.mean() / rows_[i].rays;
      ++counted;
      double sum = static_cast<double>(rows_[i].specular) / rows_[i].rays;
      for (const FormFactor& f : result.row(i)) sum += f.value;
      const double specular_escaped = rows_[i].specular_escaped[0] / rows_[i].rays;
      sum += result.escaped_(i, 0) - specular_escaped;
      report.max_closure_error = std::max(report.max_closure_error, std::abs(1.0 - sum));
    }
    report.depth_cut = counted > 0 ? cut / counted : 0.0;
  }

  const PatchMesh& mesh_;
  const ElementCaster& caster_;
  const DirectLight& direct_light_;
  const FormFactorOptions& options_;
  LightPaths paths_;
  int n_ = 0, bands_ = 0;
  std::vector<int> emitter_of_;  // per patch
  std::vector<RayCastRow> rows_;
  double mean_correction_ = 0.0, max_correction_ = 0.0;
};

}  // namespace

std::unique_ptr<FormFactors> ray_cast_form_factors(const Scene& scene, const ElementCaster& caster,
                                                   const DirectLight& direct_light,
                                                   const FormFactorOptions& options,
                                                   FormFactorReport* report) {
  return Assembly(scene, caster, direct_light, options).build(report);
}

}  // namespace lightwell
