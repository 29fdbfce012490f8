#include "radiosity/gather/gap_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>

#include "mesh/patches/patch_sampler.h"
#include "radiosity/emitters/free_source.h"
#include "scene/random_purpose.h"
#include "scene/rays/surface_ray.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// A path that is still in the gap after so many bounces reads the mesh. Of surfaces that reflect 90
// % one path in a thousand is, and of white ones, between which light is alike everywhere, many.
constexpr int most_bounces = 64;
// Bounces from which on direct light is computed at one surface of so many: hardly any of it comes
// so far into a gap.
constexpr int deep = 4, surfaces_for_one = 4;
// Number of the key of rays near a portal.
constexpr std::uint64_t near_portal = 16;
// Size of the largest gaps, in gap_sizes().
constexpr double sizes_wide = 8.0;
// Narrower gaps are contacts: which of two surfaces in one plane a ray meets is a matter of
// rounding.
constexpr double narrowest_gap = 1e-4;
// Many rays end in a gap, so each needs one light and one shadow ray.
constexpr ShadowOptions shadows{.min_rays = 1, .max_rays = 1};

// Distance, metres, of the portals that a ray from where another ended is aimed at. No element is
// larger than its patch, so the portals of Portals::is_near() are among them. Portals farther
// away are left to rays that meet them by chance.
double portal_reach(const PatchMesh& mesh, const ElementHit& hit) {
  return Portals::near_sizes * std::sqrt(mesh.area[mesh.patch[hit.element]]);
}

// The share of rays from a surface that is aimed. Light of surfaces that reflect much goes on
// inside the gap for longer.
float share_aimed(float reflectance) {
  return std::clamp(1.0f - reflectance, 0.2f, 0.5f);
}

// Adds light to the columns from `column` on, or to the only ones where channels are not apart.
void add_to(const LitScene& lit, Eigen::Index column, const Spectrum& light, Eigen::ArrayXd& sum) {
  const bool by_channel = lit.direct_light.column_count() == sum.size();
  sum.segment(by_channel ? column : 0, light.size()) += light.cast<double>();
}

// Adds what a luminaire sends by way of mirrors and glass. Elsewhere the mesh holds such light as
// caustics, and no ray reads it. Light computed anew on a surface has no part of the mesh's.
void add_lamp(const LitScene& lit, const LightArrival& arrival, const Spectrum& share,
              Eigen::ArrayXd& sum) {
  const ElementHit& hit = arrival.hit;
  const bool is_direct = arrival.through_panes_only;
  if (is_direct || !lit.direct_light.owns(hit.facet, hit.from_back)) return;
  const PatchMesh& mesh = lit.mesh();
  const Spectrum M = mesh.emission.row(mesh.patch[hit.element]).transpose();
  add_to(lit, lit.direct_light.first_column(hit.facet), share * M, sum);
}

// Adds light of the dome that a path by way of mirrors and glass escapes to.
void add_dome(const LitScene& lit, const PathLosses& losses, const Spectrum& share,
              Eigen::ArrayXd& sum) {
  const FreeSource* const dome = lit.direct_light.dome();
  if (losses.sky.size() == 0 || !dome) return;
  add_to(lit, dome->channel * share.size(),
         std::numbers::pi_v<float> * share * dome->light * losses.sky, sum);
}

}  // namespace

Eigen::Vector3d GapLight::normal_towards(const Ray& ray, const ElementHit& hit) const {
  const Eigen::Vector3d normal = element_center(lit_.mesh(), hit.element).normal;
  return normal.dot(ray.direction) > 0.0 ? Eigen::Vector3d(-normal) : normal;
}

bool GapLight::is_gap(const Eigen::Vector3d& normal, const Ray& ray, const ElementHit& hit) const {
  if (hit.element < 0) return false;
  const auto size = static_cast<double>(sizes_[static_cast<std::size_t>(hit.element)]);
  // Surfaces that face each other are at most twice as far apart along one normal as along the
  // other. Most rays end here, before the other normal is needed.
  const double height = hit.t * std::abs(ray.direction.dot(normal));
  if (!(height < 2.0 * widest_ * size) || !may_be_followed(hit)) return false;
  const Eigen::Vector3d other = normal_towards(ray, hit);
  const double width = hit.t * std::abs(ray.direction.dot(other));
  return other.dot(normal) < facing && width < widest(ray, hit) * size &&
         width > narrowest_gap * size;
}

