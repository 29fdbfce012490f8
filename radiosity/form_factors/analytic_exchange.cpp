#include "radiosity/form_factors/analytic_exchange.h"

#include <algorithm>
#include <cmath>

#include "mesh/patches/patch_sampler.h"
#include "radiosity/closed_forms/pair_exchange.h"
#include "radiosity/visibility/pair_shafts.h"
#include "radiosity/visibility/shadow_rays.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

// Powers of 4, so that no goal straddles two sets.
constexpr int few_rays = 16, points_in_set = 1 << 14, most_rays = 1 << 18;
constexpr double usual_target = 1e-3;
constexpr double exact_target = 1e-6;  // error of F where visibility is exact
// S_ij and F_ij are each rounded to floats, by 2^-24 at most.
constexpr double rounding = 0x1p-23;

struct Visibility {
  double share = 1.0;
  double variance = 0.0;  // variance of the share
};

class PairVisibility {
 public:
  explicit PairVisibility(const PolygonPairs& pairs)
      : mesh_(pairs.caster.mesh()),
        caster_(pairs.caster),
        target_(pairs.target_error > 0.0 ? pairs.target_error : usual_target),
        sobol_(points_in_set),
        shafts_(pairs.caster, pairs.outlines) {
    samplers_.reserve(pairs.outlines.size());
    for (int i = 0; i < mesh_.patch_count(); ++i) samplers_.emplace_back(mesh_, i);
  }

  // Visibility of a pair by the first method that applies: empty shaft, exact, sampled. S:
  // unoccluded exchange area.
  Visibility between(int i, int j, double S) const {
    if (shafts_.is_hidden(i) || shafts_.is_hidden(j)) return {.share = 0.0};
    const double largest_form_factor = S / std::min(mesh_.area[i], mesh_.area[j]);
    if (shafts_.is_covered(i) || shafts_.is_covered(j)) return sampled(i, j, largest_form_factor);
    Between between;
    shafts_.find(i, j, between);
    if (between.is_nothing()) return {};
    const auto exact = shafts_.visible(i, j, between, S, std::min(exact_target, 0.1 * target_));
    if (exact) return {exact->value / S, exact->error * exact->error / (S * S)};
    return sampled(i, j, largest_form_factor);
  }

 private:
  // Kernel-weighted share of unblocked point pairs, with more pairs while the standard error of
  // F_ij is above the target.
  Visibility sampled(int i, int j, double largest_form_factor) const {
    ShadowTally tally;
    ShadowBatch batch(caster_, {&tally, 1});
    Visibility found;
    int count = 0;
    for (int goal = first_count(largest_form_factor); goal <= most_rays; goal *= 4) {
      for (; count < goal; ++count) batch.add(0, sample(i, j, count));
      batch.flush();
      if (!(tally.all > 0.0)) break;
      // If all n rays agree, the standard error is that of Laplace's rule of succession, 1 / (n +
      // 2): some part may have been missed.
      const double unanimous = 1.0 / (count + 2.0);
      found = {tally.share(), std::max(tally.variance(), unanimous * unanimous)};
      if (largest_form_factor * std::sqrt(found.variance) <= target_) break;
    }
    return found;
  }

  // Pairs of small form factors start with fewer rays.
  static int first_count(double largest_form_factor) {
    constexpr double matters = 0.01;
    return largest_form_factor > matters ? 4 * few_rays : few_rays;
  }

  ShadowSample sample(int i, int j, int count) const {
    const int set = count / sobol_.count();
    const std::uint64_t key =
        random_key(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j),
                   RandomPurpose::exchange_shadow_rays, static_cast<std::uint64_t>(set));
    const Eigen::Array4f u = sobol_.point(count - set * sobol_.count(), key);
    const PatchPoint a = samplers_[i].point(u[0], u[1]), b = samplers_[j].point(u[2], u[3]);
    const Vector3d way = b.position - a.position;
    const double squared = way.squaredNorm();
    const double cosines = std::max(0.0, a.normal.dot(way)) * std::max(0.0, -b.normal.dot(way));
    return {.ray = {.origin = a.position,
                    .direction = way,
                    .t_max = 1.0,
                    .origin_group = mesh_.facet[a.element],
                    .target_group = mesh_.facet[b.element]},
            .weight = squared > 0.0 ? cosines / (squared * squared) : 0.0};
  }

  const PatchMesh& mesh_;
  const ElementCaster& caster_;
  double target_;
  SobolPoints sobol_;
  PairShafts shafts_;
  std::vector<PatchSampler> samplers_;
};

