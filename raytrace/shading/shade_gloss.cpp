// Steps of RayTree at rough surfaces.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "radiosity/emitters/emitter_point.h"
#include "raytrace/shading/shade.h"
#include "scene/found_by_chance.h"
#include "scene/optics.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Returns whether a direction lies on one side of a facet and on the other side of the smooth
// surface that the facet approximates. Light from there would come through the facet.
bool crosses_facet_alone(const Eigen::Vector3d& direction, const Eigen::Vector3d& smooth,
                         const Eigen::Vector3d& flat) {
  return (direction.dot(smooth) < 0.0) != (direction.dot(flat) < 0.0);
}

}  // namespace

// Number of directions of a rough surface's lobe. A coat gets as many as a mirror where it mirrors
// 1/32 of the light; fewer than four would not limit each other's light of lamps, and more than
// sixteen times as many are worth it for no share. (A picture sees a coat once, a rough mirror in
// many samples.) On a varnished floor below windows a quarter of these left twice the noise, and
// saved a quarter of the picture's time. The number does not follow the light that the first
// directions find: where they miss a window by chance, few directions would do by their own
// judgement, and a picture came out 6 % too dark (Kirk & Arvo 1991).
int RayTree::lobe_samples(const SurfaceInteraction& interaction, const Branch& branch,
                          const TreeState& state) const {
  const double of_mirrors = double{state.effort} * options_.glossy_rays;
  double wanted = of_mirrors;
  if (interaction.material.mirrors_by_coat()) {
    constexpr double fewest = 4.0, most = 16.0, whole_share = 1.0 / 32.0;
    const double share = double{branch.weight.maxCoeff()} * double{mirrored_share(interaction)};
    wanted =
        std::clamp(share / whole_share * of_mirrors, fewest, std::max(fewest, most * of_mirrors));
  }
  return std::max(1, static_cast<int>(std::lround(wanted)));
}

// Adds the mean over sampled directions of a rough surface's lobe.
void RayTree::scatter(const Branch& branch, const SurfaceInteraction& interaction,
                      const ElementHit& hit, const ShadingPoint& at, TreeState& state) const {
  const bool is_coat = interaction.material.mirrors_by_coat();
  state.result.sees_gloss = state.result.sees_gloss || (branch.is_sharp && !is_coat);
  if (!state.shades) return;
  const bool is_first = branch.is_sharp && !state.number && !state.lamps_alone;
  const int count = is_first ? lobe_samples(interaction, branch, state) : 1;
  // Samples of a coat that lies behind another one belong to a sample of that.
  const bool collects = is_coat && count > 1 && !state.by_chance;
  std::vector<Spectrum> found;
  const Spectrum before = collects ? state.result.radiance : Spectrum();
  const int first = state.number.value_or(0);
  const std::uint64_t key = random_key(state.gloss_key, branch.node, RandomPurpose::gloss,
                                       static_cast<std::uint64_t>(first / gloss_point_count));
  // Typical number of samples of one point in a picture.
  constexpr int usual_samples = 64;
  BrightPatches::View view;
  const bool is_weak = is_coat && branch.behind_coat > 0;
  if (!state.lamps_alone && !bright_.is_empty() && !interaction.material.dielectric && !is_weak) {
    view = bright_.view(at.position, interaction.normal, usual_samples);
  }
  const SkySites::Site* const sky = sky_site(branch, interaction, hit, at, state);
  const LobeView lobe_view(at.position, interaction,
                           lobe(facets_[hit.facet].material, hit.from_back));
  for (int i = 0; i < count; ++i) {
    const int index = (first + i) % gloss_point_count;
    const auto sample_key = random_key(key, static_cast<std::uint64_t>(index));
    const Eigen::Array4d u = gloss_points_.point(index, key).cast<double>();
    ScatteringSample sample =
        sample_lobe(interaction, {.component = u[2], .u = u[0], .v = u[1], .key = sample_key});
    sample.weight /= static_cast<float>(count);
    sample.density =
        lobe(facets_[hit.facet].material, hit.from_back).density(interaction, sample.direction);
    const Eigen::Array4d lamp_u =
        gloss_points_.point(index, random_key(key, RandomPurpose::gloss_lamps)).cast<double>();
    add_lamp(branch, interaction, lobe_view, hit, at, lamp_u, 1.0f / static_cast<float>(count),
             state);
    add_free_source(branch, interaction, lobe_view, hit, at, lamp_u,
                    1.0f / static_cast<float>(count), state);
    if (!view.is_empty()) {
      const Eigen::Array4d bright_u =
          gloss_points_.point(index, random_key(key, RandomPurpose::gloss_patches)).cast<double>();
      add_bright_patch(branch, interaction, hit, at, view, bright_u,
                       1.0f / static_cast<float>(count), state);
    }
    if (sky) {
      const Eigen::Array4d sky_u =
          gloss_points_.point(index, random_key(key, RandomPurpose::gloss_patches, 1))
              .cast<double>();
      add_sky(branch, interaction, hit, at, *sky, sky_u, 1.0f / static_cast<float>(count), state);
    }
    // The number of the branch is the same in all samples of one key, so that their Sobol points
    // stay spread over surfaces behind this one as well.
    const auto node = random_key(branch.node, RandomPurpose::gloss, static_cast<std::uint64_t>(i),
                                 sample.crosses);
    Branch spread = branch;
    spread.is_sharp = false;
    spread.lobe = &lobe_view;
    spread.bright = view.is_empty() ? nullptr : &view;
    spread.sky = sky;
    if (collects) {
      state.by_chance = &found.emplace_back(Spectrum::Zero(scene_.bands.count()));
    }
    grow(spread, node, sample, interaction.material, hit, at, state);
    if (collects) state.by_chance = nullptr;
  }
  if (collects) add_found_by_chance(found, state.result.radiance - before, state);
}