// The greatest width of a gap between the facet that a ray begins on and the one that it meets, as
// a share of the size. The absorptances of the two have a mean, since light meets both in turn.
double GapLight::widest(const Ray& ray, const ElementHit& hit) const {
  const auto absorbed = [&](int facet) {
    return static_cast<double>(absorptances_[static_cast<std::size_t>(facet)]);
  };
  const double at_end = absorbed(hit.facet);
  const double at_begin = ray.origin_group < 0 ? at_end : absorbed(ray.origin_group);
  return widest_ * widest_between(0.5 * (at_begin + at_end));
}

// True if the surface reflects diffusely, mirrors by a coat at most, passes no light and does not
// emit.
bool GapLight::may_be_followed(const ElementHit& hit) const {
  const PatchMesh& mesh = lit_.mesh();
  const int patch = mesh.patch[hit.element];
  return paths_.is_mostly_diffuse(hit.facet) && !(mesh.emission.row(patch) > 0.0f).any() &&
         (mesh.reflectance.row(patch) > 0.0f).any() && mesh.patch_behind(patch) < 0;
}

// True if a ray ends on a surface between the two that the gap is between: both are near along the
// normal `across` of the gap.
bool GapLight::is_closed_end(const ElementCaster& caster, const Eigen::Vector3d& across,
                             double width, const Ray& ray, const ElementHit& hit) const {
  // Rays run above the end, where the surfaces stand on it, and gaps may widen towards it.
  constexpr double upright = 0.5, height = 0.25, widest = 2.0;
  if (hit.element < 0 || !may_be_followed(hit)) return false;
  const Eigen::Vector3d normal = normal_towards(ray, hit);
  if (std::abs(normal.dot(across)) > upright) return false;
  const Eigen::Vector3d at = ray.origin + hit.t * ray.direction + height * width * normal;
  return std::ranges::all_of(std::array{1.0, -1.0}, [&](double side) {
    const Ray ray_across{.origin = at, .direction = side * across, .t_max = widest * width};
    std::uint8_t is_near = 0;
    caster.occluded({&ray_across, 1}, {&is_near, 1});
    return is_near != 0;
  });
}

bool GapLight::is_narrow(const ElementCaster& caster, const Ray& ray, const ElementHit& hit) const {
  if (hit.element < 0 || !may_be_followed(hit)) return false;
  const double size = std::sqrt(lit_.mesh().element_area[hit.element]);
  const Ray across{.origin = ray.origin + hit.t * ray.direction,
                   .direction = normal_towards(ray, hit),
                   .t_max = widest_ * size,
                   .origin_group = hit.facet};
  ElementHit opposite;
  caster.closest_hits({&across, 1}, {&opposite, 1});
  return opposite.element >= 0 && opposite.t < widest(across, opposite) * size &&
         opposite.t > narrowest_gap * size &&
         normal_towards(across, opposite).dot(across.direction) < facing;
}

void GapLight::add_direct(const ElementCaster& caster, const Stop& stop,
                          Eigen::ArrayXd& sum) const {
  const LightQuery query{
      .at = stop.at, .key = stop.key, .shadows = shadows, .one_stands_for_all = true};
  const Spectrum& share = stop.share;
  const Eigen::Index bands = share.size();
  Eigen::ArrayXf E = Eigen::ArrayXf::Zero(sum.size());
  if (lit_.direct_light.column_count() == sum.size()) {
    lit_.direct_light.add_irradiance(caster, query, E.data());
  } else {
    E = lit_.direct_light.irradiance(caster, query);
  }
  for (Eigen::Index k = 0; k < E.size(); k += bands) {
    sum.segment(k, bands) += (share * E.segment(k, bands)).cast<double>();
  }
}

// Leaves of a share what an absorbing body leaves on the way of a ray.
void GapLight::dim(const Ray& ray, const ElementHit& hit, Spectrum& share) const {
  const Spectrum left = paths_.left_by_body(ray, hit);
  if (left.size() > 0) share *= left;
}

