// Steps of RayTree at diffuse surfaces: normals, reflectance, and the light that arrives.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "radiosity/paths/light_path.h"
#include "raytrace/shading/shade.h"
#include "scene/optics.h"
#include "scene/random_purpose.h"

namespace lightwell {
namespace {

constexpr float one_over_pi = std::numbers::inv_pi_v<float>;
// The fewest first shadow rays of one of many samples.
constexpr int fewest_of_many = 4;

// Returns shadow options for a branch: half the weight, half the rays, since the noise of a light
// branch may be larger. Halving keeps powers of two, which stratify best.
ShadowOptions shadows_for(ShadowOptions shadows, float weight, int fewest) {
  for (; weight <= 0.5f && shadows.min_rays >= 2 * fewest; weight *= 2.0f) {
    shadows.min_rays /= 2;
    shadows.max_rays /= 2;
  }
  return shadows;
}

}  // namespace

Eigen::Vector3d RayTree::smooth_normal(const ElementHit& hit, const ShadingPoint& at) const {
  return at.turned(facets_.smooth_normal(caster_.mesh(), normals_, hit, at.rest, at.rest_normal));
}

RayTree::ShadowOrigin RayTree::shadow_origin(const ElementHit& hit, const ShadingPoint& at) const {
  const PatchMesh& mesh = caster_.mesh();
  // An origin above a lamp's facet would be lit by the lamp itself.
  const bool shines = (mesh.emission.row(mesh.patch[hit.element]) > 0.0f).any();
  if (!normals_.is_given(hit.facet) || shines) return {at.position, hit.facet};
  if (normals_.at(hit.facet, at.rest, at.rest_normal) == at.rest_normal) {
    return {at.position, hit.facet};
  }
  const double height = normals_.height(hit.facet, at.rest, at.rest_normal);
  return {at.position + std::max(height, least_lift_) * at.normal, -1};
}

// Reflectance of the texture, averaged over the pixel's footprint on the surface; of the patch
// without a texture.
Spectrum RayTree::reflectance(const Branch& branch, const ElementHit& hit,
                              const ShadingPoint& at) const {
  const PatchMesh& mesh = caster_.mesh();
  const int patch = mesh.patch[hit.element];
  const bool is_black_back =
      mesh.is_back[patch] != 0 && scene_.materials[facets_[hit.facet].material].one_sided;
  if (!textures_ || !textures_->is_textured(hit.facet) || is_black_back) {
    return mesh.reflectance.row(patch).transpose();
  }
  return textures_->reflectance(hit.facet, at.rest, footprint(branch, at));
}

std::unique_ptr<const Material> RayTree::pattern_at(const Branch& branch, const ElementHit& hit,
                                                    const ShadingPoint& at) const {
  if (!textures_ || !textures_->has_pattern(hit.facet)) return nullptr;
  // The back of a one-sided surface is black.
  const PatchMesh& mesh = caster_.mesh();
  const Material& material = scene_.materials[facets_[hit.facet].material];
  if (material.one_sided && hit.element >= 0 && mesh.is_back[mesh.patch[hit.element]] != 0) {
    return nullptr;
  }
  return std::make_unique<const Material>(
      textures_->material(hit.facet, at.rest, footprint(branch, at)));
}

// Sides of the pixel's footprint on the surface, in the rest pose.
Eigen::Matrix<double, 3, 2> RayTree::footprint(const Branch& branch, const ShadingPoint& at) const {
  const double width = cone_width(branch, at);
  const Eigen::Vector3d direction = at.turned_back(branch.ray.direction.normalized());
  const Eigen::Vector3d& normal = at.rest_normal;
  constexpr double grazing = 1e-3;  // cosine; a texture seen at a smaller one is a streak anyway
  const double cosine = std::max(grazing, std::abs(direction.dot(normal)));
  const Eigen::Vector3d across = normal.cross(direction);
  const double sine = across.norm();
  const Eigen::Vector3d side =
      sine > grazing ? Eigen::Vector3d(across / sine) : normal.unitOrthogonal();
  Eigen::Matrix<double, 3, 2> sides;
  sides << width * side, width / cosine * side.cross(normal);
  return sides;
}

// Slope of the relief about `normal`, that of the smooth surface; empty: the surface is flat there.
std::optional<ReliefSlope> RayTree::relief_at(const Branch& branch, const ElementHit& hit,
                                              const ShadingPoint& at, const Eigen::Vector3d& normal,
                                              const TreeState& state) const {
  if (!relief_.is_given(hit.facet) || state.lamps_alone) return std::nullopt;
  const Eigen::Vector3d rest = relief_.rise(hit.facet, at.rest, footprint(branch, at));
  const Eigen::Vector3d rise = at.turned(rest);
  // Seen from behind, a rise is a hollow.
  const double side = facets_[hit.facet].normal.dot(at.rest_normal) < 0.0 ? -1.0 : 1.0;
  return ReliefSlope{.normal = normal, .rise = side * (rise - rise.dot(normal) * normal)};
}

// Normal of the relief about `normal`.
Eigen::Vector3d RayTree::bent_normal(const Branch& branch, const ElementHit& hit,
                                     const ShadingPoint& at, const Eigen::Vector3d& normal,
                                     const TreeState& state) const {
  const auto relief = relief_at(branch, hit, at, normal, state);
  return relief ? relief->bent() : normal;
}

// Irradiance behind a translucent sheet.
RayTree::Arriving RayTree::arriving_behind(const ElementHit& hit, const ShadingPoint& at,
                                           const Branch& branch, const CoatedBase* base,
                                           const Spectrum& scattering,
                                           const TreeState& state) const {
  ShadingPoint other = at;
  other.normal = -at.normal;
  other.rest_normal = -at.rest_normal;
  return arriving(hit_behind(caster_.mesh(), hit), other, branch, base, scattering, state);
}

// Adds L = (M + rho E + tau E_behind) / pi, weighted by share_of_bright().
void RayTree::shade(const Branch& branch, const ElementHit& hit, const ShadingPoint& at,
                    TreeState& state) const {
  const float share = share_of_bright(branch, hit, at);
  Spectrum M = emission(branch, hit, at);
  if (!direct_light_.owns(hit.facet, hit.from_back)) M *= share;
  const std::unique_ptr<const Material> own = pattern_at(branch, hit, at);
  Spectrum rho = share * (own ? own->reflectance : reflectance(branch, hit, at));
  const int patch = caster_.mesh().patch[hit.element];
  const bool is_translucent = caster_.mesh().patch_behind(patch) >= 0;
  Spectrum tau;
  if (is_translucent) tau = share * caster_.mesh().transmittance.row(patch).transpose();
  if (is_translucent && own) tau = share * own->transmittance;
  std::optional<CoatedBase> own_base;
  if (own && own->coat) own_base.emplace(*own);
  const CoatedBase* const base = own_base ? &*own_base : base_at(hit);
  if (base) {
    const Eigen::Vector3d direction = branch.ray.direction.normalized();
    const Eigen::Vector3d normal = visible_normal(
        direction, at.normal, bent_normal(branch, hit, at, smooth_normal(hit, at), state));
    const double cosine = -direction.dot(normal);
    rho *= static_cast<float>(base->factor(cosine));
    tau *= static_cast<float>(base->factor(cosine));
  }
  Arriving E{.direct = Spectrum::Zero(M.size()), .indirect = Spectrum::Zero(M.size())};
  if (with_layers_ || (rho > 0.0f).any()) E = arriving(hit, at, branch, base, rho, state);
  Scattered scattered{.direct = rho * E.direct, .indirect = rho * E.indirect};
  float noise = rho.mean() * E.noise;
  if (is_translucent) {
    const Arriving behind = arriving_behind(hit, at, branch, base, tau, state);
    scattered.direct += tau * behind.direct;
    scattered.indirect += tau * behind.indirect;
    noise = std::hypot(noise, tau.mean() * behind.noise);
  }
  if (is_by_chance(branch, state) && direct_light_.owns(hit.facet, hit.from_back)) {
    *state.by_chance += branch.weight * one_over_pi * M;
    M.setZero();
  }
  const Spectrum seen = branch.weight * one_over_pi * (M + scattered.direct + scattered.indirect);
  if (is_apart(branch, state)) return add_apart(seen, state);
  state.result.radiance += seen;
  state.result.variance += std::pow(branch.weight.mean() * one_over_pi * noise, 2.0f);
  if (with_layers_) note_layers(branch, hit, M, rho, scattered, E, state);
}

// Adds the emission of DirectLight's emitters, which hemisphere rays do not read.
void RayTree::shade_lamp(const Branch& branch, const ElementHit& hit, const ShadingPoint& at,
                         TreeState& state) const {
  if (branch.is_direct || !direct_light_.owns(hit.facet, hit.from_back)) return;
  state.result.radiance += branch.weight * one_over_pi * emission(branch, hit, at);
}

// Irradiance of the solution. Closed forms of all lights cost more than the ray, so a dim hit takes
// direct light as even, and is flat.
RayTree::Arriving RayTree::arriving_from_mesh(const ElementHit& hit, const ShadingPoint& at,
                                              bool is_dim, const Eigen::Vector3d& normal,
                                              const ReceiverGain& gain) const {
  const PatchMesh& mesh = caster_.mesh();
  Arriving E{.direct = interpolate(mesh, solution_.direct_irradiance, hit)};
  const auto recorded = is_dim ? std::optional<Spectrum>() : indirect_of_records(at, normal);
  E.indirect = recorded ? *recorded : interpolate(mesh, solution_.indirect_irradiance, hit);
  if (recorded && solution_.caustic_irradiance.size() > 0) {
    E.indirect += interpolate(mesh, solution_.caustic_irradiance, hit);
  }
  if (gain.is_plain()) return E;
  E.on_facet = E.direct + E.indirect;
  E.indirect *= indirect_gain(hit, at, is_dim ? ReceiverGain{.base = gain.base} : gain);
  if (is_dim) return E;
  const SurfacePoint point{at.position, normal, hit.facet};
  if (gain.base) E.direct *= static_cast<float>(direct_light_.base_gain(point, *gain.base));
  if (gain.relief) E.direct *= static_cast<float>(direct_light_.relief_gain(point, *gain.relief));
  return E;
}

// Returns whether rough surfaces on the way, or a coat that blurs, spread the light of a hit over
// an element of the mesh or more.
bool RayTree::is_blurred(const Branch& branch, const ElementHit& hit,
                         const ShadingPoint& at) const {
  if (branch.is_sharp) return false;
  if (branch.behind_coat > 0) return true;
  const double width = width_of(branch.blur, branch, at);
  const double cosine = std::abs(branch.ray.direction.normalized().dot(at.normal));
  return width * width > cosine * caster_.mesh().element_area[hit.element];
}

RayTree::Arriving RayTree::arriving(const ElementHit& hit, const ShadingPoint& at,
                                    const Branch& branch, const CoatedBase* base,
                                    const Spectrum& scattering, const TreeState& state) const {
  const Eigen::Vector3d normal = smooth_normal(hit, at);
  const std::optional<ReliefSlope> relief = relief_at(branch, hit, at, normal, state);
  const ReceiverGain gain{.base = base, .relief = relief ? &*relief : nullptr};
  constexpr float weak = 0.25f;
  const bool is_weak = branch.behind_coat > 0 && branch.weight.maxCoeff() < weak;
  const bool is_dim = is_weak || is_blurred(branch, hit, at);
  if (options_.pass == Pass::interpolate || (is_dim && !virtual_)) {
    return arriving_from_mesh(hit, at, is_dim, normal, gain);
  }
  const float share = state.effort * branch.weight.maxCoeff();
  ShadowOptions shadows = shadows_for(options_.shadows, share, state.number ? fewest_of_many : 8);
  // Many samples of a pixel average their shadows, in place of a second stage of rays.
  if (state.number) shadows.max_rays = shadows.min_rays;
  // Samples draw other members of clusters of lights. Clusters four times as large have twice the
  // noise, which the mean of four samples halves.
  constexpr double coarser = 4.0;
  if (state.number) shadows.cluster_share *= coarser;
  Arriving E;
  const ShadowOrigin from = shadow_origin(hit, at);
  const bool has_dome = !relief && dome_.serves(hit.element, branch.weight.maxCoeff());
  LightQuery query{.at = {from.position, normal, from.facet},
                   .key = random_key(state.key, branch.node, RandomPurpose::ray_tree_shadows),
                   .shadows = shadows,
                   .lights = has_dome ? Lights::all_but_dome : Lights::all};
  if (is_dim) return arriving_from_one_light(hit, at, branch, query, state);
  if (!gain.is_plain() && with_layers_) {
    E.on_facet = direct_light(hit, branch, query, scattering, state).irradiance +
                 indirect_light(hit, at, branch, query, state);
  }
  query.base = gain.base;
  query.relief = gain.relief;
  E.indirect = indirect_light(hit, at, branch, query, state);
  if (!state.number) query.sky_noise = sky_noise(share, E.indirect);
  const auto [direct, noise] = direct_light(hit, branch, query, scattering, state);
  E.direct = direct;
  E.noise = noise;
  return E;
}

// Direct light by shadow rays, with the dome's from the mesh where the query leaves it out.
RayTree::DirectPart RayTree::direct_light(const ElementHit& hit, const Branch& branch,
                                          const LightQuery& query, const Spectrum& scattering,
                                          const TreeState& state) const {
  DirectPart found{.irradiance = Spectrum::Zero(scene_.bands.count())};
  if (!leaves_point(query, hit, branch, scattering, state)) {
    EmitterVisibility visibility;
    found.irradiance = direct_light_.irradiance(*state.caster, query, &visibility);
    found.noise = static_cast<float>(visibility.drawn_noise);
  }
  if (query.lights != Lights::all_but_dome) return found;
  found.irradiance += mesh_gain(BaseGain::of_dome, hit, query.base) *
                      interpolate(caster_.mesh(), dome_.irradiance, hit);
  return found;
}

// Indirect light at the point of a query, with caustics, which count as even light.
Spectrum RayTree::indirect_light(const ElementHit& hit, const ShadingPoint& at,
                                 const Branch& branch, const LightQuery& query,
                                 const TreeState& state) const {
  const ReceiverGain gain{.base = query.base, .relief = query.relief};
  const Eigen::Vector3d& normal = query.at.normal;
  const float share = state.effort * branch.weight.maxCoeff();
  const auto key = random_key(state.key, branch.node, RandomPurpose::ray_tree_gathers);
  bool is_gathered = gather_.has_value();
  Spectrum E;
  if (gather_) {
    E = gather_->indirect_irradiance(*state.caster,
                                     {.position = at.position,
                                      .normal = at.normal,
                                      .smooth_normal = normal,
                                      .facet = hit.facet,
                                      .gain = gain},
                                     key, share);
  } else if (virtual_) {
    E = virtual_->indirect_irradiance(
        *state.caster, {.at = query.at, .key = key, .effort = std::min(1.0f, share), .gain = gain});
  } else {
    const auto recorded = indirect_of_records(at, normal);
    E = indirect_gain(hit, at, gain) * (recorded ? *recorded : indirect_of_mesh(hit));
    is_gathered = recorded.has_value();
  }
  add_caustics(hit, at, is_gathered, E);
  return E;
}

// The noise that the sky's light may have in a sample of a pixel of which it is a `share`, (0, 1]:
// twice that of the pixel, which is the mean of four samples and more.
NoiseGoal RayTree::sky_noise(float share, const Spectrum& indirect) const {
  constexpr double samples = 4.0, least = 1e-6;
  const double noise =
      double{options_.sampling.noise} * std::sqrt(samples / std::max(double{share}, least));
  return {.irradiance = noise * double{indirect.mean()}, .share = noise, .most_times = 1};
}

// Leaves the direct light of a point to gathered_light(), if the sample may.
bool RayTree::leaves_point(const LightQuery& query, const ElementHit& hit, const Branch& branch,
                           const Spectrum& scattering, const TreeState& state) const {
  if (!state.points || is_apart(branch, state)) return false;
  PixelPoint point{.at = query.at,
                   .weight = branch.weight * one_over_pi * scattering,
                   .lights = query.lights,
                   .caster = state.caster};
  if (!(point.weight > 0.0f).any()) return true;
  if (query.base) point.base = std::make_shared<const CoatedBase>(*query.base);
  if (query.relief) point.relief = *query.relief;
  const Spectrum E = interpolate(caster_.mesh(), solution_.direct_irradiance, hit);
  point.about = static_cast<double>((point.weight * E).mean());
  state.points->push_back(std::move(point));
  return true;
}

bool RayTree::gathers_light() const {
  return options_.pass != Pass::interpolate && options_.pass != Pass::virtual_lights &&
         options_.shadows.many_lights == ManyLights::lightcuts && !with_layers_ &&
         direct_light_.has_clusters();
}

GatheredLight RayTree::gathered(const std::vector<PixelPoint>& points, std::uint64_t key,
                                double other) const {
  ShadowOptions shadows = shadows_for(options_.shadows, share_of_many, fewest_of_many);
  shadows.max_rays = shadows.min_rays;
  return gathered_light(direct_light_, points, {.key = key, .shadows = shadows, .other = other});
}

// Light of Pass::virtual_lights where little of it is seen.
RayTree::Arriving RayTree::arriving_from_one_light(const ElementHit& hit, const ShadingPoint& at,
                                                   const Branch& branch, LightQuery query,
                                                   const TreeState& state) const {
  query.one_stands_for_all = true;
  query.shadows = {.min_rays = 1, .max_rays = 1};
  Arriving E{.direct = direct_light_.irradiance(*state.caster, query)};
  const auto key = random_key(state.key, branch.node, RandomPurpose::ray_tree_gathers);
  E.indirect =
      virtual_->indirect_irradiance(*state.caster, {.at = query.at, .key = key, .effort = 0.0f});
  add_caustics(hit, at, false, E.indirect);
  return E;
}

// Factor of light of the mesh that a base gets.
float RayTree::mesh_gain(BaseGain which, const ElementHit& hit, const CoatedBase* base) const {
  if (!base || !base_gains_ || base_gains_->size() == 0) return 1.0f;
  return interpolate(caster_.mesh(), *base_gains_, hit)[static_cast<Eigen::Index>(which)];
}

// Factor of the solution's indirect light on a base or a slope of the relief.
float RayTree::indirect_gain(const ElementHit& hit, const ShadingPoint& at,
                             const ReceiverGain& gain) const {
  const float of_base = mesh_gain(BaseGain::of_indirect, hit, gain.base);
  if (!gain.relief || !slant_ || slant_->size() == 0) return of_base;
  const Eigen::Vector3d slant = interpolate(caster_.mesh(), *slant_, hit).matrix().cast<double>();
  const double of_slope = std::clamp(1.0 - gain.relief->rise.dot(at.turned(slant)), 0.0, 2.0);
  return of_base * static_cast<float>(of_slope);
}

// Returns whether photons replace the solution's caustics: mirrors and glass let photons pass.
bool RayTree::has_photons(const ElementHit& hit) const {
  return caustics_ && takes_diffuse_light(scene_.materials[facets_[hit.facet].material]);
}

// The solution's indirect light, without its own caustics if photons replace these.
Spectrum RayTree::indirect_of_mesh(const ElementHit& hit) const {
  Spectrum E = interpolate(caster_.mesh(), solution_.indirect_irradiance, hit);
  if (has_photons(hit) && solution_.caustic_irradiance.size() > 0) {
    // The difference may be slightly negative by rounding.
    E = (E - interpolate(caster_.mesh(), solution_.caustic_irradiance, hit)).max(0.0f);
  }
  return E;
}

// Indirect light by records around, without caustics; empty where none serves.
std::optional<Spectrum> RayTree::indirect_of_records(const ShadingPoint& at,
                                                     const Eigen::Vector3d& normal) const {
  if (!records_ || at.pose) return std::nullopt;
  const auto fit = records_->fit(at.position, normal);
  return fit ? std::optional(fit->irradiance) : std::nullopt;
}

// Adds caustics, which neither gathered light nor indirect_of_mesh() has.
void RayTree::add_caustics(const ElementHit& hit, const ShadingPoint& at, bool is_gathered,
                           Spectrum& indirect) const {
  if (solution_.caustic_irradiance.size() == 0) return;
  if (!has_photons(hit)) {
    if (is_gathered) indirect += interpolate(caster_.mesh(), solution_.caustic_irradiance, hit);
    return;
  }
  indirect += caustics_->irradiance(at.rest, at.rest_normal, hit.element, double{indirect.mean()});
}

void RayTree::note_layers(const Branch& branch, const ElementHit& hit, const Spectrum& M,
                          const Spectrum& rho, const Scattered& scattered, const Arriving& E,
                          TreeState& state) const {
  const Bands& bands = scene_.bands;
  const auto three = [&](Layer layer) {
    return state.result.layers.segment<3>(first_sampled_column(layer));
  };
  const auto light = [&](const Spectrum& radiosity) {
    const Spectrum L = branch.weight * one_over_pi * radiosity;
    return linear_rgb(bands, L);
  };
  if (branch.node == 1) {
    // Bands without a white, such as infrared, have no colour; their albedo is the grey of the
    // mean.
    three(Layer::albedo) = (white_rgb_ > 0.0f).all()
                               ? Eigen::Array3f(linear_rgb(bands, rho) / white_rgb_)
                               : Eigen::Array3f::Constant(rho.mean());
    three(Layer::emission) = light(M);
    three(Layer::direct) = light(scattered.direct);
    three(Layer::indirect) = light(scattered.indirect);
  } else {
    three(Layer::specular) += light(M + scattered.direct + scattered.indirect);
  }
  // Refracted children alone have odd numbers, so all bits of a number straight through glass are
  // ones.
  const bool is_straight = branch.is_sharp && (branch.node & (branch.node + 1)) == 0;
  if (is_straight && !scene_.materials[facets_[hit.facet].material].dielectric) {
    const Spectrum all = E.on_facet.size() > 0 ? E.on_facet : Spectrum(E.direct + E.indirect);
    state.result.layers[first_sampled_column(Layer::illuminance)] =
        static_cast<float>(luminous(bands, all));
  }
}

}  // namespace lightwell