// Adds the light of lamps that the samples of a coat's lobe found by chance. `other` is the light
// that the whole lobe found besides.
void RayTree::add_found_by_chance(const std::vector<Spectrum>& found, const Spectrum& other,
                                  TreeState& state) const {
  // A single bright sample of a dark lobe goes.
  constexpr float of_other_light = 2.0f;
  add_specular(limited_sum(found, static_cast<int>(found.size()), of_other_light * other.mean()),
               state.result);
}

void RayTree::add_specular(const Spectrum& light, RaySample& sample) const {
  sample.radiance += light;
  if (!with_layers_) return;
  sample.layers.segment<3>(first_sampled_column(Layer::specular)) +=
      linear_rgb(scene_.bands, light);
}

// Adds light of a lamp off a rough surface.
void RayTree::add_reflected(const Branch& branch, const Spectrum& seen, TreeState& state) const {
  if (is_by_chance(branch, state)) {
    *state.by_chance += seen;
    return;
  }
  add_specular(seen, state.result);
}

const RoughLobe& RayTree::lobe(int material, bool from_back) const {
  return *lobes_[static_cast<std::size_t>(material)][from_back ? 1 : 0];
}

// Factor, per band, of the radiance that a sample of a rough surface reads.
Spectrum RayTree::radiance_weight(const SurfaceInteraction& interaction,
                                  const ScatteringSample& sample) {
  return scattering_weight(interaction, sample) *
         static_cast<float>(
             radiance_scale(interaction.material, sample.crosses, interaction.from_back));
}

// Adds light of a lamp off a rough surface, by a direction drawn towards the lamp. Directions of
// the lobe that meet the lamp carry the rest of the weight (balance heuristic of Veach & Guibas
// 1995).
void RayTree::add_lamp(const Branch& branch, const SurfaceInteraction& interaction,
                       const LobeView& view, const ElementHit& hit, const ShadingPoint& at,
                       const Eigen::Array4d& u, float share, TreeState& state) const {
  if (branch.depth >= deepest_path(options_.max_depth)) return;
  const auto lamp = lamps_.draw(view, hit.facet, u[0], u[1], u[2]);
  if (!lamp) return;
  if (crosses_facet_alone(lamp->direction, interaction.normal, at.normal)) return;
  const int material = facets_[hit.facet].material;
  const double density = lobe(material, hit.from_back).density(interaction, lamp->direction);
  const ScatteringSample sample{.direction = lamp->direction,
                                .crosses = lamp->direction.dot(interaction.normal) < 0.0};
  const Eigen::Vector3d lit = at.position + lamp->distance * lamp->direction;
  const Spectrum L = exitance_at(*lamp->emitter, lit) * std::numbers::inv_pi_v<float>;
  Spectrum seen = branch.weight * radiance_weight(interaction, sample) * L *
                  (share * static_cast<float>(density / (density + lamp->density)));
  if (!((branch.weight > 0.0f).any() && density > 0.0)) return;
  const Ray ray{.origin = at.position,
                .direction = lamp->direction,
                .t_max = lamp->distance,
                .origin_group = hit.facet,
                .target_group = lamp->emitter->facet};
  std::uint8_t blocked = 0;
  state.caster->occluded({&ray, 1}, {&blocked, 1});
  if (blocked != 0) return;
  if (absorbs_) {
    Media media = branch.media;
    media.cross(material, interaction.material, sample, hit.from_back);
    seen *= left_along(media, ray, lamp->distance);
  }
  add_reflected(branch, seen, state);
}

