#include "radiosity/direct_light/light_shadows.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "radiosity/emitters/emitter_shadows.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// The number of occluding polygons up to which an exact share costs no more than `rays` rays; below
// 0: rays are always cheaper. A share behind n polygons takes the time of about 16 + 8 n rays,
// behind more than six polygons less.
int pieces_worth(int rays) {
  constexpr int rays_with_none = 16, rays_of_a_piece = 4, most = 24;
  return rays < rays_with_none ? -1 : std::min(rays / rays_of_a_piece, most);
}

// Rays of a light that are stratified among themselves.
struct RaySet {
  int cast = 0, most = 0;
  std::uint64_t key = 0;
};
using RaySets = std::array<RaySet, 2>;

// Two independent halves, each of which casts more than its first rays if the first of the *other*
// half disagree. Rays that decided on more of themselves would be right where they disagree, and
// 0 or 1 where a part of the emitter escapes them: too little light in an umbra's fringe, and too
// much in that of full light. One set where no decision is left.
RaySets ray_sets(const LightShadow& shadow, const ShadowMedium& medium) {
  if (shadow.share) return {};
  // A body dims each ray by its own length, so that all rays differ.
  const bool needs_all = shadow.by_expected_weight || medium.absorbs();
  const int first = needs_all ? shadow.most : shadow.least;
  constexpr int fewest_that_decide = 4;  // two of each half
  if (first == shadow.most || first < fewest_that_decide) {
    return {{{.cast = first, .most = first, .key = shadow.key}, {}}};
  }
  return {{{.cast = (first + 1) / 2, .most = (shadow.most + 1) / 2, .key = shadow.key},
           {.cast = first / 2, .most = shadow.most / 2, .key = random_key(shadow.key, 1)}}};
}

void add(const ShadowTally& part, double scale, ShadowTally& sum) {
  sum.all += scale * part.all;
  sum.seen += scale * part.seen;
  sum.squares += scale * scale * part.squares;
  sum.pictured += scale * part.pictured;
  sum.pictured_seen += scale * part.pictured_seen;
  sum.blocked = sum.blocked || part.blocked;
  if (!(part.dimmed > 0.0)) return;
  sum.dimmed += scale * part.dimmed;
  if (sum.through.size() == 0) sum.through = Spectrum::Zero(part.through.size());
  sum.through += static_cast<float>(scale) * part.through;
}

}  // namespace

Spectrum pictured_light(const Emitter& emitter, const EmissionTree::View& view, double F) {
  return emitter.picture_scale.head<3>() * (view.light / F).cast<float>();
}

// Rays of all lights are cast together. A known share becomes the tally as it is. Halves weigh
// alike, however many rays each has cast.
std::vector<ShadowTally> cast_shadows(std::span<const LightShadow> shadows,
                                      const ElementCaster& caster, const SobolPoints& sobol,
                                      const SurfacePoint& at, const ShadowMedium& medium) {
  std::vector<ShadowTally> tallies(shadows.size()), parts(2 * shadows.size());
  std::vector<RaySets> sets(shadows.size());
  ShadowBatch batch(caster, parts, medium);
  const auto cast = [&](std::size_t i, std::size_t half, int begin, int end) {
    const LightShadow& shadow = shadows[i];
    for (int s = begin; s < end; ++s) {
      const Eigen::Array4f u = sobol.point(s, sets[i][half].key);
      batch.add(static_cast<int>(2 * i + half),
                shadow.emitter
                    ? emitter_shadow_sample(*shadow.emitter, shadow.sampler, at, u[0], u[1],
                                            shadow.has_picture() ? &shadow.view : nullptr)
                    : shadow_sample(*shadow.source, at, u[0], u[1]));
    }
  };
  for (std::size_t i = 0; i < shadows.size(); ++i) {
    sets[i] = ray_sets(shadows[i], medium);
    for (const std::size_t half : {0, 1}) cast(i, half, 0, sets[i][half].cast);
  }
  batch.flush();
  for (std::size_t i = 0; i < shadows.size(); ++i) {
    const std::array<bool, 2> goes_on = {parts[2 * i + 1].is_mixed(), parts[2 * i].is_mixed()};
    for (const std::size_t half : {0, 1}) {
      RaySet& set = sets[i][half];
      if (!goes_on[half]) continue;
      cast(i, half, set.cast, set.most);
      set.cast = set.most;
    }
  }
  batch.flush();
  for (std::size_t i = 0; i < shadows.size(); ++i) {
    const LightShadow& shadow = shadows[i];
    ShadowTally& tally = tallies[i];
    if (shadow.share) {
      tally.all = 1.0;
      tally.seen = *shadow.share;
      continue;
    }
    for (const std::size_t half : {0, 1}) {
      const RaySet& set = sets[i][half];
      if (set.cast > 0) add(parts[2 * i + half], 1.0 * set.most / set.cast, tally);
    }
    if (shadow.by_expected_weight && shadow.emitter && !shadow.has_picture()) {
      tally.all = shadow.most *
                  expected_emitter_weight(*shadow.emitter, shadow.sampler, at.position, shadow.F);
    }
  }
  return tallies;
}

// Stratified rays to a shadow's edge have an error of n^(-3/4), so the error of the sum over lights
// with shares w of the light is least with rays in proportion to w^(4/5). Shares are taken within a
// channel, since other channels may be dimmed. Fewer than 8 first rays would often miss an occluder
// that hides only a part. A member of a cluster may miss it: the cluster gives little.
void set_effort(std::span<LightShadow> shadows, std::vector<double> other_light,
                const ShadowOptions& options) {
  const auto light = [](const LightShadow& s) { return s.F * s.light().mean() / s.chance; };
  std::vector<double>& all_light = other_light;
  for (const LightShadow& s : shadows) all_light[s.channel] += light(s);
  const int most = std::clamp(options.max_rays, 1, most_probe_shadow_rays);
  const int least = std::clamp(options.min_rays, 1, most);
  constexpr int first_rays = 8;
  for (LightShadow& s : shadows) {
    if (s.source && has_sharp_shadows(*s.source)) {
      s.least = s.most = 1;
      continue;
    }
    const double all = all_light[s.channel];
    const double effort = all > 0.0 ? std::pow(light(s) / all, 0.8) : 1.0;
    s.most = std::clamp(static_cast<int>(std::ceil(effort * most)), 1, most);
    const int fewest = s.cluster >= 0 ? 1 : std::min(first_rays, least);
    s.least = std::min(s.most, std::max(fewest, static_cast<int>(std::ceil(effort * least))));
  }
}

double arriving_share(const ShadowTally& tally) {
  const double through = tally.dimmed > 0.0 ? tally.through.mean() / tally.all : 0.0;
  return tally.share() + through;
}

void find_share(const ExactShadows& exact, const ElementCaster& caster, const SurfacePoint& at,
                LightShadow& shadow) {
  if (!caster.moves()) {
    shadow.share = exact.share(shadow.index, at, pieces_worth(shadow.most));
    // A part of the form factor does not say which part of the picture is visible.
    if (shadow.has_picture() && shadow.share && *shadow.share != 0.0 && *shadow.share != 1.0) {
      shadow.share.reset();
    }
  }
  if (!shadow.share) shadow.sampler = SolidAngleSampler(*shadow.emitter, at.position);
}

}  // namespace lightwell
