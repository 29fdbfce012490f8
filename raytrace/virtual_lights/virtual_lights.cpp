#include "raytrace/virtual_lights/virtual_lights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "raytrace/virtual_lights/virtual_light_paths.h"
#include "scene/found_by_chance.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// The limit b at which a single light gives a point at most an eighth of the mean radiosity of the
// surfaces: N lights on an area A carry A / N of that each.
double kernel_limit(double area, int count) {
  constexpr double most_share = 1.0 / 8.0;
  return area > 0.0 ? most_share * std::numbers::pi * count / area : 0.0;
}

// Rays that find what the limit cuts off, and in scenes with mirrors and glass, which are a small
// part of what a point sees.
constexpr int rays_beyond_limit = 8, rays_by_way = 32;
// The greatest share of a point's light that a cluster of virtual lights may give. Eight pixels in
// a row have other members of clusters.
constexpr double cluster_share = 0.1;

}  // namespace

VirtualLights::VirtualLights(const LitScene& lit, const VirtualLightOptions& options)
    : lit_(lit),
      paths_(lit.scene, lit.caster, options.max_specular_depth, PathDetail::points),
      caustics_(options.caustics),
      most_(kernel_limit(area_of_virtual_lights(lit), options.count)),
      lights_(lit.scene,
              find_virtual_lights(lit_, paths_, caustics_.get(), options.count, most_, options.key,
                                  options.progress),
              lit.direct_light.bodies()) {
  if (const FreeSource* dome = lit.direct_light.dome()) dome_ = dome->light;
}

Spectrum VirtualLights::indirect_irradiance(const ElementCaster& caster, const Query& query) const {
  const Spectrum E = from_lights(caster, query);
  return E + from_rays(caster, query, E.mean());
}

Spectrum VirtualLights::from_lights(const ElementCaster& caster, const Query& query) const {
  const bool is_single = !(query.effort > 0.0f);
  constexpr double coarsest = 0.5;
  const double effort = is_single ? 1.0 : static_cast<double>(query.effort);
  return lights_.irradiance(
      caster, {.at = query.at,
               .key = query.key,
               .shadows = {.min_rays = 1,
                           .max_rays = 1,
                           .cluster_share = std::min(coarsest, cluster_share / effort)},
               .one_stands_for_all = is_single,
               .base = query.gain.base,
               .relief = query.gain.relief});
}

int VirtualLights::rays_of(const Query& query) const {
  if (!(query.effort > 0.0f)) return 1;
  const int most = paths_.has_specular() ? rays_by_way : rays_beyond_limit;
  return std::max(1, static_cast<int>(std::lround(static_cast<double>(query.effort) * most)));
}

Spectrum VirtualLights::from_rays(const ElementCaster& caster, const Query& query,
                                  float of_lights) const {
  const int rays = rays_of(query);
  Spectrum sum = Spectrum::Zero(lit_.scene.bands.count());
  std::vector<Spectrum> found_by_chance;
  const auto& [position, normal, facet] = query.at;
  const double reach = paths_.has_specular() || !(most_ > 0.0)
                           ? std::numeric_limits<double>::infinity()
                           : 1.0 / std::sqrt(most_);
  Eigen::Vector3d a, b;
  tangent_frame(normal, a, b);
  const std::uint64_t key = random_key(query.key, RandomPurpose::virtual_light_rays);
  const SobolPoints sobol(rays);
  for (int i = 0; i < rays; ++i) {
    const Eigen::Array4f u = sobol.point(i, key);
    const Eigen::Vector3d d = cosine_direction(u[0], u[1]);
    const Ray ray{.origin = position,
                  .direction = d.x() * a + d.y() * b + d.z() * normal,
                  .t_max = reach,
                  .origin_group = facet};
    ElementHit hit;
    caster.closest_hits({&ray, 1}, {&hit, 1});
    if (hit.facet < 0) continue;
    const auto own = random_key(key, static_cast<std::uint64_t>(i), 1);
    const auto gain = static_cast<float>(query.gain.factor(ray.direction, normal));
    sum += gain * near_light(caster, ray, hit, d.z(), query, own);
    if (paths_.is_specular(hit.facet)) {
      found_by_chance.emplace_back(gain * by_way(caster, ray, hit, query, own));
    }
  }
  if (!found_by_chance.empty()) sum += limited_sum(found_by_chance, rays, of_lights);
  return sum / static_cast<float>(rays);
}

// Radiosity at the end of a ray as far as the limit keeps virtual lights from sending it. `cosine`:
// of the ray to the normal at its start.
Spectrum VirtualLights::near_light(const ElementCaster& caster, const Ray& ray,
                                   const ElementHit& hit, double cosine, const Query& query,
                                   std::uint64_t key) const {
  const Spectrum none = Spectrum::Zero(lit_.scene.bands.count());
  if (hit.element < 0 || !paths_.is_diffuse(hit.facet)) return none;
  Eigen::Vector3d normal = element_center(lit_.mesh(), hit.element).normal;
  if (const auto* pose = caster.pose_of(hit.facet)) normal = pose->linear() * normal;
  const double kernel = cosine * std::max(0.0, -normal.dot(ray.direction)) / (hit.t * hit.t);
  if (!(kernel > most_)) return none;
  const double share = (1.0 - most_ / kernel) * paths_.base_factor(caster, ray, hit);
  if (query.radiosity) {
    return dimmed(ray, hit,
                  static_cast<float>(share) * interpolate(lit_.mesh(), *query.radiosity, hit));
  }
  if (random_uniform(random_key(key, 6)) >= share) return none;
  return dimmed(
      ray, hit,
      radiosity(caster, {hit, ray.origin + hit.t * ray.direction, normal, query.depth}, key));
}

