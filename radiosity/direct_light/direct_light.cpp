#include "radiosity/direct_light/direct_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <utility>

#include "radiosity/direct_light/cluster_members.h"
#include "radiosity/direct_light/exact_shadows.h"
#include "radiosity/direct_light/light_shadows.h"
#include "radiosity/emitters/emission_tree.h"
#include "radiosity/emitters/emitter_point.h"
#include "radiosity/emitters/emitter_shadows.h"
#include "radiosity/emitters/find_emitters.h"
#include "radiosity/emitters/light_list.h"
#include "radiosity/emitters/solid_angle_sampler.h"
#include "radiosity/many_lights/light_sampler.h"
#include "radiosity/sky/sky_light.h"
#include "radiosity/visibility/absorbing_bodies.h"
#include "radiosity/visibility/shadow_rays.h"
#include "scene/random_purpose.h"
#include "scene/rays/float_rounding.h"
#include "scene/receiver_gain.h"

namespace lightwell {
namespace {

SkyEffort sky_effort(const ShadowOptions& options, const NoiseGoal& goal) {
  constexpr int fewest = 8, first_of = 8;
  const int most = options.sky_rays > 0 ? options.sky_rays : options.max_rays;
  const int first = options.sky_rays > 0 ? options.sky_rays / first_of : options.min_rays;
  return {.first = std::clamp(first, fewest, most_sky_rays),
          .most = std::clamp(most, fewest, most_sky_rays),
          .goal = goal};
}

}  // namespace

DirectLight::DirectLight(const Scene& scene, const PatchMesh& mesh, const EmitterChannels& channels,
                         const DirectLight* like)
    : DirectLight(scene, mesh, channels, like, like ? like->sky_ : nullptr) {
  if (!dome() || sky_) return;
  const auto sky = std::make_shared<SkyLight>(scene, ElementCaster(mesh));
  sky->find_all();
  sky_ = sky;
}

DirectLight::DirectLight(const Scene& scene, const ElementCaster& caster)
    : DirectLight(scene, caster.mesh(), {}, nullptr, nullptr) {
  if (dome()) sky_ = std::make_shared<const SkyLight>(scene, caster);
}

DirectLight::DirectLight(const Scene& scene, const PatchMesh& mesh, const EmitterChannels& channels,
                         const DirectLight* like, std::shared_ptr<const SkyLight> sky)
    : sky_(std::move(sky)),
      bases_(scene.materials),
      bands_(scene.bands.count()),
      samples_(most_probe_shadow_rays),
      panes_(scene) {
  const std::vector<FacetRef> facets = scene_facets(scene);
  const auto channel_of = [&](int facet) {
    return std::max(0, channels.of_surface[facets[facet].surface]);
  };
  LightList lights{.emitters = find_emitters(scene, facets, mesh,
                                             like ? std::span<const Emitter>(like->emitters())
                                                  : std::span<const Emitter>()),
                   .sources = lightwell::free_sources(scene, mesh.source_scale, channels.of_source),
                   .channel_count = std::max(1, static_cast<int>(channels.names.size()))};
  owned_.assign(facets.size(), Owned::nothing);
  first_column_.assign(facets.size(), 0);
  for (std::size_t f = 0; f < facets.size() && !channels.empty(); ++f) {
    first_column_[f] = bands_ * channel_of(static_cast<int>(f));
  }
  for (const Emitter& emitter : lights.emitters) {
    owned_[emitter.facet] = emitter.is_sphere ? Owned::front : Owned::whole;
    if (!channels.empty()) lights.channel_of_emitter.push_back(channel_of(emitter.facet));
  }
  lights_ = std::make_shared<const LightList>(std::move(lights));
  sampler_ = std::make_shared<const LightSampler>(lights_);
  exact_ = like ? like->exact_ : std::make_shared<const ExactShadows>(scene, mesh, emitters());
  if (like) bodies_ = like->bodies_;
  if (!like && MediumWalks(scene).absorbs()) {
    bodies_ = AbsorbingBodies::find(scene, ElementCaster(mesh));
  }
}

DirectLight::DirectLight(const Scene& scene, std::vector<FreeSource> sources,
                         std::shared_ptr<const AbsorbingBodies> bodies)
    : lights_(std::make_shared<const LightList>(LightList{.sources = std::move(sources)})),
      sampler_(std::make_shared<const LightSampler>(lights_)),
      bases_(scene.materials),
      bands_(scene.bands.count()),
      samples_(most_probe_shadow_rays),
      panes_(scene),
      bodies_(std::move(bodies)) {
  const std::size_t facets = scene_facets(scene).size();
  owned_.assign(facets, Owned::nothing);
  first_column_.assign(facets, 0);
}

double DirectLight::unoccluded_form_factor(const Emitter& emitter, const SurfacePoint& at) const {
  const auto& [point, normal, facet] = at;
  if (facet == emitter.facet) return 0.0;
  double F = 0.0;
  if (emitter.is_sphere) {
    F = point_to_sphere(point, normal, emitter.sphere.center, emitter.sphere.radius);
  } else {
    const double front = (point - emitter.loops[0][0]).dot(emitter.normal);
    if (!(front > 0.0) && !(emitter.emits_both_sides && front < 0.0)) return 0.0;
    // Surfaces that face one way see nothing of each other's fronts, whichever of two planes that
    // lie on each other rounding puts before the other.
    if (!emitter.emits_both_sides && normal.dot(emitter.normal) > parallel_cosine) return 0.0;
    F = std::abs(point_to_polygon(point, normal, emitter.loops));
  }
  // A smaller F is rounding: the emitter grazes the horizon or is seen edge-on.
  constexpr double nothing = 1e-12;
  return F > nothing ? F : 0.0;
}

double DirectLight::form_factor(const Emitter& emitter, const ElementCaster& caster,
                                const LightQuery& query) const {
  LightShadow shadow{
      .emitter = &emitter, .F = unoccluded_form_factor(emitter, query.at), .key = query.key};
  if (!(shadow.F > 0.0)) return 0.0;
  set_effort({&shadow, 1}, {0.0}, query.shadows);
  const std::less<const Emitter*> before;
  const std::vector<Emitter>& known = emitters();
  if (before(&emitter, known.data()) || !before(&emitter, known.data() + known.size())) {
    throw std::invalid_argument("an emitter of another DirectLight");
  }
  shadow.index = static_cast<int>(&emitter - known.data());
  find_share(*exact_, caster, query.at, shadow);
  return shadow.F * cast_shadows({&shadow, 1}, caster, samples_, query.at, {})[0].share();
}

std::optional<bool> DirectLight::sees(int light, const ElementCaster& caster,
                                      const SurfacePoint& at, double u, double v) const {
  const LightList& lights = *lights_;
  const ShadowSample sample =
      lights.is_emitter(light)
          ? emitter_shadow_sample(lights.emitters[light],
                                  SolidAngleSampler(lights.emitters[light], at.position), at, u, v)
          : shadow_sample(lights.source(light), at, u, v);
  if (!(sample.weight > 0.0)) return std::nullopt;
  return (passed(caster, sample.ray) > 0.0f).any();
}

Spectrum DirectLight::passed(const ElementCaster& caster, const Ray& ray) const {
  std::uint8_t blocked = 0;
  caster.occluded({&ray, 1}, {&blocked, 1});
  if (blocked == 0) return Spectrum::Ones(bands_);
  return panes_.empty() ? Spectrum(Spectrum::Zero(bands_)) : panes_.passed(caster, ray);
}

const std::vector<Emitter>& DirectLight::emitters() const {
  return lights_->emitters;
}

const std::vector<FreeSource>& DirectLight::free_sources() const {
  return lights_->sources;
}

int DirectLight::light_count() const {
  return lights_->count();
}

int DirectLight::channel_count() const {
  return lights_->channel_count;
}

const FreeSource* DirectLight::dome() const {
  const auto found = std::ranges::find_if(
      free_sources(), [](const FreeSource& source) { return source.is_dome(); });
  return found == free_sources().end() ? nullptr : &*found;
}

// The light of the sky's dome at scale 1; the scale is `full`.
SkyGlow DirectLight::dome_glow(const ElementCaster& caster, const LightQuery& query, double full,
                               std::uint64_t key) const {
  NoiseGoal goal = query.sky_noise;
  const ReceiverGain receiver{.base = query.base, .relief = query.relief};
  if (!goal.is_set() && query.shadows.is_one_ray()) {
    return {sky_->irradiance_by_one_ray(caster, query.at, key, receiver)};
  }
  if (full > 0.0) goal.irradiance /= full;
  return sky_->irradiance(caster, query.at, key, sky_effort(query.shadows, goal), receiver);
}

struct DirectLight::Shadows {
  std::vector<LightShadow> lights{};
  std::vector<ShadowTally> tallies{};
  std::vector<MemberLight> members{};
  std::optional<LightShadow> dome{};
};

// The light that F of an emitter without a picture, or the kernel of a source, multiplies.
Spectrum DirectLight::light_of(int light, const Eigen::Vector3d& point) const {
  return lights_->is_emitter(light) ? emitters()[light].exitance
                                    : light_towards(lights_->source(light), point);
}

// Lights above the horizon of a point and what their shadow rays find.
DirectLight::Shadows DirectLight::shadows(const ElementCaster& caster, const LightQuery& query,
                                          const std::vector<LightSample>& samples) const {
  const auto& [point, normal, facet] = query.at;
  const ShadowMedium medium{.panes = panes_.empty() ? nullptr : &panes_,
                            .absorption = bodies_ ? bodies_->around(caster, query.at) : nullptr};
  Shadows found;
  std::vector<LightSample> members;
  for (const LightSample& sample : samples) {
    const auto& [i, chance, cluster] = sample;
    if (is_member(sample, *lights_)) {
      members.push_back(sample);
      continue;
    }
    LightShadow shadow{.index = i,
                       .channel = lights_->channel(i),
                       .key = random_key(query.key, static_cast<std::uint64_t>(i)),
                       .chance = chance,
                       .cluster = cluster,
                       .by_expected_weight = query.one_stands_for_all};
    if (lights_->is_emitter(i)) {
      shadow.emitter = &emitters()[i];
    } else {
      shadow.source = &lights_->source(i);
    }
    if (shadow.source && shadow.source->is_dome()) {
      if (query.lights != Lights::all_but_dome) found.dome = shadow;
      continue;
    }
    shadow.F = shadow.emitter ? unoccluded_form_factor(*shadow.emitter, query.at)
                              : unoccluded_kernel(*shadow.source, point, normal);
    if (!(shadow.F > 0.0)) continue;
    if (shadow.source) shadow.pictured = light_towards(*shadow.source, point);
    if (shadow.emitter && shadow.emitter->picture) {
      shadow.view = shadow.emitter->picture->view(query.at, shadow.F);
      if (!shadow.has_picture()) continue;  // black as far as it is above the horizon
      shadow.pictured = pictured_light(*shadow.emitter, shadow.view, shadow.F);
    }
    found.lights.push_back(std::move(shadow));
  }
  found.members = member_lights(members, *lights_, caster, query.at, query.key, medium);
  std::vector<double> of_members(static_cast<std::size_t>(channel_count()), 0.0);
  for (const MemberLight& m : found.members) {
    of_members[static_cast<std::size_t>(lights_->channel(m.light))] +=
        m.F * light_of(m.light, point).mean();
  }
  set_effort(found.lights, std::move(of_members), query.shadows);
  for (LightShadow& shadow : found.lights) {
    if (!shadow.emitter) continue;
    if (medium.absorbs()) {
      shadow.sampler = SolidAngleSampler(*shadow.emitter, point);
    } else {
      find_share(*exact_, caster, query.at, shadow);
    }
  }
  found.tallies = cast_shadows(found.lights, caster, samples_, query.at, medium);
  return found;
}

namespace {

LightChoice choice_of(const LightQuery& query) {
  return {.at = query.at,
          .key = query.key,
          .lights = query.lights,
          .cluster_share = query.shadows.cluster_share,
          .many_lights = query.shadows.many_lights};
}

}  // namespace

// Asks the lights of a coarse cut by one shadow ray each. Empty if nothing hangs on the result.
std::optional<LightPilot> DirectLight::pilot(const ElementCaster& caster,
                                             const LightQuery& query) const {
  if (query.shadows.many_lights == ManyLights::all || !sampler_->has_clusters(query.lights)) {
    return std::nullopt;
  }
  LightQuery coarse = query;
  coarse.key = random_key(query.key, RandomPurpose::pilot_lights);
  coarse.shadows.min_rays = coarse.shadows.max_rays = 1;
  LightPilot pilot{.cut = sampler_->pilot_cut(choice_of(coarse))};
  const Shadows found = shadows(caster, coarse, pilot.cut.samples);
  std::vector<double> all(static_cast<std::size_t>(channel_count()), 0.0);
  pilot.light = all;
  const auto add = [&](int channel, double E, double arriving) {
    all[static_cast<std::size_t>(channel)] += E;
    pilot.light[static_cast<std::size_t>(channel)] += E * arriving;
  };
  for (std::size_t i = 0; i < found.lights.size(); ++i) {
    const LightShadow& s = found.lights[i];
    add(s.channel, s.F * s.light().mean() / s.chance, arriving_share(found.tallies[i]));
  }
  for (const MemberLight& m : found.members) {
    add(lights_->channel(m.light), m.F * light_of(m.light, query.at.position).mean(), m.arriving());
  }
  // A hundredth of the unobstructed light at least: a pilot may miss all that arrives, and clusters
  // that are small against nothing would be single lights.
  constexpr double least = 0.01;
  for (std::size_t c = 0; c < all.size(); ++c) {
    pilot.light[c] = std::max(pilot.light[c], least * all[c]);
  }
  return pilot;
}

// The pilot draws other members: a cut that follows from what it draws itself would be biased.
std::vector<LightSample> DirectLight::chosen_lights(const ElementCaster& caster,
                                                    const LightQuery& query) const {
  if (query.asked) return *query.asked;
  if (query.one_stands_for_all) return sampler_->one_of_each_channel(choice_of(query));
  const std::optional<LightPilot> found = pilot(caster, query);
  return sampler_->samples(choice_of(query), found ? &*found : nullptr);
}

bool DirectLight::has_emitter_clusters() const {
  return sampler_->has_emitter_clusters();
}

bool DirectLight::has_clusters() const {
  return sampler_->has_clusters(Lights::all);
}

int DirectLight::asked(const ElementCaster& caster, const LightQuery& query) const {
  return static_cast<int>(chosen_lights(caster, query).size());
}

std::vector<LightSample> DirectLight::chosen_emitters(const SurfacePoint& at, std::uint64_t key,
                                                      double share) const {
  return sampler_->emitters({.at = at, .key = key, .cluster_share = share});
}

template <class Add>
void DirectLight::for_each_light(const ElementCaster& caster, const LightQuery& query,
                                 EmitterVisibility* visibility, Add&& add) const {
  const ReceiverGain receiver{.base = query.base, .relief = query.relief};
  const auto [shadows, tallies, members, dome] =
      this->shadows(caster, query, chosen_lights(caster, query));
  if (visibility) *visibility = {};
  double drawn_noise2 = 0.0;
  if (dome) {
    const double full = dome->light().mean();
    const SkyGlow glow = dome_glow(caster, query, full, dome->key);
    add(dome->channel, dome->light(), glow.irradiance);
    drawn_noise2 = std::pow(full * glow.noise, 2);
  }
  // The difference of the two members of each cluster, W/m^2: both estimate half of its light.
  std::vector<double> of_clusters;
  const auto add_to_cluster = [&](int cluster, double E) {
    const auto number = static_cast<std::size_t>(cluster);
    of_clusters.resize(std::max(of_clusters.size(), number + 1), 0.0);
    of_clusters[number] = E - of_clusters[number];
  };
  for (const MemberLight& m : members) {
    const int channel = lights_->channel(m.light);
    const Spectrum light = light_of(m.light, query.at.position);
    const double F =
        receiver.is_plain() ? m.F : m.F * receiver.factor(m.direction, query.at.normal);
    if (m.blocked == 0) add(channel, light, static_cast<float>(F));
    if (m.passed.size() > 0) add(channel, light, Spectrum(static_cast<float>(F) * m.passed));
    if (visibility) add_to_cluster(m.cluster, F * m.arriving() * light.mean());
  }
  for (std::size_t i = 0; i < shadows.size(); ++i) {
    const LightShadow& s = shadows[i];
    const ShadowTally& tally = tallies[i];
    const double share = tally.share();
    const bool is_dimmed = tally.dimmed > 0.0;
    const double F =
        (receiver.is_plain() ? s.F : s.F * factor(s.index, query.at, receiver)) / s.chance;
    const bool by_picture = s.has_picture() && !s.share;
    Spectrum through;
    if (is_dimmed && by_picture) {
      through = static_cast<float>(F) * tally.share_of_picture(tally.through.cast<double>());
    } else if (is_dimmed) {
      through = static_cast<float>(F / tally.all) * tally.through;
    }
    if (share > 0.0 && by_picture) {
      add(s.channel, s.light(),
          Spectrum(static_cast<float>(F) * tally.share_of_picture(tally.pictured_seen)));
    } else if (share > 0.0) {
      add(s.channel, s.light(), static_cast<float>(F * share));
    }
    if (is_dimmed) add(s.channel, s.light(), through);
    if (!visibility) continue;
    if (s.cluster >= 0) {
      add_to_cluster(s.cluster, F * arriving_share(tally) * s.light().mean());
      continue;
    }
    const bool is_behind_panes = is_dimmed && !tally.is_mixed();
    if (!s.share && tally.is_mixed()) visibility->noisy += s.F * s.light().mean();
    constexpr int bits = 64;
    const std::uint64_t bit = s.index < bits ? std::uint64_t{1} << s.index : 0;
    if (share == 1.0 || is_behind_panes) visibility->whole |= bit;
    if (share == 0.0 && !is_dimmed) visibility->hidden |= bit;
  }
  if (!visibility) return;
  for (const double difference : of_clusters) drawn_noise2 += difference * difference;
  visibility->drawn_noise = std::sqrt(drawn_noise2);
}

Spectrum DirectLight::irradiance(const ElementCaster& caster, const LightQuery& query,
                                 EmitterVisibility* visibility) const {
  Spectrum E = Spectrum::Zero(bands_);
  for_each_light(caster, query, visibility,
                 [&](int, const Spectrum& light, const auto& F) { E += light * F; });
  return E;
}

void DirectLight::add_irradiance(const ElementCaster& caster, const LightQuery& query, float* E,
                                 EmitterVisibility* visibility) const {
  for_each_light(caster, query, visibility, [&](int channel, const Spectrum& light, const auto& F) {
    Eigen::Map<Eigen::ArrayXf>(E + channel * bands_, bands_) += light * F;
  });
}

}  // namespace lightwell
