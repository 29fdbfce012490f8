#include "raytrace/shading/shade.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "radiosity/gather/final_gather.h"
#include "radiosity/visibility/absorbing_bodies.h"
#include "raytrace/shading/indirect_slant.h"
#include "raytrace/shading/picture_base_gains.h"
#include "scene/optics.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"
#include "scene/scenery_box.h"

namespace lightwell {
namespace {

// True if a material is rough somewhere. One of varying roughness may be smooth in the mean.
bool is_rough(const Material& material) {
  return material.gloss_roughness() > 0.0f || (material.pattern && material.pattern->roughness);
}

}  // namespace

RayTree::RayTree(const Scene& scene, const ElementCaster& caster, const DirectLight& direct_light,
                 const RadiositySolution& solution, const RenderOptions& options)
    : scene_(scene),
      caster_(caster),
      direct_light_(direct_light),
      solution_(solution),
      options_(options),
      textures_(std::make_shared<const FacetTextures>(scene)),
      pictured_emission_(caster.mesh()),
      normals_(scene),
      relief_(scene),
      with_layers_(std::any_of(options.layers.begin(), options.layers.end(),
                               [](Layer layer) { return first_sampled_column(layer) >= 0; })),
      white_rgb_(linear_rgb(scene.bands, constant_spectrum(scene.bands, 1.0f))),
      gloss_points_(gloss_point_count),
      lamps_(direct_light),
      visible_lamps_(options.visible_lamps ? options.visible_lamps
                                           : std::make_shared<const VisibleLamps>(
                                                 scene, caster, direct_light, solution)),
      bases_(scene.materials),
      facets_(scene, caster.mesh(), normals_) {
  if (textures_->is_empty()) textures_ = nullptr;
  constexpr double rounding = 1e-6;  // share of scenery_length()
  if (!normals_.is_empty()) least_lift_ = rounding * scenery_length(scene);
  if (options.pass == Pass::gather) {
    gather_.emplace(scene, caster, direct_light, solution, options.gather_rays, options.max_depth);
  }
  const bool uses_solution = options.pass != Pass::gather && options.pass != Pass::virtual_lights;
  if (!relief_.is_empty() && uses_solution) {
    slant_ = options.slant ? options.slant
                           : std::make_shared<const BandArray>(indirect_slant(
                                 scene, caster, direct_light, solution, options.max_depth));
  }
  if (direct_light.has_coats() && uses_solution) {
    base_gains_ = options.base_gains ? options.base_gains
                                     : std::make_shared<const BandArray>(picture_base_gains(
                                           {scene, caster, direct_light}, solution));
  }
  if (options.pass == Pass::automatic) dome_ = dome_on_mesh(caster.mesh(), direct_light, solution);
  if (needs_caustic_photons(solution, options)) {
    caustics_ = options.caustics ? options.caustics
                                 : trace_caustics(scene, caster, direct_light, options.photons,
                                                  options.max_depth, options.run.progress);
  }
  if (options.pass == Pass::virtual_lights) {
    virtual_ = options.found_virtual_lights;
    if (!virtual_) {
      virtual_ = std::make_shared<const VirtualLights>(
          LitScene{scene, caster, direct_light},
          VirtualLightOptions{.count = options.virtual_lights,
                              .max_specular_depth = options.max_depth,
                              .caustics = caustics_,
                              .progress = options.run.progress});
    }
  }
  for (const Material& material : scene.materials) {
    const auto& glass = material.dielectric;
    absorbs_ = absorbs_ || (glass && (glass->absorption > 0.0f).any());
    auto& of_sides = lobes_.emplace_back();
    for (const bool is_back : {false, true}) {
      if (is_rough(material)) of_sides[is_back].emplace(material, is_back);
    }
  }
  const auto is_rough_mirror = [](const Material& material) {
    return is_rough(material) && !material.dielectric;
  };
  if (std::any_of(scene.materials.begin(), scene.materials.end(), is_rough_mirror)) {
    bright_ =
        BrightPatches(scene, caster, gatherable_radiosity(caster.mesh(), direct_light, solution));
  }
}

void RayTree::set_records(std::shared_ptr<const IrradianceRecords> records) {
  records_ = std::move(records);
  if (!records_) return;
  dome_ = dome_on_mesh(caster_.mesh(), direct_light_, solution_, IrradianceRecords::usual_error);
}

RaySample RayTree::trace(const Ray& ray, std::uint64_t key, float effort,
                         const PixelCone& cone) const {
  const int bands = scene_.bands.count();
  TreeState state{.result = {.radiance = Spectrum::Zero(bands)},
                  .key = key,
                  .effort = effort,
                  .caster = &caster_,
                  .gloss_key = key};
  follow({.ray = ray, .weight = Spectrum::Ones(bands), .cone = cone}, state);
  return state.result;
}

RaySample RayTree::trace_one_of_many(const Ray& ray, std::uint64_t key, int number,
                                     const ElementCaster& caster, const PixelCone& cone) const {
  return trace_sample(ray, key, number, caster, cone, nullptr);
}

RaySample RayTree::trace_to_gather(const Ray& ray, std::uint64_t key, int number,
                                   const ElementCaster& caster, const PixelCone& cone,
                                   std::vector<PixelPoint>& points) const {
  return trace_sample(ray, key, number, caster, cone, &points);
}

RaySample RayTree::trace_sample(const Ray& ray, std::uint64_t key, int number,
                                const ElementCaster& caster, const PixelCone& cone,
                                std::vector<PixelPoint>* points) const {
  const int bands = scene_.bands.count();
  TreeState state{.result = {.radiance = Spectrum::Zero(bands)},
                  .key = random_key(key, static_cast<std::uint64_t>(number)),
                  .effort = share_of_many,
                  .caster = &caster,
                  .number = number,
                  .gloss_key = key,
                  .points = points};
  follow({.ray = ray, .weight = Spectrum::Ones(bands), .cone = cone}, state);
  return state.result;
}

Spectrum RayTree::trace_lamps(const Ray& ray, std::uint64_t key,
                              const std::function<void(const SpecularSegment&)>& visit) const {
  const int bands = scene_.bands.count();
  TreeState state{.result = {.radiance = Spectrum::Zero(bands)},
                  .key = key,
                  .caster = &caster_,
                  .lamps_alone = true,
                  .visit = visit ? &visit : nullptr,
                  .gloss_key = key};
  follow({.ray = ray, .weight = Spectrum::Ones(bands)}, state);
  return state.result.radiance;
}

void RayTree::trace_chain(const Ray& ray, const ChainTurns& turns,
                          const std::function<void(const SpecularSegment&)>& visit) const {
  TreeState state{
      .caster = &caster_, .shades = false, .lamps_alone = true, .visit = &visit, .turns = &turns};
  follow({.ray = ray, .weight = Spectrum::Ones(scene_.bands.count())}, state);
}

// Traces a ray without shading: the result has no radiance.
RaySample RayTree::outline(const Ray& ray, const PixelCone& cone) const {
  TreeState state{.caster = &caster_, .shades = false};
  follow({.ray = ray, .weight = Spectrum::Ones(scene_.bands.count()), .cone = cone}, state);
  return state.result;
}

void RayTree::follow(Branch branch, TreeState& state) const {
  ElementHit hit;
  state.caster->closest_hits({&branch.ray, 1}, {&hit, 1});
  RaySample& result = state.result;
  if (state.visit && branch.is_sharp && !branch.is_direct) {
    (*state.visit)({.ray = branch.ray,
                    .end = hit.facet < 0 ? std::numeric_limits<double>::infinity() : hit.t,
                    .weight = branch.weight,
                    .media = branch.media,
                    .chain = branch.chain,
                    .turns = branch.turns});
  }
  if (!visible_lamps_->empty() && shows_lamp(branch, hit, state)) return;
  if (!state.lamps_alone && branch.is_sharp && branch.share() >= options_.contrast) {
    const int seen = hit.facet < 0 ? -1 : facets_[hit.facet].smooth_surface;
    result.fingerprint = random_key(result.fingerprint, branch.node,
                                    static_cast<std::uint64_t>(seen), hit.from_back);
  }
  if (hit.facet < 0) return add_background(branch, state);
  const ShadingPoint at = shading_point(branch.ray, hit, *state.caster);
  if (absorbs_) {
    branch.weight *= left_before(branch, hit, (at.position - branch.ray.origin).norm());
  }
  if (state.shades && with_layers_ && branch.node == 1) {
    const Eigen::Vector3d smooth = hit.element >= 0 ? smooth_normal(hit, at) : at.normal;
    const Eigen::Vector3d normal = bent_normal(branch, hit, at, smooth, state);
    result.layers.segment<3>(first_sampled_column(Layer::normal)) = normal.cast<float>();
  }
  if (state.shades && hit.element >= 0) {
    if (state.lamps_alone) {
      shade_lamp(branch, hit, at, state);
    } else {
      shade(branch, hit, at, state);
    }
  }
  split(branch, hit, at, state);
}

Spectrum RayTree::left_along(const Media& media, const Ray& ray, double distance) const {
  Spectrum left = media.passed(scene_, -1, false, distance);
  const AbsorbingBodies* bodies = direct_light_.bodies().get();
  if (!bodies || !media.is_empty() || !std::isfinite(distance)) return left;
  const Spectrum* absorption = bodies->around(
      caster_,
      {.position = ray.origin, .normal = ray.direction.normalized(), .facet = ray.origin_group});
  if (absorption) left *= left_after(*absorption, distance);
  return left;
}

// The same over the last `distance` metres of a branch before a hit.
Spectrum RayTree::left_before(const Branch& branch, const ElementHit& hit, double distance) const {
  Spectrum left = branch.media.passed(scene_, facets_[hit.facet].material, hit.from_back, distance);
  const AbsorbingBodies* bodies = direct_light_.bodies().get();
  if (!bodies || !branch.media.is_empty()) return left;
  const Spectrum* absorption = bodies->before(caster_.mesh(), hit);
  if (absorption) left *= left_after(*absorption, distance);
  return left;
}

// Adds the radiance of a luminaire where it hides the hit. Rough surfaces sample the light of
// openings in add_free_source(), and see bodies alone.
bool RayTree::shows_lamp(const Branch& branch, const ElementHit& hit, TreeState& state) const {
  if (state.lamps_alone) return false;
  Ray ray = branch.ray;
  ray.direction.normalize();
  const double end =
      hit.facet < 0 ? std::numeric_limits<double>::infinity() : hit.t * branch.ray.direction.norm();
  const auto seen =
      branch.is_sharp ? visible_lamps_->first(ray, end) : visible_lamps_->first_body(ray, end);
  if (!seen) return false;
  if (branch.is_sharp && branch.share() >= options_.contrast) {
    constexpr std::uint64_t of_lamps = std::uint64_t{1} << 32;  // beyond all smooth surfaces
    state.result.fingerprint = random_key(state.result.fingerprint, branch.node,
                                          of_lamps + static_cast<std::uint64_t>(seen->face), false);
  }
  if (!state.shades) return true;
  if (with_layers_ && branch.node == 1) {
    state.result.layers.segment<3>(first_sampled_column(Layer::normal)) =
        seen->normal.cast<float>();
  }
  Branch dimmed = branch;
  if (absorbs_) dimmed.weight *= left_along(branch.media, ray, seen->t);
  if (!seen->is_body) {
    add_seen(dimmed, seen->radiance, state);
    return true;
  }
  add_body(dimmed, *seen, state);
  if (!branch.is_sharp) add_light_behind(branch, hit, state);
  return true;
}

// Adds the light that a luminaire's body reflects, in layers as that of a surface that gets
// indirect light alone.
void RayTree::add_body(const Branch& branch, const VisibleLamps::Seen& body,
                       TreeState& state) const {
  const Spectrum light = branch.weight * body.radiance;
  state.result.radiance += light;
  if (!with_layers_) return;
  const Layer layer = branch.node == 1 ? Layer::indirect : Layer::specular;
  state.result.layers.segment<3>(first_sampled_column(layer)) += linear_rgb(scene_.bands, light);
  if (branch.node == 1) {
    state.result.layers.segment<3>(first_sampled_column(Layer::albedo))
        .setConstant(DrawnLamps::body_reflectance);
  }
}

// Adds the share of a lobe's direction in the light of emitters and sky behind a luminaire's body:
// rays aimed at them carry the rest, and no body blocks these.
void RayTree::add_light_behind(const Branch& branch, const ElementHit& hit,
                               TreeState& state) const {
  if (hit.facet < 0) {
    if (branch.sky) add_background(branch, state);
    return;
  }
  if (hit.element < 0 || !(branch.lobe_density > 0.0)) return;
  if (!direct_light_.owns(hit.facet, hit.from_back)) return;
  const ShadingPoint at = shading_point(branch.ray, hit, *state.caster);
  Spectrum L = branch.weight * std::numbers::inv_pi_v<float> * emission(branch, hit, at);
  if (absorbs_) {
    L *= left_before(branch, hit, (at.position - branch.ray.origin).norm());
  }
  add_reflected(branch, L, state);
}

// Adds radiance of the sky, and of the sun except off rough surfaces, which sample the sun in
// add_free_source().
void RayTree::add_background(const Branch& branch, TreeState& state) const {
  if (!state.shades || !scene_.sky || (state.lamps_alone && branch.is_sharp)) return;
  const Eigen::Vector3d direction = branch.ray.direction.normalized();
  Spectrum L = Spectrum::Zero(scene_.bands.count());
  for (const FreeSource& source : direct_light_.free_sources()) {
    if (source.is_dome()) {
      if (state.lamps_alone) continue;
      Spectrum dome = source.light * sky_radiance(*scene_.sky, direction);
      if (branch.sky) {
        const double aimed = direct_light_.sky()->density(*branch.sky, direction);
        dome *= static_cast<float>(branch.sky_lobe_density / (branch.sky_lobe_density + aimed));
      }
      L += dome;
    } else if (const auto* light = std::get_if<SunLight>(&source.shape)) {
      const Sun& sun = light->sun;
      if (branch.lobe_density > 0.0 || direction.dot(sun.direction) < sun.cosine_of_edge())
        continue;
      L += source.light / static_cast<float>(sun.solid_angle());
    }
  }
  add_seen(branch, L, state);
}

// Adds radiance of something that no light of the scene falls on.
void RayTree::add_seen(const Branch& branch, const Spectrum& L, TreeState& state) const {
  const Spectrum seen = branch.weight * L;
  if (is_apart(branch, state)) return add_apart(seen, state);
  state.result.radiance += seen;
  if (!with_layers_) return;
  const Layer layer = branch.node == 1 ? Layer::emission : Layer::specular;
  state.result.layers.segment<3>(first_sampled_column(layer)) += linear_rgb(scene_.bands, seen);
}

// The number of the branch of a lobe: twice the parent's and the lobe, 1 at the eye. Far from the
// eye, where twice the number is more than 64 bits hold, a number that is not met nearer.
static std::uint64_t child_node(std::uint64_t node, std::uint64_t lobe) {
  constexpr std::uint64_t deep = std::uint64_t{1} << 62;
  return node < deep ? 2 * node + lobe : deep | random_key(node, lobe);
}

void RayTree::split(const Branch& branch, const ElementHit& hit, const ShadingPoint& at,
                    TreeState& state) const {
  const Material& even = scene_.materials[facets_[hit.facet].material];
  // The back of a one-sided mirror is black.
  if (!even.is_specular() || (!even.dielectric && hit.element < 0)) return;
  const std::unique_ptr<const Material> own = pattern_at(branch, hit, at);
  const Material& material = own ? *own : even;
  if (!material.is_specular()) return;
  SurfaceInteraction interaction{.material = material,
                                 .direction = branch.ray.direction,
                                 .normal = at.normal,
                                 .from_back = hit.from_back,
                                 .polarisation = branch.polarisation};
  if (has_own_normals(hit.facet)) {
    const Eigen::Vector3d smooth = at.turned(normals_.at(hit.facet, at.rest, at.rest_normal));
    interaction.normal = visible_normal(branch.ray.direction, at.normal,
                                        bent_normal(branch, hit, at, smooth, state));
  }
  Branch mirrored = branch;
  const bool is_mirrored = goes_on_at_coat(interaction, mirrored, state);
  if (material.gloss_roughness() > 0.0f) {
    if (material.passes_straight() && !(state.turns && branch.depth >= state.turns->count)) {
      constexpr std::uint64_t straight = 1;
      grow(branch, child_node(branch.node, straight), straight_sample(interaction), material, hit,
           at, state);
    }
    if (is_mirrored) scatter(mirrored, interaction, hit, at, state);
    return;
  }
  if (state.turns && branch.depth >= state.turns->count) return;
  SmoothScattering lobes = smooth_scattering(interaction);
  if (state.shades && branch.share() < options_.min_contribution) {
    choose_one(branch, lobes, state);
  }
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(lobes.count); ++i) {
    const ScatteringSample& lobe = lobes.sample[i];
    if (state.turns && !state.turns->follows(branch.depth, lobe.crosses)) continue;
    if (!lobe.crosses && !is_mirrored) continue;
    grow(lobe.crosses ? branch : mirrored, child_node(branch.node, i), lobe, material, hit, at,
         state);
  }
}