// Adds the radiosity where a ray ends, also through mirrors and glass.
void GapLight::add_end(const ElementCaster& caster, const Ray& ray, const ElementHit& hit,
                       std::uint64_t key, const Spectrum& share, Eigen::ArrayXd& sum) const {
  if (hit.facet < 0) return;
  if (hit.element >= 0 && paths_.is_diffuse(hit.facet)) {
    Spectrum straight = static_cast<float>(paths_.base_factor(caster, ray, hit)) * share;
    dim(ray, hit, straight);
    radiosity_.add(hit, straight, sum);
  }
  if (!paths_.is_specular(hit.facet)) return;
  const PathLosses losses = paths_.follow(
      caster, ray, hit, key,
      [&](const LightArrival& arrival) {
        if (arrival.hit.element < 0) return;
        const Spectrum passed = share * arrival.throughput;
        radiosity_.add(arrival.hit, Spectrum(static_cast<float>(arrival.base_factor) * passed),
                       sum);
        add_lamp(lit_, arrival, passed, sum);
      },
      PathQuantity::radiance);
  add_dome(lit_, losses, share, sum);
}

// The gap that a point lies in, if few rays get out of it by themselves.
std::optional<GapLight::GapSize> GapLight::gap_around(const ElementCaster& caster,
                                                      const SurfacePoint& at,
                                                      std::uint64_t key) const {
  const Ray across{.origin = at.position, .direction = at.normal, .origin_group = at.facet};
  ElementHit hit;
  caster.closest_hits({&across, 1}, {&hit, 1});
  if (!is_gap(at.normal, across, hit)) return std::nullopt;
  // Near the brink of a gap many rays get out by themselves. The rays that decide have no part in
  // the light: a gather that aims where few of its own rays got out would be too bright.
  constexpr std::size_t deciding = 16, many = 8;
  std::array<Ray, deciding> rays;
  std::array<ElementHit, deciding> hits;
  for (std::size_t i = 0; i < deciding; ++i) rays[i] = cosine_ray(at, random_key(key, i));
  caster.closest_hits(rays, hits);
  std::size_t out = 0;
  for (std::size_t i = 0; i < deciding; ++i) out += is_gap(at.normal, rays[i], hits[i]) ? 0 : 1;
  if (many * out > deciding) return std::nullopt;
  const auto size = static_cast<double>(sizes_[static_cast<std::size_t>(hit.element)]);
  return GapSize{.width = hit.t, .reach = sizes_wide * size};
}

std::optional<GapExits> GapLight::exits(const ElementCaster& caster, const SurfacePoint& at,
                                        int count, std::uint64_t key) const {
  if (count < GapExits::fewest_rays) return std::nullopt;
  constexpr std::uint64_t deciding = 1;
  const auto gap = gap_around(caster, at, random_key(key, deciding));
  if (!gap) return std::nullopt;
  return GapExits(caster, at, gap->width, gap->reach, key,
                  [&](const Ray& ray, const ElementHit& end) {
                    return end.facet >= 0 && !is_gap(at.normal, ray, end) &&
                           !is_closed_end(caster, at.normal, gap->width, ray, end);
                  });
}

std::optional<GapExits> GapLight::even_exits(const ElementCaster& caster, const SurfacePoint& at,
                                             std::uint64_t key) const {
  const auto gap = gap_around(caster, at, key);
  if (!gap) return std::nullopt;
  return GapExits(at, gap->width, gap->reach);
}

// Draws the next ray of a path from a surface, and finds its end. A `share` of the rays is aimed:
// at exits or at the portals of `view`. Returns the ray's weight; 0: it counts for nothing.
double GapLight::next_ray(const ElementCaster& caster, const GapAims& aims,
                          const Portals::View& view, double share, Stop& stop) const {
  const Eigen::Vector3d& from = stop.at.position;
  const auto number = [&](std::uint64_t i) { return random_uniform(random_key(stop.key, i)); };
  stop.ray = cosine_ray(stop.at, stop.key);
  const bool is_aimed = share > 0.0 && number(4) < share;
  Portals::Aim at_portal;
  if (is_aimed && aims.exits) {
    stop.ray.direction = aims.exits->draw(stop.at.normal, number(5), number(6), number(7));
  } else if (is_aimed) {
    at_portal = aims.portals->draw(view, from, number(5), number(6), number(7));
    stop.ray.direction = at_portal.direction;
  }
  const double by_cosine = stop.ray.direction.dot(stop.at.normal) * std::numbers::inv_pi;
  if (!(by_cosine > 0.0)) return 0.0;
  caster.closest_hits({&stop.ray, 1}, {&stop.hit, 1});
  if (stop.hit.facet < 0) return 0.0;
  if (at_portal.portal >= 0 && !aims.portals->passes(at_portal, from, stop.hit.t)) return 0.0;
  if (!(share > 0.0)) return 1.0;
  const double aimed = aims.exits
                           ? aims.exits->density(stop.at.normal, stop.ray.direction)
                           : aims.portals->density(view, from, stop.ray.direction, stop.hit.t);
  return by_cosine / ((1.0 - share) * by_cosine + share * aimed);
}

