#include "radiosity/direct_light/direct_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <utility>

#include "radiosity/emitters/emission_tree.h"
#include "radiosity/emitters/emitter_point.h"
#include "radiosity/emitters/emitter_shadows.h"
#include "radiosity/direct_light/exact_shadows.h"
#include "radiosity/emitters/find_emitters.h"
#include "radiosity/sky/sky_light.h"
#include "radiosity/emitters/solid_angle_sampler.h"
#include "radiosity/visibility/shadow_rays.h"
#include "scene/random_purpose.h"

namespace lightwell {
namespace {

// A light above a point's horizon: its unoccluded F, and the effort to find its visible share.
struct LightShadow {
  const Emitter* emitter = nullptr;    // or
  const FreeSource* source = nullptr;  // F is then its kernel
  SolidAngleSampler sampler{};
  int index = 0;
  double F = 0.0;
  int channel = 0;
  std::uint64_t key = 0;
  double chance = 1.0;            // by which the light was drawn
  int cluster = -1;               // see DirectLight::Choice
  int least = 0, most = 0;        // rays
  std::optional<double> share{};  // visible; empty: rays are needed
  EmissionTree::View view{};      // of an emitter that shines by a picture; else without parts
  // Mean exitance of what the point sees of the picture; of a source, what it sends to the point.
  Spectrum pictured{};

  bool has_picture() const { return !view.parts.empty(); }
  const Spectrum& light() const {
    if (pictured.size() > 0) return pictured;
    return emitter ? emitter->exitance : source->light;
  }
};

// Light of an emitter as a point sees all of it, over the emitter's form factor.
Spectrum pictured_light(const Emitter& emitter, const EmissionTree::View& view, double F) {
  return emitter.picture_scale.head<3>() * (view.light / F).cast<float>();
}

// Casts the rays of all lights together. A known share becomes the tally as it is.
std::vector<ShadowTally> cast_shadows(std::span<const LightShadow> shadows,
                                      const ElementCaster& caster, const SobolPoints& sobol,
                                      const SurfacePoint& at, const ClearPanes* panes) {
  std::vector<ShadowTally> tallies(shadows.size());
  ShadowBatch batch(caster, tallies, panes);
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
    if (!shadows[i].share && tallies[i].is_mixed()) add(i, shadows[i].least, shadows[i].most);
  }
  batch.flush();
  return tallies;
}

// Stratified rays to a shadow's edge have an error of n^(-3/4), so the error of the sum over lights
// with shares w of the light is least with rays in proportion to w^(4/5). Shares are taken within a
// channel, since other channels may be dimmed. Fewer than 8 first rays would often miss an occluder
// that hides only a part. A member of a cluster may miss it: the cluster gives little.
void set_effort(std::span<LightShadow> shadows, int channels, const ShadowOptions& options) {
  const auto light = [](const LightShadow& s) { return s.F * s.light().mean() / s.chance; };
  std::vector<double> most_light(channels, 0.0);
  for (const LightShadow& s : shadows) most_light[s.channel] += light(s);
  const int most = std::clamp(options.max_rays, 1, most_probe_shadow_rays);
  const int least = std::clamp(options.min_rays, 1, most);
  constexpr int first_rays = 8;
  for (LightShadow& s : shadows) {
    if (s.source && has_sharp_shadows(*s.source)) {
      s.least = s.most = 1;
      continue;
    }
    const double all = most_light[s.channel];
    const double effort = all > 0.0 ? std::pow(light(s) / all, 0.8) : 1.0;
    s.most = std::clamp(static_cast<int>(std::ceil(effort * most)), 1, most);
    const int fewest = s.cluster >= 0 ? 1 : std::min(first_rays, least);
    s.least = std::min(s.most, std::max(fewest, static_cast<int>(std::ceil(effort * least))));
  }
}

SkyEffort sky_effort(const ShadowOptions& options, const NoiseGoal& goal) {
  constexpr int fewest = 8, first_of = 8;
  const int most = options.sky_rays > 0 ? options.sky_rays : options.max_rays;
  const int first = options.sky_rays > 0 ? options.sky_rays / first_of : options.min_rays;
  return {.first = std::clamp(first, fewest, most_sky_rays),
          .most = std::clamp(most, fewest, most_sky_rays),
          .goal = goal};
}

// The number of occluding polygons up to which an exact share costs no more than `rays` rays; below
// 0: rays are always cheaper. A share behind n polygons takes the time of about 16 + 8 n rays,
// behind more than six polygons less.
int pieces_worth(int rays) {
  constexpr int rays_with_none = 16, rays_of_a_piece = 4, most = 24;
  return rays < rays_with_none ? -1 : std::min(rays / rays_of_a_piece, most);
}

// The share of a light that arrives, through clear panes as well, mean of the bands.
double arriving_share(const ShadowTally& tally) {
  const double through = tally.dimmed > 0.0 ? tally.through.mean() / tally.all : 0.0;
  return tally.share() + through;
}

// Finds the visible share of the light's emitter without rays, or else what its rays need.
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

}  // namespace