void RayTree::grow(const Branch& parent, std::uint64_t node, const ScatteringSample& sample,
                   const Material& what, const ElementHit& hit, const ShadingPoint& at,
                   TreeState& state) const {
  const int material = facets_[hit.facet].material;
  const bool off_lobe = sample.density > 0.0;
  const bool is_behind_coat = parent.behind_coat > 0 || (what.mirrors_by_coat() && !sample.crosses);
  Branch branch{.weight = parent.weight * sample.weight,
                .depth = parent.depth + 1,
                .node = node,
                .is_sharp = parent.is_sharp,
                .is_direct = parent.is_direct && sample.crosses && is_clear_pane(what),
                .chain = random_key(parent.chain, facets_[hit.facet].chain, sample.crosses),
                .turns = parent.turns,
                .lobe_density = sample.density,
                .lobe = off_lobe ? parent.lobe : nullptr,
                .bright = sample.density > 0.0 ? parent.bright : nullptr,
                .is_hidden = parent.is_hidden || (!parent.is_sharp && !off_lobe &&
                                                  !(sample.crosses && is_clear_pane(what))),
                .sky = off_lobe || (sample.crosses && is_clear_pane(what)) ? parent.sky : nullptr,
                .sky_lobe_density = off_lobe ? sample.density : parent.sky_lobe_density,
                .behind_coat = parent.behind_coat + (is_behind_coat ? 1 : 0),
                .scale = parent.scale,
                .cone = {.start = cone_width(parent, at), .spread = parent.cone.spread},
                .blur = {.start = width_of(parent.blur, parent, at),
                         .spread = off_lobe ? spread_of_lobe(sample.density) : parent.blur.spread},
                .media = parent.media,
                .polarisation = sample.polarisation};
  if (!survives(branch, state)) return;
  if (branch.depth > deepest_path(options_.max_depth)) {
    ++state.result.depth_cut;
    state.result.cut_weight += branch.share();
    return;
  }
  if (parent.depth < ChainTurns::most) {
    branch.turns.crosses |= std::uint64_t{sample.crosses} << parent.depth;
    branch.turns.count = branch.depth;
  } else {
    branch.turns = {};
  }
  const double scale = radiance_scale(what, sample.crosses, hit.from_back);
  branch.weight *= static_cast<float>(scale);
  branch.scale *= scale;
  branch.media.cross(material, what, sample, hit.from_back);
  branch.ray = {
      .origin = at.position, .direction = sample.direction.normalized(), .origin_group = hit.facet};
  if (has_own_normals(hit.facet)) {
    branch.ray.direction = on_its_side(branch.ray.direction, at.normal, sample.crosses);
  }
  follow(branch, state);
}

RayTree::ShadingPoint RayTree::shading_point(const Ray& ray, const ElementHit& hit,
                                             const ElementCaster& caster) const {
  const FacetShape& facet = facets_[hit.facet];
  ShadingPoint at{.position = ray.origin + hit.t * ray.direction,
                  .pose = caster.pose_of(hit.facet)};
  at.rest = at.pose ? Eigen::Vector3d(at.pose->inverse() * at.position) : at.position;
  // The point is projected onto the facet's plane in double, since the caster's distances are
  // float.
  if (facet.round < 0) at.rest -= facet.normal.dot(at.rest - facet.point) * facet.normal;
  at.rest_normal = facets_.normal_against(at.turned_back(ray.direction), hit.facet, at.rest);
  at.position = at.pose ? Eigen::Vector3d(*at.pose * at.rest) : at.rest;
  at.normal = at.turned(at.rest_normal);
  return at;
}

}  // namespace lightwell