void GapLight::follow(const ElementCaster& caster, const Ray& ray, const ElementHit& hit,
                      std::uint64_t key, const GapAims& aims, const Visitor& visitor) const {
  const PatchMesh& mesh = lit_.mesh();
  const GapExits* const exits = aims.exits;
  Stop stop{.ray = ray, .hit = hit, .share = Spectrum::Ones(lit_.scene.bands.count())};
  for (int bounce = 0; bounce < most_bounces; ++bounce) {
    stop.key = random_key(key, RandomPurpose::gap_rays, static_cast<std::uint64_t>(bounce));
    stop.bounce = bounce;
    if (paths_.is_specular(stop.hit.facet)) visitor.at_coat(stop);
    dim(stop.ray, stop.hit, stop.share);
    stop.share *= static_cast<float>(paths_.base_factor(caster, stop.ray, stop.hit));
    const Eigen::Vector3d normal = normal_towards(stop.ray, stop.hit);
    stop.at = {.position = stop.ray.origin + stop.hit.t * stop.ray.direction,
               .normal = normal,
               .facet = stop.hit.facet};
    Portals::View view;
    if (aims.portals && !exits) {
      view = aims.portals->view_near(stop.at.position, normal, portal_reach(mesh, stop.hit));
    }
    // Paths end by chance (Arvo & Kirk 1990), at once or after as many bounces as light makes. The
    // rays that are not aimed weigh more, and more paths go on instead.
    const auto rho = mesh.reflectance.row(mesh.patch[stop.hit.element]);
    const float aimed = exits || !view.is_empty() ? share_aimed(rho.maxCoeff()) : 0.0f;
    const float survival = std::min(1.0f, rho.maxCoeff() / (1.0f - aimed));
    if (random_uniform(random_key(stop.key, 3)) >= static_cast<double>(survival)) return;
    stop.share *= rho.transpose() / survival;
    if (bounce < deep) {
      visitor.at_surface(stop);
    } else if (random_uniform(random_key(stop.key, 8)) * surfaces_for_one < 1.0) {
      Stop for_all = stop;
      for_all.share *= static_cast<float>(surfaces_for_one);
      visitor.at_surface(for_all);
    }
    const double weight = next_ray(caster, aims, view, double{aimed}, stop);
    if (!(weight > 0.0)) return;
    stop.share *= static_cast<float>(weight);
    if (bounce + 1 < most_bounces && stays_in(caster, exits, normal, stop.ray, stop.hit)) continue;
    visitor.at_end(stop);
    return;
  }
}

void GapLight::add(const ElementCaster& caster, const Ray& ray, const ElementHit& hit,
                   std::uint64_t key, Eigen::ArrayXd& sum, const GapAims& aims) const {
  follow(caster, ray, hit, key, aims,
         {.at_surface = [&](const Stop& stop) { add_direct(caster, stop, sum); },
          .at_coat = [&](const Stop& stop) { add_mirrored(caster, stop, sum); },
          .at_end =
              [&](const Stop& stop) {
                add_end(caster, stop.ray, stop.hit, stop.key, stop.share, sum);
              }});
}

// Adds the radiosity of the diffuse base where a mirrored ray ends in a gap, with the share and key
// of `from`. Weak light goes on by chance (Arvo & Kirk 1990): paths between two coats would grow
// without end otherwise. The coat at the end, if any, is left to the mirrored path.
void GapLight::add_base(const ElementCaster& caster, const Ray& ray, const ElementHit& hit,
                        const Stop& from, Eigen::ArrayXd& sum) const {
  const float chance = std::min(from.share.maxCoeff(), 1.0f);
  if (!(random_uniform(random_key(from.key, 9)) < static_cast<double>(chance))) return;
  const Spectrum share = from.share / chance;
  Eigen::ArrayXd found = Eigen::ArrayXd::Zero(sum.size());
  follow(caster, ray, hit, random_key(from.key, 10), {},
         {.at_surface = [&](const Stop& stop) { add_direct(caster, stop, found); },
          .at_coat =
              [&](const Stop& stop) {
                if (stop.bounce > 0) add_mirrored(caster, stop, found);
              },
          .at_end =
              [&](const Stop& stop) {
                add_end(caster, stop.ray, stop.hit, stop.key, stop.share, found);
              }});
  for (Eigen::Index k = 0; k < sum.size(); k += share.size()) {
    sum.segment(k, share.size()) += share.cast<double>() * found.segment(k, share.size());
  }
}