DirectLight::DirectLight(const Scene& scene, const PatchMesh& mesh, const EmitterChannels& channels,
                         const DirectLight* like)
    : free_sources_(lightwell::free_sources(scene, mesh.source_scale, channels.of_source)),
      bases_(scene.materials),
      bands_(scene.bands.count()),
      channel_count_(std::max(1, static_cast<int>(channels.names.size()))),
      samples_(most_probe_shadow_rays),
      panes_(scene) {
  if (dome()) sky_ = like ? like->sky_ : std::make_shared<const SkyLight>(scene, mesh);
  const std::vector<FacetRef> facets = scene_facets(scene);
  owned_.assign(facets.size(), Owned::nothing);
  first_column_.assign(facets.size(), 0);
  for (std::size_t f = 0; f < facets.size() && !channels.empty(); ++f) {
    first_column_[f] = bands_ * std::max(0, channels.of_surface[facets[f].surface]);
  }
  emitters_ =
      find_emitters(scene, facets, mesh,
                    like ? std::span<const Emitter>(like->emitters_) : std::span<const Emitter>());
  for (const Emitter& emitter : emitters_) {
    owned_[emitter.facet] = emitter.is_sphere ? Owned::front : Owned::whole;
  }
  exact_ = like ? like->exact_ : std::make_shared<const ExactShadows>(scene, mesh, emitters_);
  cluster_lights();
}

DirectLight::DirectLight(const Scene& scene, std::vector<FreeSource> sources)
    : free_sources_(std::move(sources)),
      bases_(scene.materials),
      bands_(scene.bands.count()),
      samples_(most_probe_shadow_rays),
      panes_(scene) {
  const std::size_t facets = scene_facets(scene).size();
  owned_.assign(facets, Owned::nothing);
  first_column_.assign(facets, 0);
  cluster_lights();
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
  set_effort({&shadow, 1}, 1, query.shadows);
  const std::less<const Emitter*> before;
  if (before(&emitter, emitters_.data()) ||
      !before(&emitter, emitters_.data() + emitters_.size())) {
    throw std::invalid_argument("an emitter of another DirectLight");
  }
  shadow.index = static_cast<int>(&emitter - emitters_.data());
  find_share(*exact_, caster, query.at, shadow);
  return shadow.F * cast_shadows({&shadow, 1}, caster, samples_, query.at, nullptr)[0].share();
}

std::optional<bool> DirectLight::sees(int light, const ElementCaster& caster,
                                      const SurfacePoint& at, double u, double v) const {
  const auto emitter_count = static_cast<int>(emitters_.size());
  const ShadowSample sample =
      light < emitter_count
          ? emitter_shadow_sample(emitters_[light],
                                  SolidAngleSampler(emitters_[light], at.position), at, u, v)
          : shadow_sample(free_sources_[light - emitter_count], at, u, v);
  if (!(sample.weight > 0.0)) return std::nullopt;
  return (passed(caster, sample.ray) > 0.0f).any();
}

Spectrum DirectLight::passed(const ElementCaster& caster, const Ray& ray) const {
  std::uint8_t blocked = 0;
  caster.occluded({&ray, 1}, {&blocked, 1});
  if (blocked == 0) return Spectrum::Ones(bands_);
  return panes_.empty() ? Spectrum(Spectrum::Zero(bands_)) : panes_.passed(caster, ray);
}

