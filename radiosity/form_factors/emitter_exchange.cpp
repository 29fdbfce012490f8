#include "radiosity/form_factors/emitter_exchange.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/patches/patch_sampler.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
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

// Adds the exchange area of a point of `patch` with an emitter to the rows of the emitter's
// patches, each by its own form factor. All patches of the emitter are taken to be hidden alike.
void EmitterExchange::add_to_patches(int emitter, bool behind, const SurfacePoint& at,
                                     double exchange, int patch) {
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
    exchange_(own_row_[lit[k]], patch) += exchange * F[k] / sum;
  }
}

void EmitterExchange::compute(const std::vector<char>& receives, const FormFactorOptions& options,
                              const JournalPhase& phase) {
  const auto emitter_count = static_cast<int>(direct_light_.emitters().size());
  exchange_.setZero(2 * emitter_count + static_cast<int>(outline_.size()), mesh_.patch_count());
  const SobolPoints sobol(options.emitter_points);
  // A fraction of a second per slice, shadow rays included.
  constexpr int form_factors_per_slice = 1 << 17;
  const int each = std::max(1, options.emitter_points * emitter_count);
  const int slice = std::max(16, form_factors_per_slice / each);
  const auto columns = [&](int begin, int size) {
    return std::tuple(std::span(exchange_.data() + begin * exchange_.rows(),
                                static_cast<std::size_t>(size * exchange_.rows())));
  };
  const auto report_progress = [&](int) { report(options.run.progress, "closed forms", 0.0); };
  const auto fill = [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      if (!receives[i]) continue;
      const std::uint64_t key =
          random_key(static_cast<std::uint64_t>(i), RandomPurpose::emitter_exchange_points);
      const PatchSampler sampler(mesh_, i);
      for (int s = 0; s < options.emitter_points; ++s) {
        const Eigen::Array4f u = sobol.point(s, key);
        const PatchPoint at = sampler.point(u[0], u[1]);
        for (int e = 0; e < emitter_count; ++e) {
          if (is_left_to_rays_[e]) continue;
          const Emitter& emitter = direct_light_.emitters()[e];
          const bool behind =
              !emitter.is_sphere && (at.position - emitter.loops[0][0]).dot(emitter.normal) < 0.0;
          const SurfacePoint point{at.position, at.normal, mesh_.facet[at.element]};
          const double exchange =
              mesh_.area[i] / options.emitter_points *
              direct_light_.form_factor(
                  emitter, caster_,
                  {.at = point, .key = random_key(key, s, e), .shadows = options.shadows});
          exchange_(2 * e + behind, i) += exchange;
          if (emitter.picture && exchange > 0.0) add_to_patches(e, behind, point, exchange, i);
        }
      }
    }
  };
  for_each_slice(phase, mesh_.patch_count(), slice, 16, columns, report_progress, fill);
}

// Emitters without a picture have uniform radiosity, so each patch has a share in proportion to its
// area.
double EmitterExchange::share_of_emitter(int patch) const {
  return mesh_.area[patch] / direct_light_.emitters()[emitter_of_[patch]].area;
}

// S_ij of two patches, at least one of which belongs to an emitter.
double EmitterExchange::between(int i, int j) const {
  const auto from = [&](int patch, int lit) {
    if (own_row_[lit] >= 0) return exchange_(own_row_[lit], patch);
    return exchange_(2 * emitter_of_[lit] + mesh_.is_back[lit], patch) * share_of_emitter(lit);
  };
  if (emitter_of_[i] == emitter_of_[j]) return 0.0;
  if (emitter_of_[i] < 0) return from(i, j);
  if (emitter_of_[j] < 0) return from(j, i);
  return 0.5 * (from(i, j) + from(j, i));  // computed from both ends; the mean keeps S symmetric
}

void EmitterExchange::add_row(int i, std::vector<FormFactor>& row) const {
  const auto add = [&](int j) {
    const auto S = static_cast<float>(between(i, j));
    if (S > 0.0f) row.push_back({j, S});
  };
  if (emitter_of_[i] >= 0) {
    for (int j = i + 1; j < mesh_.patch_count(); ++j) add(j);
  } else {
    for (auto j = std::upper_bound(lit_.begin(), lit_.end(), i); j != lit_.end(); ++j) add(*j);
  }
}

}  // namespace lightwell