// Adds light of a source that is no surface off a rough surface. No direction of the lobe meets
// such a source, so this sample has the full weight.
void RayTree::add_free_source(const Branch& branch, const SurfaceInteraction& interaction,
                              const LobeView& view, const ElementHit& hit, const ShadingPoint& at,
                              const Eigen::Array4d& u, float share, TreeState& state) const {
  if (branch.depth >= deepest_path(options_.max_depth)) return;
  const auto drawn = lamps_.draw_source(view, u[0]);
  if (!drawn) return;
  const SourceSample source_sample = sample_source(*drawn->source, at.position, u[1], u[2]);
  if (crosses_facet_alone(source_sample.direction, interaction.normal, at.normal)) return;
  const int material = facets_[hit.facet].material;
  const double density =
      lobe(material, hit.from_back).density(interaction, source_sample.direction);
  if (!(density > 0.0)) return;
  const ScatteringSample sample{.direction = source_sample.direction,
                                .crosses = source_sample.direction.dot(interaction.normal) < 0.0};
  const Ray ray{.origin = at.position,
                .direction = source_sample.direction,
                .t_max = source_sample.distance,
                .origin_group = hit.facet};
  // A lobe with density p averages radiance, int L p dw. A source of irradiance E and solid angle 0
  // contributes E p.
  Spectrum seen = branch.weight * radiance_weight(interaction, sample) *
                  light_towards(*drawn->source, at.position) *
                  direct_light_.passed(*state.caster, ray) *
                  (share * static_cast<float>(density * source_sample.irradiance / drawn->chance));
  if (!(seen > 0.0f).any()) return;
  if (absorbs_) {
    Media media = branch.media;
    media.cross(material, interaction.material, sample, hit.from_back);
    seen *= left_along(media, ray, source_sample.distance);
  }
  add_reflected(branch, seen, state);
}

// The site whose view of the sky a rough mirror or coat aims at; null: none. A coat behind another
// one is not worth the rays.
const SkySites::Site* RayTree::sky_site(const Branch& branch, const SurfaceInteraction& interaction,
                                        const ElementHit& hit, const ShadingPoint& at,
                                        const TreeState& state) const {
  const Material& material = interaction.material;
  const bool is_weak = material.mirrors_by_coat() && branch.behind_coat > 0;
  if (state.lamps_alone || material.dielectric || is_weak || !direct_light_.sky()) return nullptr;
  const SkySites::Site* site =
      direct_light_.sky()->site({at.position, interaction.normal, hit.facet});
  return site && site->sum.back() > 0.0f ? site : nullptr;
}

// Adds light of the sky off a rough surface, by a direction drawn towards what the site sees of the
// sky. Directions of the lobe that meet the sky carry the rest of the weight (see
// add_background()).
void RayTree::add_sky(const Branch& branch, const SurfaceInteraction& interaction,
                      const ElementHit& hit, const ShadingPoint& at, const SkySites::Site& site,
                      const Eigen::Array4d& u, float share, TreeState& state) const {
  if (branch.depth >= deepest_path(options_.max_depth)) return;
  const SkyLight::Aim aim = direct_light_.sky()->aim(site, u[0], u[1], u[2]);
  if (!(aim.density > 0.0) || !(aim.direction.dot(interaction.normal) > 0.0) ||
      !(aim.direction.dot(at.normal) > 0.0)) {
    return;
  }
  const double density =
      lobe(facets_[hit.facet].material, hit.from_back).density(interaction, aim.direction);
  // Directions far outside the lobe end by Russian roulette before a ray is cast. Such a direction
  // brings less than a fiftieth of the light that one in the middle of a wide lobe brings.
  constexpr double far_outside = 0.02;
  const double chance = std::min(1.0, density / (far_outside * aim.density));
  if (!(density > 0.0) || !(u[3] < chance)) return;
  const ScatteringSample sample{.direction = aim.direction};
  const Ray ray{.origin = at.position, .direction = aim.direction, .origin_group = hit.facet};
  Spectrum seen = branch.weight * scattering_weight(interaction, sample) *
                  direct_light_.dome()->light * sky_radiance(*scene_.sky, aim.direction) *
                  (share * static_cast<float>(density / (density + aim.density) / chance));
  if (!(seen > 0.0f).any()) return;
  seen *= direct_light_.passed(*state.caster, ray);
  if (absorbs_) {
    Media media = branch.media;
    media.cross(facets_[hit.facet].material, interaction.material, sample, hit.from_back);
    seen *= media.passed(scene_, -1, false, ray.t_max);
  }
  add_reflected(branch, seen, state);
}

