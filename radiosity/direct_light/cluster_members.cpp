#include "radiosity/direct_light/cluster_members.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radiosity/emitters/emitter_shadows.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

bool sends_light_to(const Emitter& emitter, const SurfacePoint& at) {
  if (at.facet == emitter.facet) return false;
  if (emitter.is_sphere) {
    return (at.position - emitter.sphere.center).norm() > emitter.sphere.radius;
  }
  return emitter.emits_both_sides || (at.position - emitter.center).dot(emitter.normal) > 0.0;
}

// The form factor of an emitter whose sample point has this weight, see emitter_shadow_sample().
double form_factor_of(const Emitter& emitter, const Eigen::Vector3d& from, double weight) {
  if (!emitter.is_sphere) return weight * emitter.area * std::numbers::inv_pi;
  const double sine = emitter.sphere.radius / (emitter.sphere.center - from).norm();
  // 2 pi (1 - cos) sr of the cone over pi, without the difference of numbers near 1.
  return weight * 2.0 * sine * sine / (1.0 + std::sqrt(std::max(0.0, 1.0 - sine * sine)));
}

}  // namespace

bool is_member(const LightSample& sample, const LightList& lights) {
  return sample.cluster >= 0 &&
         !(lights.is_emitter(sample.light) && lights.emitters[sample.light].picture);
}

std::vector<MemberLight> member_lights(std::span<const LightSample> members,
                                       const LightList& lights, const ElementCaster& caster,
                                       const SurfacePoint& at, std::uint64_t key,
                                       const ShadowMedium& medium) {
  std::vector<MemberLight> result;
  std::vector<Ray> rays;
  result.reserve(members.size());
  rays.reserve(members.size());
  for (const auto& [light, chance, cluster] : members) {
    const std::uint64_t own = random_key(key, static_cast<std::uint64_t>(light));
    const double u = random_uniform(own), v = random_uniform(random_key(own, std::uint64_t{1}));
    ShadowSample sample;
    double F = 0.0;
    if (lights.is_emitter(light)) {
      const Emitter& emitter = lights.emitters[light];
      if (!sends_light_to(emitter, at)) continue;
      sample = emitter_shadow_sample(emitter, {}, at, u, v);
      F = form_factor_of(emitter, at.position, sample.weight);
    } else {
      sample = shadow_sample(lights.source(light), at, u, v);
      F = sample.weight;
    }
    if (!(F > 0.0)) continue;
    result.push_back(
        {.light = light, .cluster = cluster, .F = F / chance, .direction = sample.ray.direction});
    rays.push_back(sample.ray);
  }
  std::vector<std::uint8_t> blocked(rays.size());
  caster.occluded(rays, blocked);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const bool is_blocked = blocked[i] != 0;
    result[i].blocked = is_blocked || medium.absorbs() ? 1 : 0;
    if (medium.absorbs() || (is_blocked && medium.panes)) {
      result[i].passed = medium.passed(caster, rays[i], is_blocked);
    }
  }
  return result;
}

}  // namespace lightwell