const FreeSource* DirectLight::dome() const {
  const auto found = std::find_if(free_sources_.begin(), free_sources_.end(),
                                  [](const FreeSource& source) { return source.is_dome(); });
  return found == free_sources_.end() ? nullptr : &*found;
}

// The light of the sky's dome at scale 1; the scale is `full`.
SkyGlow DirectLight::dome_glow(const ElementCaster& caster, const LightQuery& query, double full,
                               std::uint64_t key) const {
  NoiseGoal goal = query.sky_noise;
  if (!goal.is_set() && query.shadows.is_one_ray()) {
    return {sky_->irradiance_by_one_ray(caster, query.at, key, query.relief)};
  }
  if (full > 0.0) goal.irradiance /= full;
  return sky_->irradiance(caster, query.at, key, sky_effort(query.shadows, goal), query.relief);
}

double DirectLight::Receiver::factor(const Eigen::Vector3d& direction,
                                     const Eigen::Vector3d& normal) const {
  double result = base ? base->factor(direction.normalized().dot(normal)) : 1.0;
  if (relief) result *= relief->gain(direction);
  return result;
}

// Mean of the receiver's factor over four points of a light, by the light that they send.
double DirectLight::factor(int light, const SurfacePoint& at, const Receiver& receiver) const {
  const auto emitter_count = static_cast<int>(emitters_.size());
  const Emitter* emitter = light < emitter_count ? &emitters_[light] : nullptr;
  const SolidAngleSampler sampler =
      emitter ? SolidAngleSampler(*emitter, at.position) : SolidAngleSampler();
  double sum = 0.0, all = 0.0;
  for (const double u : {0.25, 0.75}) {
    for (const double v : {0.25, 0.75}) {
      const ShadowSample sample =
          emitter ? emitter_shadow_sample(*emitter, sampler, at, u, v)
                  : shadow_sample(free_sources_[light - emitter_count], at, u, v);
      if (!(sample.weight > 0.0)) continue;
      sum += sample.weight * receiver.factor(sample.ray.direction, at.normal);
      all += sample.weight;
    }
  }
  return all > 0.0 ? sum / all : 1.0;
}

// Light per channel that arrives at a point, with the receiver's factor and without, unoccluded.
Eigen::ArrayX2d DirectLight::light_with_factor(const SurfacePoint& at,
                                               const Receiver& receiver) const {
  Eigen::ArrayX2d sum = Eigen::ArrayX2d::Zero(channel_count_, 2);
  if (dome() && dome()->is_on()) return sum;
  constexpr int most = 64;
  const int step = std::max(1, (light_count() + most - 1) / most);
  const auto emitter_count = static_cast<int>(emitters_.size());
  for (int i = 0; i < light_count(); i += step) {
    const Emitter* emitter = i < emitter_count ? &emitters_[i] : nullptr;
    const FreeSource* source = emitter ? nullptr : &free_sources_[i - emitter_count];
    const double F = emitter ? unoccluded_form_factor(*emitter, at)
                             : unoccluded_kernel(*source, at.position, at.normal);
    if (!(F > 0.0)) continue;
    Spectrum light = emitter ? emitter->exitance : light_towards(*source, at.position);
    if (emitter && emitter->picture) {
      light = pictured_light(*emitter, emitter->picture->view(at, F), F);
    }
    const double E = F * static_cast<double>(light.mean());
    if (!(E > 0.0)) continue;
    const int channel = emitter ? first_column(emitter->facet) / bands_ : source->channel;
    sum.row(channel) += Eigen::Array2d(E * factor(i, at, receiver), E).transpose();
  }
  return sum;
}

double DirectLight::gain(const SurfacePoint& at, const Receiver& receiver) const {
  const Eigen::Array2d all = light_with_factor(at, receiver).colwise().sum();
  return all[1] > 0.0 ? all[0] / all[1] : 1.0;
}

double DirectLight::base_gain(const SurfacePoint& at, const CoatedBase& base) const {
  return gain(at, {.base = &base});
}

double DirectLight::relief_gain(const SurfacePoint& at, const ReliefSlope& relief) const {
  return gain(at, {.relief = &relief});
}

