#include "radiosity/form_factors/emitter_exchange.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "mesh/patches/patch_sampler.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/emitters/emitter.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
EmitterExchange::EmitterExchange(const ElementCaster& caster, const DirectLight& direct_light)
    : mesh_(caster.mesh()), caster_(caster), direct_light_(direct_light) {
  const auto& emitters = direct_light.emitters();
  std::vector<int> emitter_of_facet;
  for (std::size_t e = 0; e < emitters.size(); ++e) {
    const auto facet = static_cast<std::size_t>(emitters[e].facet);
    if (facet >= emitter_of_facet.size()) emitter_of_facet.resize(facet + 1, -1);
    emitter_of_facet[facet] = static_cast<int>(e);
  }
  // Every patch of an emitter is taken to have the mean of the whole emitter's form factor, which
  // is not so for the patches of a luminous ceiling.
  constexpr double largest_share = 0.25;
  double area = 0.0;
  for (int i = 0; i < mesh_.patch_count(); ++i) area += mesh_.is_back[i] ? 0.0 : mesh_.area[i];
  for (const Emitter& emitter : emitters) {
    is_left_to_rays_.push_back(emitter.area > largest_share * area ? 1 : 0);
  }
  emitter_of_.assign(static_cast<std::size_t>(mesh_.patch_count()), -1);
  own_row_ = emitter_of_;
  pictured_.resize(2 * emitters.size());
  for (int i = 0; i < mesh_.patch_count(); ++i) {
    const auto facet = static_cast<std::size_t>(mesh_.facet[mesh_.first_element[i]]);
    if (facet >= emitter_of_facet.size() || emitter_of_facet[facet] < 0) continue;
    const int e = emitter_of_facet[facet];
    if (is_left_to_rays_[e]) continue;
    const bool is_back = mesh_.is_back[i] != 0;
    if (is_back && !emitters[e].emits_both_sides) continue;
    if (!direct_light.owns(static_cast<int>(facet), is_back)) continue;
    emitter_of_[i] = e;
    lit_.push_back(i);
    if (!emitters[e].picture) continue;
    own_row_[i] = 2 * static_cast<int>(emitters.size()) + static_cast<int>(outline_.size());
    pictured_[2 * e + is_back].push_back(i);
    outline_.push_back(patch_outline(mesh_, i));
  }
}

int EmitterExchange::row_of_lit(int patch) const {
  return own_row_[patch] >= 0 ? own_row_[patch] : 2 * emitter_of_[patch] + mesh_.is_back[patch];
}

class EmitterExchange::Found {
 public:
  void add(int row, double S) { sum_[row] += S; }
  Row rows() const {
    Row result;
    for (const auto& [row, S] : sum_) {
      if (S > 0.0) result.push_back({row, static_cast<float>(S)});
    }
    return result;
  }

 private:
  std::map<int, double> sum_{};
};

// Adds the exchange area of a point of a patch with an emitter to the rows of the emitter's
// patches, each by its own form factor. All patches of the emitter are taken to be hidden alike.
void EmitterExchange::add_to_patches(int emitter, bool behind, const SurfacePoint& at,
                                     double exchange, Found& found) const {
  const std::vector<int>& lit = pictured_[2 * emitter + behind];
  const int first = 2 * static_cast<int>(direct_light_.emitters().size());
  std::vector<double> F;
  double sum = 0.0;
  for (const int j : lit) {
    const PatchOutline& outline = outline_[own_row_[j] - first];
    const Eigen::Vector3d to = outline.center - at.position;
    const double distance = to.norm();
    constexpr double far = 4.0;  // radii from which on the kernel at the middle is right to 2 %
    if (distance > far * outline.radius || !outline.is_polygon()) {
      const double kernel = std::max(0.0, to.dot(at.normal)) * std::abs(to.dot(outline.normal));
      F.push_back(mesh_.area[j] * kernel / std::pow(distance, 4.0));
    } else {
      F.push_back(std::numbers::pi *
                  std::abs(point_to_polygon(at.position, at.normal, outline.loops)));
    }
    sum += F.back();
  }
  for (std::size_t k = 0; k < lit.size() && sum > 0.0; ++k) {
    found.add(own_row_[lit[k]], exchange * F[k] / sum);
  }
}

// Adds what a point that stands for `area` exchanges with the emitters that it asks for.
void EmitterExchange::add_point(const SurfacePoint& at, std::uint64_t key, int number, double area,
                                const FormFactorOptions& options, Found& found) const {
  const double share = options.shadows.cluster_share;
  for (const auto& [e, chance, cluster] : direct_light_.chosen_emitters(
           at, random_key(key, static_cast<std::uint64_t>(number)), share)) {
    if (is_left_to_rays_[e]) continue;
    const Emitter& emitter = direct_light_.emitters()[e];
    const bool behind =
        !emitter.is_sphere && (at.position - emitter.loops[0][0]).dot(emitter.normal) < 0.0;
    ShadowOptions shadows = options.shadows;
    if (cluster >= 0) shadows.min_rays = shadows.max_rays = 1;
    const double exchange =
        area / chance *
        direct_light_.form_factor(
            emitter, caster_, {.at = at, .key = random_key(key, number, e), .shadows = shadows});
    if (!(exchange > 0.0)) continue;
    found.add(2 * e + behind, exchange);
    if (emitter.picture) add_to_patches(e, behind, at, exchange, found);
  }
}

