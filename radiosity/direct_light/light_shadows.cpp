#include "radiosity/direct_light/light_shadows.h"

#include <algorithm>
#include <cmath>

#include "radiosity/emitters/emitter_shadows.h"

namespace lightwell {
namespace {

// The number of occluding polygons up to which an exact share costs no more than `rays` rays; below
// 0: rays are always cheaper. A share behind n polygons takes the time of about 16 + 8 n rays,
// behind more than six polygons less.
int pieces_worth(int rays) {
  constexpr int rays_with_none = 16, rays_of_a_piece = 4, most = 24;
  return rays < rays_with_none ? -1 : std::min(rays / rays_of_a_piece, most);
}

}  // namespace

Spectrum pictured_light(const Emitter& emitter, const EmissionTree::View& view, double F) {
  return emitter.picture_scale.head<3>() * (view.light / F).cast<float>();
}

// Rays of all lights are cast together. A known share becomes the tally as it is.
std::vector<ShadowTally> cast_shadows(std::span<const LightShadow> shadows,
                                      const ElementCaster& caster, const SobolPoints& sobol,
                                      const SurfacePoint& at, const ShadowMedium& medium) {
  std::vector<ShadowTally> tallies(shadows.size());
  ShadowBatch batch(caster, tallies, medium);
  const auto add = [&](std::size_t i, int begin, int end) {
    for (int s = begin; s < end; ++s) {
      const Eigen::Array4f u = sobol.point(s, shadows[i].key);
      const LightShadow& shadow = shadows[i];
      batch.add(static_cast<int>(i),
                shadow.emitter
                    ? emitter_shadow_sample(*shadow.emitter, shadow.sampler, at, u[0], u[1],
                                            shadow.has_picture() ? &shadow.view : nullptr)
                    : shadow_sample(*shadow.source, at, u[0], u[1]));
    }
  };
  for (std::size_t i = 0; i < shadows.size(); ++i) {
    if (shadows[i].share) {
      tallies[i].all = 1.0;
      tallies[i].seen = *shadows[i].share;
    } else {
      add(i, 0, shadows[i].least);
    }
  }
  batch.flush();
  for (std::size_t i = 0; i < shadows.size(); ++i) {
    const LightShadow& shadow = shadows[i];
    // A body dims each ray by its own length, so that all rays differ.
    const bool needs_all = tallies[i].is_mixed() || shadow.by_expected_weight || medium.absorbs();
    if (shadow.share || !needs_all) continue;
    add(i, shadow.least, shadow.most);
  }
  batch.flush();
  for (std::size_t i = 0; i < shadows.size(); ++i) {
    const LightShadow& shadow = shadows[i];
    if (shadow.share || !shadow.by_expected_weight || !shadow.emitter || shadow.has_picture())
      continue;
    tallies[i].all = shadow.most * expected_emitter_weight(*shadow.emitter, shadow.sampler,
                                                           at.position, shadow.F);
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