// Adds light of a bright patch off a rough mirror by an aimed direction, weighted as in add_lamp().
void RayTree::add_bright_patch(const Branch& branch, const SurfaceInteraction& interaction,
                               const ElementHit& hit, const ShadingPoint& at,
                               const BrightPatches::View& view, const Eigen::Array4d& u,
                               float share, TreeState& state) const {
  if (branch.depth >= deepest_path(options_.max_depth)) return;
  const BrightPatches::Aim aim = bright_.draw(view, u[0], u[1], u[2]);
  if (!(aim.direction.dot(at.normal) > 0.0) || !(aim.direction.dot(interaction.normal) > 0.0))
    return;
  const double density =
      lobe(facets_[hit.facet].material, hit.from_back).density(interaction, aim.direction);
  if (!(density > 0.0)) return;
  Branch aimed = branch;
  aimed.ray = {.origin = at.position, .direction = aim.direction, .origin_group = hit.facet};
  ElementHit met;
  state.caster->closest_hits({&aimed.ray, 1}, {&met, 1});
  if (!bright_.counts(aim, met)) return;
  const ShadingPoint there = shading_point(aimed.ray, met, *state.caster);
  const double distance = (there.position - at.position).norm();
  // A luminaire's body hides what surfaces reflect, for the lobe's directions as for this one.
  if (visible_lamps_->first_body(aimed.ray, distance)) return;
  const double both = density + bright_.density(view, met.element, aim.direction, distance);
  aimed.weight *= scattering_weight(interaction, {.direction = aim.direction}) *
                  (share * static_cast<float>(density / both));
  if (absorbs_) {
    aimed.weight *= left_before(aimed, met, distance);
  }
  if (!(aimed.weight > 0.0f).any()) return;
  aimed.depth = branch.depth + 1;
  aimed.node = random_key(branch.node, RandomPurpose::gloss_patches,
                          static_cast<std::uint64_t>(met.element));
  aimed.is_sharp = false;
  aimed.cone.start = cone_width(branch, at);
  aimed.blur = {.start = width_of(branch.blur, branch, at), .spread = spread_of_lobe(density)};
  aimed.lobe_density = 0.0;
  aimed.lobe = nullptr;
  aimed.bright = nullptr;
  aimed.is_aimed = true;
  shade(aimed, met, there, state);
}

// Weight of a branch's hit on a bright patch beside add_bright_patch(), by the balance heuristic.
float RayTree::share_of_bright(const Branch& branch, const ElementHit& hit,
                               const ShadingPoint& at) const {
  if (!branch.bright) return 1.0f;
  const Eigen::Vector3d to = at.position - branch.ray.origin;
  const double distance = to.norm();
  if (!(distance > 0.0)) return 1.0f;
  const double aimed = bright_.density(*branch.bright, hit.element, to / distance, distance);
  return static_cast<float>(branch.lobe_density / (branch.lobe_density + aimed));
}

// Exitance M of the side that was hit, less the share that add_lamp() samples. A picture is
// averaged over the pixel's footprint.
Spectrum RayTree::emission(const Branch& branch, const ElementHit& hit,
                           const ShadingPoint& at) const {
  const PatchMesh& mesh = caster_.mesh();
  const int patch = mesh.patch[hit.element];
  const Spectrum M = pictured_emission_.shines(patch)
                         ? pictured_emission_.over(hit.facet, at.rest, footprint(branch, at))
                         : Spectrum(mesh.emission.row(patch).transpose());
  if (branch.is_aimed && direct_light_.owns(hit.facet, hit.from_back))
    return Spectrum::Zero(M.size());
  if (!(branch.lobe_density > 0.0) || !(M > 0.0f).any()) return M;
  if (!direct_light_.owns(hit.facet, hit.from_back)) return M;
  const double lamps = lamps_.density(*branch.lobe, at.position, hit.facet);
  return M * static_cast<float>(branch.lobe_density / (branch.lobe_density + lamps));
}

}  // namespace lightwell