// Adds light that a coat in a gap mirrors. Mirrored rays that end in the gap do not read the mesh
// there either.
void GapLight::add_mirrored(const ElementCaster& caster, const Stop& stop,
                            Eigen::ArrayXd& sum) const {
  Eigen::Vector3d from = stop.ray.origin + stop.hit.t * stop.ray.direction;
  Eigen::Vector3d normal = normal_towards(stop.ray, stop.hit);
  Stop next{.key = random_key(stop.key, 11)};
  const PathLosses losses = paths_.follow(
      caster, stop.ray, stop.hit, next.key,
      [&](const LightArrival& arrival) {
        if (arrival.hit.element < 0) return;
        next.share = stop.share * arrival.throughput;
        next.key = random_key(next.key, 12);
        const Ray ray{.origin = from, .direction = arrival.position - from};
        ElementHit hit = arrival.hit;
        hit.t = 1.0f;
        // The path has dimmed its light in absorbing bodies, which a path in a gap would do again.
        if (is_gap(normal, ray, hit) && paths_.left_by_body(ray, hit).size() == 0) {
          add_base(caster, ray, hit, next, sum);
        } else {
          radiosity_.add(arrival.hit,
                         Spectrum(static_cast<float>(arrival.base_factor) * next.share), sum);
        }
        add_lamp(lit_, arrival, next.share, sum);
        from = arrival.position;
        normal = normal_towards(ray, hit);
      },
      PathQuantity::radiance);
  add_dome(lit_, losses, stop.share, sum);
}

bool GapLight::is_near_portal(const Portals& portals, const Ray& ray, const ElementHit& hit) const {
  return hit.element >= 0 && may_be_followed(hit) &&
         portals.is_near(ray.origin + hit.t * ray.direction,
                         std::sqrt(lit_.mesh().element_area[hit.element]));
}

void GapLight::add_near_portal(const ElementCaster& caster, const Portals& portals,
                               const Ray& first_ray, const ElementHit& first_hit, std::uint64_t key,
                               Eigen::ArrayXd& sum) const {
  const PatchMesh& mesh = lit_.mesh();
  const SurfacePoint at{.position = first_ray.origin + first_hit.t * first_ray.direction,
                        .normal = normal_towards(first_ray, first_hit),
                        .facet = first_hit.facet};
  const std::uint64_t portal_key = random_key(key, RandomPurpose::gap_rays, near_portal);
  Spectrum rho = mesh.reflectance.row(mesh.patch[first_hit.element]).transpose();
  if (paths_.is_specular(first_hit.facet)) {
    add_mirrored(caster,
                 {.ray = first_ray,
                  .hit = first_hit,
                  .share = Spectrum::Ones(rho.size()),
                  .key = portal_key},
                 sum);
  }
  dim(first_ray, first_hit, rho);
  rho *= static_cast<float>(paths_.base_factor(caster, first_ray, first_hit));
  add_direct(caster, {.at = at, .share = rho, .key = portal_key}, sum);
  const Portals::View view =
      portals.view_near(at.position, at.normal, portal_reach(mesh, first_hit));
  const GapAims aims{.portals = &portals};
  Stop stop{.at = at, .key = portal_key};
  const double weight = next_ray(caster, aims, view, view.is_empty() ? 0.0 : 0.5, stop);
  if (!(weight > 0.0)) return;
  const auto& [ray, hit] = std::tie(stop.ray, stop.hit);
  const bool passes = portals.density(view, at.position, ray.direction, hit.t) > 0.0;
  const Spectrum share = static_cast<float>(weight) * rho;
  if (is_gap(at.normal, ray, hit) || (passes && is_narrow(caster, ray, hit))) {
    Eigen::ArrayXd found = Eigen::ArrayXd::Zero(sum.size());
    add(caster, ray, hit, portal_key, found, aims);
    for (Eigen::Index k = 0; k < sum.size(); k += rho.size()) {
      sum.segment(k, rho.size()) += share.cast<double>() * found.segment(k, rho.size());
    }
  } else {
    add_end(caster, ray, hit, portal_key, share, sum);
  }
}

}  // namespace lightwell