// Light that a ray reads where it ends, as far as an absorbing body leaves it.
Spectrum VirtualLights::dimmed(const Ray& ray, const ElementHit& hit, const Spectrum& light) const {
  const Spectrum left = paths_.left_by_body(ray, hit);
  return left.size() > 0 ? Spectrum(left * light) : light;
}

// Radiosity that a ray finds behind mirrors and glass. Shadow rays to virtual lights pass clear
// panes.
Spectrum VirtualLights::by_way(const ElementCaster& caster, const Ray& ray, const ElementHit& hit,
                               const Query& query, std::uint64_t key) const {
  Spectrum B = Spectrum::Zero(lit_.scene.bands.count());
  std::uint64_t number = 0;  // of arrivals: weak ones go on by Russian roulette
  const PathLosses losses = paths_.follow(
      caster, ray, hit, key,
      [&](const LightArrival& end) {
        if (end.through_panes_only || end.hit.element < 0) return;
        const Spectrum weight = static_cast<float>(end.base_factor) * end.throughput;
        if (query.radiosity) {
          B += weight * interpolate(lit_.mesh(), *query.radiosity, end.hit);
          return;
        }
        const float chance = std::min(1.0f, weight.maxCoeff());
        const auto own = random_key(key, 7, number++);
        if (!(random_uniform(own) < static_cast<double>(chance))) return;
        const Eigen::Vector3d normal = element_center(lit_.mesh(), end.hit.element).normal;
        B += weight / chance *
             radiosity(caster, {end.hit, end.position, normal, query.depth}, random_key(own, 1));
      },
      PathQuantity::radiance);
  if (losses.sky.size() > 0 && dome_.size() > 0) {
    B += std::numbers::pi_v<float> * dome_ * losses.sky;
  }
  return B;
}

// B = M + rho (E_direct + E) + tau (the same behind), by one light of each kind. M counts where
// DirectLight leaves it to rays. One of the two sides stands for both, and light that goes to and
// fro in a corner or between sheets loses at each end what is not sent on, by Russian roulette: so
// paths do not fork, and end.
Spectrum VirtualLights::radiosity(const ElementCaster& caster, const End& end,
                                  std::uint64_t key) const {
  const PatchMesh& mesh = lit_.mesh();
  const ElementHit& hit = end.hit;
  const int p = mesh.patch[hit.element], behind = mesh.patch_behind(p);
  Spectrum B = Spectrum::Zero(mesh.emission.cols());
  if (!lit_.direct_light.owns(hit.facet, hit.from_back)) B = mesh.emission.row(p).transpose();
  const Spectrum rho = mesh.reflectance.row(p).transpose();
  Spectrum tau = Spectrum::Zero(rho.size());
  if (behind >= 0) tau = mesh.transmittance.row(p).transpose();
  // Light in a gap so narrow that every ray ends nearby loses 0.9^64 = 0.1 % to the deepest end.
  // The limit keeps the stack of a thread small.
  constexpr float most_survive = 0.9f;
  constexpr int deepest = 64;
  const float reflected = rho.maxCoeff(), passed = tau.maxCoeff(), all = reflected + passed;
  const float survival = std::min(most_survive, all);
  const double u = random_uniform(random_key(key, 2));
  if (!(u < static_cast<double>(survival)) || end.depth >= deepest) return B;
  const bool reflects = u < static_cast<double>(survival * reflected / all);
  const float chance = survival * (reflects ? reflected : passed) / all;
  const SurfacePoint at{end.position, reflects ? end.normal : Eigen::Vector3d(-end.normal),
                        hit.facet};
  const int element = reflects ? hit.element : mesh.first_element[behind];
  const std::uint64_t own = random_key(key, 3);
  const CoatedBase* base = lit_.direct_light.base_of(mesh.material[mesh.patch[element]]);
  Spectrum E = lit_.direct_light.irradiance(caster, {.at = at,
                                                     .key = own,
                                                     .shadows = {.min_rays = 1, .max_rays = 1},
                                                     .one_stands_for_all = true,
                                                     .base = base});
  if (caustics_) E += caustics_->irradiance(at.position, at.normal, element);
  E += indirect_irradiance(caster, {.at = at,
                                    .key = random_key(own, 1),
                                    .effort = 0.0f,
                                    .gain = {.base = base},
                                    .depth = end.depth + 1});
  return B + (reflects ? rho : tau) / chance * E;
}

}  // namespace lightwell