EmitterExchange::Row EmitterExchange::row_of(int patch, const SobolPoints& sobol,
                                             const FormFactorOptions& options) const {
  const std::uint64_t key =
      random_key(static_cast<std::uint64_t>(patch), RandomPurpose::emitter_exchange_points);
  const PatchSampler sampler(mesh_, patch);
  Found found;
  for (int s = 0; s < sobol.count(); ++s) {
    const Eigen::Array4f u = sobol.point(s, key);
    const PatchPoint at = sampler.point(u[0], u[1]);
    add_point({at.position, at.normal, mesh_.facet[at.element]}, key, s,
              mesh_.area[patch] / sobol.count(), options, found);
  }
  return found.rows();
}

void EmitterExchange::compute(const std::vector<char>& receives, const FormFactorOptions& options,
                              const JournalPhase& phase) {
  from_.assign(static_cast<std::size_t>(mesh_.patch_count()), {});
  // Points that ask for clusters draw other members each; a quarter of the points keeps what a
  // patch with 10 000 emitters costs near to what one with 100 does.
  constexpr int fewer = 4;
  const int points = direct_light_.has_emitter_clusters()
                         ? std::max(1, options.emitter_points / fewer)
                         : options.emitter_points;
  const SobolPoints sobol(points);
  // About a second per slice, shadow rays included.
  constexpr int slice = 512, grain = 4;
  const int patches = mesh_.patch_count();
  const auto report_progress = [&](int block) {
    report(options.run.progress, "closed forms", static_cast<double>(block * slice) / patches);
  };
  phase.for_each_in_turn((patches + slice - 1) / slice, report_progress, [&](int block) {
    const int begin = block * slice, end = std::min(begin + slice, patches);
    if (recall_rows(phase, block, begin, end)) return;
    parallel_for(end - begin, grain, [&](int low, int high) {
      for (int i = begin + low; i < begin + high; ++i) {
        if (receives[i]) from_[i] = row_of(i, sobol, options);
      }
    });
    if (!phase.is_kept()) return;
    std::vector<int> counts;
    Row records;
    for (int i = begin; i < end; ++i) {
      counts.push_back(static_cast<int>(from_[i].size()));
      records.insert(records.end(), from_[i].begin(), from_[i].end());
    }
    phase.keep(block, counts, records);
  });
  turn_over();
}

// Rows `begin` to `end` - 1 from a block of the phase; false if the block was not kept.
bool EmitterExchange::recall_rows(const JournalPhase& phase, int block, int begin, int end) {
  std::vector<int> counts;
  Row records;
  if (!phase.recall(block, counts, records)) return false;
  auto next = records.begin();
  for (int i = begin; i < end; ++i) {
    const auto last = next + counts[static_cast<std::size_t>(i - begin)];
    from_[i].assign(next, last);
    next = last;
  }
  return true;
}

// Fills `to_` and `lit_of_row_`.
void EmitterExchange::turn_over() {
  const std::size_t rows = 2 * direct_light_.emitters().size() + outline_.size();
  lit_of_row_.assign(rows, {});
  for (const int j : lit_) lit_of_row_[static_cast<std::size_t>(row_of_lit(j))].push_back(j);
  to_.assign(rows, {});
  for (int i = 0; i < mesh_.patch_count(); ++i) {
    for (const auto& [row, S] : from_[i]) to_[static_cast<std::size_t>(row)].push_back({i, S});
  }
}

// Emitters without a picture have uniform radiosity, so each patch has a share in proportion to its
// area.
double EmitterExchange::share_of_emitter(int patch) const {
  if (own_row_[patch] >= 0) return 1.0;
  return mesh_.area[patch] / direct_light_.emitters()[emitter_of_[patch]].area;
}

// Exchange of two emitters is computed from both ends, and the mean keeps S symmetric.
void EmitterExchange::add_row(int i, std::vector<FormFactor>& row) const {
  const bool is_lit = emitter_of_[i] >= 0;
  std::vector<std::pair<int, double>> found;
  for (const auto& [number, S] : from_[i]) {
    for (const int j : lit_of_row_[static_cast<std::size_t>(number)]) {
      if (j <= i || (is_lit && emitter_of_[j] == emitter_of_[i])) continue;
      found.emplace_back(j, (is_lit ? 0.5 : 1.0) * static_cast<double>(S) * share_of_emitter(j));
    }
  }
  if (is_lit) {
    for (const auto& [j, S] : to_[static_cast<std::size_t>(row_of_lit(i))]) {
      if (j <= i || emitter_of_[j] == emitter_of_[i]) continue;
      found.emplace_back(
          j, (emitter_of_[j] >= 0 ? 0.5 : 1.0) * static_cast<double>(S) * share_of_emitter(i));
    }
  }
  std::ranges::stable_sort(found, {}, &std::pair<int, double>::first);
  for (std::size_t k = 0; k < found.size();) {
    const int j = found[k].first;
    double S = 0.0;
    for (; k < found.size() && found[k].first == j; ++k) S += found[k].second;
    if (static_cast<float>(S) > 0.0f) row.push_back({j, static_cast<float>(S)});
  }
}

}  // namespace lightwell