Eigen::ArrayXd DirectLight::base_gains(const SurfacePoint& at, const CoatedBase& base) const {
  const Eigen::ArrayX2d sum = light_with_factor(at, {.base = &base});
  return (sum.col(1) > 0.0).select(sum.col(0) / sum.col(1), 1.0);
}

struct DirectLight::Shadows {
  std::vector<LightShadow> lights{};
  std::vector<ShadowTally> tallies{};
  std::optional<LightShadow> dome{};
};

// Lights above the horizon of a point and what their shadow rays find.
DirectLight::Shadows DirectLight::shadows(const ElementCaster& caster, const LightQuery& query,
                                          const std::vector<double>& light) const {
  const auto& [point, normal, facet] = query.at;
  Shadows found;
  for (const auto& [i, chance, cluster] : chosen_lights(query, light)) {
    LightShadow shadow{.index = i,
                       .channel = channel_of(i),
                       .key = random_key(query.key, static_cast<std::uint64_t>(i)),
                       .chance = chance,
                       .cluster = cluster};
    if (is_emitter(i)) {
      shadow.emitter = &emitters_[i];
    } else {
      shadow.source = &source(i);
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
  set_effort(found.lights, channel_count_, query.shadows);
  for (LightShadow& shadow : found.lights) {
    if (shadow.emitter) find_share(*exact_, caster, query.at, shadow);
  }
  found.tallies =
      cast_shadows(found.lights, caster, samples_, query.at, panes_.empty() ? nullptr : &panes_);
  return found;
}

// The light of each channel that a point gets, about, W/m^2: that of a coarse cut with one shadow
// ray to each light. Empty if no lights of the query are clustered.
std::vector<double> DirectLight::pilot_light(const ElementCaster& caster,
                                             const LightQuery& query) const {
  bool has_clusters = false;
  for (int c = 0; c < channel_count_; ++c) {
    has_clusters = has_clusters || !trees_of(c, query.lights).empty();
  }
  const bool asks_all = query.shadows.many_lights == ManyLights::all;
  if (!has_clusters || query.one_stands_for_all || asks_all) return {};
  // A quarter of the clusters cost a quarter of the time, and a pilot that is off by a tenth makes
  // clusters off by a tenth.
  constexpr double coarser = 4.0;
  LightQuery pilot = query;
  pilot.key = random_key(query.key, RandomPurpose::pilot_lights);
  pilot.shadows = {
      .min_rays = 1, .max_rays = 1, .cluster_share = coarser * query.shadows.cluster_share};
  const Shadows found = shadows(caster, pilot, {});
  const auto channels = static_cast<std::size_t>(channel_count_);
  std::vector<double> seen(channels, 0.0), all(channels, 0.0);
  for (std::size_t i = 0; i < found.lights.size(); ++i) {
    const LightShadow& s = found.lights[i];
    const double E = s.F * s.light().mean() / s.chance;
    all[static_cast<std::size_t>(s.channel)] += E;
    seen[static_cast<std::size_t>(s.channel)] += E * arriving_share(found.tallies[i]);
  }
  // A hundredth of the unobstructed light at least: a pilot may miss all that arrives, and clusters
  // that are small against nothing would be single lights.
  constexpr double least = 0.01;
  for (std::size_t c = 0; c < channels; ++c) seen[c] = std::max(seen[c], least * all[c]);
  return seen;
}

template <class Add>
void DirectLight::for_each_light(const ElementCaster& caster, const LightQuery& query,
                                 EmitterVisibility* visibility, Add&& add) const {
  const Receiver receiver{.base = query.base, .relief = query.relief};
  // Clusters are small against the light that arrives, which may be a small part of all light. The
  // pilot draws other members: a cut that follows from what it draws itself would be biased.
  const auto [shadows, tallies, dome] = this->shadows(caster, query, pilot_light(caster, query));
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
      const auto cluster = static_cast<std::size_t>(s.cluster);
      of_clusters.resize(std::max(of_clusters.size(), cluster + 1), 0.0);
      of_clusters[cluster] = F * arriving_share(tally) * s.light().mean() - of_clusters[cluster];
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