// Exchange of patch i with patches j > i.
struct AnalyticRow {
  std::vector<FormFactor> entries{};  // S_ij; 0 where all rays were blocked, which is no proof
  std::vector<float> error{};         // error of S_ij from visibility, closed form and rounding
  std::vector<float> bound{};         // of the closed form's error
};

AnalyticRow analytic_row(const PolygonPairs& pairs, const PairExchange& closed_form,
                         const PairVisibility& visibility, int i) {
  AnalyticRow row;
  const int n = static_cast<int>(pairs.outlines.size());
  for (int j = i + 1; j < n; ++j) {
    if (!pairs.receives[j] || !pairs.outlines[j].is_polygon()) continue;
    const auto [unoccluded, bound] = closed_form.bounded(i, j);
    if (!(unoccluded > 0.0)) continue;
    const Visibility seen = visibility.between(i, j, unoccluded);
    if (!(seen.share > 0.0) && !(seen.variance > 0.0)) continue;
    const auto S = static_cast<float>(unoccluded * seen.share);
    const double error =
        unoccluded * std::sqrt(seen.variance) + bound * seen.share + rounding * double{S};
    row.entries.push_back({j, S});
    row.error.push_back(static_cast<float>(error));
    row.bound.push_back(static_cast<float>(bound * seen.share));
  }
  return row;
}

}  // namespace

void analytic_exchange(const PolygonPairs& pairs, const Progress& progress, AnalyticErrors errors,
                       const std::function<void(int, std::vector<FormFactor>&)>& take,
                       const JournalPhase& phase) {
  const PatchMesh& mesh = pairs.caster.mesh();
  const int n = mesh.patch_count();
  const PairVisibility visibility(pairs);
  const PairExchange closed_form(pairs.outlines, pairs.target_error > 0.0
                                                     ? 0.1 * pairs.target_error
                                                     : PairExchange::usual_error);
  // A row has up to n entries, so the slices of many patches are short.
  const int slice = std::clamp((1 << 21) / std::max(n, 1), 4, 64) * phase.processes();
  for (int begin = 0; begin < n; begin += slice) {
    // Row i has n - i pairs.
    const double left = static_cast<double>(n - begin) / n;
    const auto report_progress = [&] { report(progress, "form factors", 1.0 - left * left); };
    report_progress();
    const int size = std::min(slice, n - begin);
    std::vector<AnalyticRow> rows(static_cast<std::size_t>(size));
    const auto compute = [&](int low, int high) {
      for (int k = low; k < high; ++k) {
        const int i = begin + k;
        if (!pairs.receives[i] || !pairs.outlines[i].is_polygon()) continue;
        if (phase.recall(i, rows[k].entries, rows[k].error, rows[k].bound)) continue;
        rows[k] = analytic_row(pairs, closed_form, visibility, i);
        phase.keep(i, rows[k].entries, rows[k].error, rows[k].bound);
      }
    };
    phase.for_each({begin, size, 1}, compute, report_progress);
    for (int k = 0; k < size; ++k) {
      AnalyticRow& row = rows[k];
      for (std::size_t e = 0; e < row.entries.size(); ++e) {
        for (const int end : {begin + k, row.entries[e].patch}) {
          const float error = row.error[e] / static_cast<float>(mesh.area[end]);
          errors.worst[end] = std::max(errors.worst[end], error);
          errors.sum[end] += error;
          errors.bias[end] += row.bound[e] / static_cast<float>(mesh.area[end]);
        }
      }
      std::erase_if(row.entries, [](const FormFactor& f) { return !(f.value > 0.0f); });
      take(begin + k, row.entries);
    }
  }
  report(progress, "form factors", 1.0);
}

}  // namespace lightwell
