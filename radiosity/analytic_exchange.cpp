#include "radiosity/analytic_exchange.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "radiosity/pair_exchange.h"
#include "scene/parallel.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t shadow_rays_key = 21;  // purpose of random keys
constexpr int few_rays = 16, most_rays = 1024;
constexpr double usual_target = 1e-3;

struct Visibility {
  double share = 1.0;
  double variance = 0.0;  // of the share
};

class PairVisibility {
 public:
  PairVisibility(const ElementCaster& caster, const std::vector<PatchOutline>& outlines,
                 double target_error)
      : mesh_(caster.mesh()),
        caster_(caster),
        outlines_(outlines),
        target_(target_error > 0.0 ? target_error : usual_target),
        sobol_(most_rays) {
    samplers_.reserve(outlines.size());
    for (int i = 0; i < mesh_.patch_count(); ++i) samplers_.emplace_back(mesh_, i);
    is_convex_ = has_nothing_between();
  }

  // Kernel-weighted share of point pairs that see each other; more pairs while they leave F_ij more
  // uncertain than asked.
  Visibility between(int i, int j, double largest_form_factor) const {
    if (is_convex_) return {};
    std::array<Ray, most_rays> rays;
    std::array<double, most_rays> weight;
    std::array<std::uint8_t, most_rays> blocked;
    const std::uint64_t key =
        random_key(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j), shadow_rays_key);
    int done = 0;
    Visibility result;
    for (int count = first_count(largest_form_factor); count <= most_rays; count *= 4) {
      for (int s = done; s < count; ++s) {
        const Eigen::Array4f u = sobol_.point(s, key);
        const PatchPoint a = samplers_[i].point(u[0], u[1]), b = samplers_[j].point(u[2], u[3]);
        const Vector3d way = b.position - a.position;
        const double squared = way.squaredNorm();
        const double cosines = std::max(0.0, a.normal.dot(way)) * std::max(0.0, -b.normal.dot(way));
        weight[s] = squared > 0.0 ? cosines / (squared * squared) : 0.0;
        rays[s] = {.origin = a.position,
                   .direction = way,
                   .t_max = 1.0,
                   .origin_group = mesh_.facet[i],
                   .target_group = mesh_.facet[j]};
      }
      const auto fresh = static_cast<std::size_t>(count - done);
      caster_.occluded({rays.data() + done, fresh}, {blocked.data() + done, fresh});
      done = count;
      result = weighed(weight, blocked, done);
      if (largest_form_factor * std::sqrt(result.variance) <= target_) break;
    }
    return result;
  }

 private:
  // A pair that matters little need not be looked at closely before it is found to be mixed.
  static int first_count(double largest_form_factor) {
    constexpr double matters = 0.01;
    return largest_form_factor > matters ? 4 * few_rays : few_rays;
  }

  static Visibility weighed(const std::array<double, most_rays>& weight,
                            const std::array<std::uint8_t, most_rays>& blocked, int count) {
    double all = 0.0, seen = 0.0, squares = 0.0;
    for (int s = 0; s < count; ++s) {
      all += weight[s];
      squares += weight[s] * weight[s];
      if (!blocked[s]) seen += weight[s];
    }
    if (!(all > 0.0)) return {};
    const double share = seen / all;
    return {share, share * (1.0 - share) * squares / (all * all)};
  }

  // True if all patches lie before each other's planes, so that nothing can stand between two.
  bool has_nothing_between() const {
    if (std::any_of(outlines_.begin(), outlines_.end(),
                    [](const PatchOutline& o) { return !o.is_polygon(); })) {
      return false;
    }
    Eigen::AlignedBox3d box;
    for (const PatchOutline& o : outlines_) {
      for (const Vector3d& v : o.loops[0]) box.extend(v);
    }
    const double tolerance = 1e-7 * box.diagonal().norm();
    for (const PatchOutline& o : outlines_) {
      const double offset = o.normal.dot(o.loops[0][0]);
      for (const PatchOutline& other : outlines_) {
        for (const Vector3d& v : other.loops[0]) {
          if (o.normal.dot(v) < offset - tolerance) return false;
        }
      }
    }
    return true;
  }

  const PatchMesh& mesh_;
  const ElementCaster& caster_;
  const std::vector<PatchOutline>& outlines_;
  double target_;
  SobolPoints sobol_;
  std::vector<PatchSampler> samplers_;
  bool is_convex_ = false;
};

}  // namespace

KnownExchange analytic_exchange(const ElementCaster& caster,
                                const std::vector<PatchOutline>& outlines,
                                const std::vector<char>& receives, double target_error,
                                const Progress& progress, std::vector<float>& row_error) {
  const PatchMesh& mesh = caster.mesh();
  const int n = mesh.patch_count();
  const PairVisibility visibility(caster, outlines, target_error);
  const PairExchange closed_form(outlines);
  KnownExchange known;
  row_error.assign(static_cast<std::size_t>(n), 0.0f);
  // What visibility's noise does to S, by pair.
  struct Row {
    std::vector<SymmetricEntry> entries;
    std::vector<float> error;
  };
  constexpr int slice = 64;
  for (int begin = 0; begin < n; begin += slice) {
    // Row i has n - i pairs.
    const double left = static_cast<double>(n - begin) / n;
    report(progress, "form factors", 1.0 - left * left);
    const int size = std::min(slice, n - begin);
    std::vector<Row> rows(static_cast<std::size_t>(size));
    parallel_for(size, 1, [&](int low, int high) {
      for (int k = low; k < high; ++k) {
        const int i = begin + k;
        if (!receives[i] || !outlines[i].is_polygon()) continue;
        for (int j = i + 1; j < n; ++j) {
          if (!receives[j] || !outlines[j].is_polygon()) continue;
          const double unoccluded = closed_form.between(i, j);
          if (!(unoccluded > 0.0)) continue;
          const double F = unoccluded / std::min(mesh.area[i], mesh.area[j]);
          const Visibility seen = visibility.between(i, j, F);
          if (!(seen.share > 0.0)) continue;
          rows[k].entries.push_back({i, j, unoccluded * seen.share});
          rows[k].error.push_back(static_cast<float>(unoccluded * std::sqrt(seen.variance)));
        }
      }
    });
    for (const Row& row : rows) {
      for (std::size_t e = 0; e < row.entries.size(); ++e) {
        const auto [i, j, S] = row.entries[e];
        for (const int end : {i, j}) {
          const float error = row.error[e] / static_cast<float>(mesh.area[end]);
          row_error[end] = std::max(row_error[end], error);
        }
      }
      known.S.insert(known.S.end(), row.entries.begin(), row.entries.end());
    }
  }
  report(progress, "form factors", 1.0);
  return known;
}

}  // namespace lightwell
