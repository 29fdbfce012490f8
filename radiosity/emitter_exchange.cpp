#include "radiosity/emitter_exchange.h"

#include <algorithm>

#include "mesh/patch_sampler.h"
#include "scene/parallel.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr std::uint64_t emitter_points_key = 3;  // purpose of random keys

}  // namespace

EmitterExchange::EmitterExchange(const ElementCaster& caster, const DirectLight& direct_light)
    : mesh_(caster.mesh()), caster_(caster), direct_light_(direct_light) {
  const auto& emitters = direct_light.emitters();
  std::vector<int> emitter_of_facet;
  for (std::size_t e = 0; e < emitters.size(); ++e) {
    const auto facet = static_cast<std::size_t>(emitters[e].facet);
    if (facet >= emitter_of_facet.size()) emitter_of_facet.resize(facet + 1, -1);
    emitter_of_facet[facet] = static_cast<int>(e);
  }
  emitter_of_.assign(static_cast<std::size_t>(mesh_.patch_count()), -1);
  for (int i = 0; i < mesh_.patch_count(); ++i) {
    const auto facet = static_cast<std::size_t>(mesh_.facet[i]);
    if (facet >= emitter_of_facet.size() || emitter_of_facet[facet] < 0) continue;
    const int e = emitter_of_facet[facet];
    if (!mesh_.is_back[i] || emitters[e].emits_both_sides) emitter_of_[i] = e;
  }
}

// exchange(2 e + side, i): from patch i to the front (0) or back (1) of emitter e, square metres.
Eigen::ArrayXXd EmitterExchange::from_points(const std::vector<char>& receives,
                                             const FormFactorOptions& options) const {
  const auto emitter_count = static_cast<int>(direct_light_.emitters().size());
  Eigen::ArrayXXd exchange = Eigen::ArrayXXd::Zero(2 * emitter_count, mesh_.patch_count());
  const SobolPoints sobol(options.emitter_points);
  parallel_for(mesh_.patch_count(), 16, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      if (!receives[i]) continue;
      const std::uint64_t key = random_key(static_cast<std::uint64_t>(i), emitter_points_key);
      const PatchSampler sampler(mesh_, i);
      for (int s = 0; s < options.emitter_points; ++s) {
        const Eigen::Array4f u = sobol.point(s, key);
        const PatchPoint at = sampler.point(u[0], u[1]);
        for (int e = 0; e < emitter_count; ++e) {
          const Emitter& emitter = direct_light_.emitters()[e];
          const bool behind =
              !emitter.is_sphere && (at.position - emitter.loops[0][0]).dot(emitter.normal) < 0.0;
          exchange(2 * e + behind, i) +=
              mesh_.area[i] / options.emitter_points *
              direct_light_.form_factor(emitter, caster_, at.position, at.normal, mesh_.facet[i],
                                        random_key(key, s, e), options.shadows);
        }
      }
    }
  });
  return exchange;
}

// An emitter's light is even, so its patches share it in proportion to their area.
KnownExchange EmitterExchange::exchange(const std::vector<char>& receives,
                                        const FormFactorOptions& options) const {
  const Eigen::ArrayXXd exchange = from_points(receives, options);
  const int n = mesh_.patch_count();
  const auto share_of_emitter = [&](int p) {
    return mesh_.area[p] / direct_light_.emitters()[emitter_of_[p]].area;
  };
  KnownExchange known;
  std::vector<int> lit;
  for (int p = 0; p < n; ++p) {
    known.is_whole.push_back(emitter_of_[p] >= 0);
    if (emitter_of_[p] >= 0) lit.push_back(p);
  }
  for (int i = 0; i < n; ++i) {
    for (const int p : lit) {
      const int e = emitter_of_[p];
      if (e == emitter_of_[i]) continue;
      double value = exchange(2 * e + mesh_.is_back[p], i) * share_of_emitter(p);
      if (emitter_of_[i] >= 0) {  // two emitters: both ends were computed, keep them equal
        if (p < i) continue;
        const double back = exchange(2 * emitter_of_[i] + mesh_.is_back[i], p);
        value = 0.5 * (value + back * share_of_emitter(i));
      }
      if (value > 0.0) known.S.push_back({i, p, value});
    }
  }
  return known;
}

}  // namespace lightwell
