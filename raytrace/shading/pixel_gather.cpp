#include "raytrace/shading/pixel_gather.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <span>

#include "radiosity/emitters/free_source.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/gather/gatherable_radiosity.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr int batch = 64;
// Number of a key of gap rays that no ray has.
constexpr std::uint64_t deciding = 1ULL << 40;

// Returns the direction, mirrored at the facet if it points below. The hemisphere of a smooth
// normal reaches below the facet, where a ray would meet the facet's own neighbourhood; the
// mirrored direction is the best estimate of that light.
Eigen::Vector3d above(const Eigen::Vector3d& direction, const Eigen::Vector3d& normal) {
  const double height = direction.dot(normal);
  return height < 0.0 ? Eigen::Vector3d(direction - 2.0 * height * normal) : direction;
}

// pi times the probability density of a direction after above() has mirrored the directions that
// point below.
double measure(const ShadingPoint& at, const Eigen::Vector3d& direction) {
  const double height = direction.dot(at.normal);
  if (!(height > 0.0)) return 0.0;
  const Eigen::Vector3d below = direction - 2.0 * height * at.normal;
  return std::max(direction.dot(at.smooth_normal), 0.0) +
         std::max(below.dot(at.smooth_normal), 0.0);
}

}  // namespace

PixelGather::PixelGather(const Scene& scene, const ElementCaster& caster,
                         const DirectLight& direct_light, const RadiositySolution& solution,
                         int most_rays, int max_specular_depth)
    : paths_(scene, caster, max_specular_depth),
      radiosity_(gatherable_radiosity({scene, caster, direct_light}, solution)),
      bright_(scene, caster, radiosity_),
      pictures_(caster.mesh()),
      gaps_({scene, caster, direct_light}, {caster.mesh(), radiosity_}, paths_),
      aims_(std::max(BrightPatches::aimed(most_rays), Portals::aimed(most_rays))),
      exit_aims_(GapExits::aimed(most_rays)),
      portals_(find_portals(scene, caster, brightness_of_vertices(caster.mesh(), radiosity_))) {
  if (const FreeSource* dome = direct_light.dome()) dome_ = dome->light;
  constexpr int fewest = 8;
  for (int rays = most_rays; rays >= std::min(fewest, most_rays) && rays > 0; rays /= 2) {
    sets_.emplace_back(rays);
  }
}

Spectrum PixelGather::indirect_irradiance(const ElementCaster& caster, const ShadingPoint& at,
                                          std::uint64_t key, float share) const {
  std::size_t level = 0;
  for (; share <= 0.5f && level + 1 < sets_.size(); share *= 2.0f) ++level;
  const HemisphereSets::Draw draw =
      sets_[level].draw(random_key(key, RandomPurpose::pixel_gather_rays));
  const Eigen::Matrix3d frame = draw.frame(at.smooth_normal);
  const auto points = draw.all();
  const auto count = static_cast<int>(points.size());
  Place place{.caster = caster, .at = at, .key = key, .rays = count};
  if (!bright_.is_empty()) place.bright = bright_.view(at.position, at.smooth_normal, count);
  if (portals_) place.portals = portals_->view(at.position, at.smooth_normal, count);
  std::array<Ray, batch> rays;
  std::array<ElementHit, batch> hits;
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(radiosity_.cols());
  for (std::size_t begin = 0; begin < points.size(); begin += batch) {
    const std::size_t n = std::min<std::size_t>(batch, points.size() - begin);
    for (std::size_t r = 0; r < n; ++r) {
      const HemispherePoint& p = points[begin + r];
      rays[r] = {.origin = at.position,
                 .direction = above(frame * Eigen::Vector3d(p.x, p.y, p.z), at.normal),
                 .origin_group = at.facet};
    }
    caster.closest_hits({rays.data(), n}, {hits.data(), n});
    if (begin == 0 && at.facet >= 0) {
      const SurfacePoint here{.position = at.position, .normal = at.normal, .facet = at.facet};
      place.exits =
          gaps_.even_exits(caster, here, random_key(key, RandomPurpose::gap_rays, deciding));
    }
    for (std::size_t r = 0; r < n; ++r) {
      add(place, rays[r], hits[r], begin + r, aimed_density(place, rays[r], hits[r]), sum);
    }
  }
  if (!place.bright.is_empty()) aim_at_bright(place, sum);
  if (!place.portals.is_empty()) aim_at_portals(place, sum);
  if (place.exits) aim_at_exits(place, sum);
  return (sum / static_cast<double>(points.size())).cast<float>();
}

Eigen::Vector3d PixelGather::slant(const ElementCaster& caster, const ShadingPoint& at,
                                   std::uint64_t key) const {
  const HemisphereSets::Draw draw =
      sets_.front().draw(random_key(key, RandomPurpose::pixel_gather_rays));
  const Eigen::Matrix3d frame = draw.frame(at.normal);
  const auto points = draw.all();
  const Place place{
      .caster = caster, .at = at, .key = key, .rays = static_cast<int>(2 * points.size())};
  // Greatest tangent of the angle to the normal that counts: the 10 % of the light below 18 degrees
  // would decide otherwise, while ReliefSlope::gain() limits it too.
  constexpr double steepest = 3.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double all = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const HemispherePoint& p = points[i];
    for (const double side : {1.0, -1.0}) {
      const Ray ray{.origin = at.position,
                    .direction = frame * Eigen::Vector3d(side * p.x, side * p.y, p.z),
                    .origin_group = at.facet};
      ElementHit hit;
      caster.closest_hits({&ray, 1}, {&hit, 1});
      Eigen::ArrayXd found = Eigen::ArrayXd::Zero(radiosity_.cols());
      add_flat(place, ray, hit, 2 * i + (side < 0.0 ? 1 : 0), 0.0, found);
      const double height = ray.direction.dot(at.normal);
      const Eigen::Vector3d across = ray.direction - height * at.normal;
      const double run = across.norm();
      if (!(run > 0.0)) continue;
      sum += found.sum() * std::min(run / height, steepest) / run * across;
      all += found.sum();
    }
  }
  return all > 0.0 ? Eigen::Vector3d(sum / all) : Eigen::Vector3d::Zero();
}

// Number times density, 1/sr, of rays aimed at the portals that the ray passes, and at exits.
double PixelGather::aimed_density(const Place& place, const Ray& ray, const ElementHit& hit) const {
  double sum = 0.0;
  if (!place.portals.is_empty()) {
    sum += Portals::aimed(place.rays) *
           portals_->density(place.portals, ray.origin, ray.direction, hit.t);
  }
  if (place.exits) {
    sum += GapExits::aimed(place.rays) * place.exits->density(place.at.normal, ray.direction);
  }
  return sum;
}

// Adds light of bright patches by aimed rays.
void PixelGather::aim_at_bright(const Place& place, Eigen::ArrayXd& sum) const {
  const ShadingPoint& at = place.at;
  const std::uint64_t aim_key = random_key(place.key, RandomPurpose::pixel_gather_aims);
  for (int i = 0; i < BrightPatches::aimed(place.rays); ++i) {
    const Eigen::Array4d u = aims_.point(i, aim_key).cast<double>();
    const BrightPatches::Aim aim = bright_.draw(place.bright, u[0], u[1], u[2]);
    const double cosine = measure(at, aim.direction);
    if (!(cosine > 0.0)) continue;
    const Ray ray{.origin = at.position, .direction = aim.direction, .origin_group = at.facet};
    ElementHit hit;
    place.caster.closest_hits({&ray, 1}, {&hit, 1});
    if (!bright_.counts(aim, hit) || !paths_.is_diffuse(hit.facet)) continue;
    if (is_in_gap(place, ray, hit)) continue;
    if (!place.portals.is_empty() && gaps_.is_near_portal(*portals_, ray, hit)) continue;
    double share =
        bright_.share(place.bright, cosine, place.rays, ray, hit, aimed_density(place, ray, hit));
    const double solid_angle = std::numbers::pi * share / (place.rays * cosine);
    if (!at.gain.is_plain()) share *= at.gain.factor(ray.direction, at.smooth_normal);
    sum += share * straight_radiosity(place.caster, ray, hit, solid_angle).cast<double>();
  }
}

// Adds light by rays aimed at portals, of those that pass their portal.
void PixelGather::aim_at_portals(const Place& place, Eigen::ArrayXd& sum) const {
  const ShadingPoint& at = place.at;
  const std::uint64_t aim_key = random_key(place.key, RandomPurpose::pixel_gather_portals);
  for (int i = 0; i < Portals::aimed(place.rays); ++i) {
    const Eigen::Array4d u = aims_.point(i, aim_key).cast<double>();
    const Portals::Aim aim = portals_->draw(place.portals, at.position, u[0], u[1], u[2]);
    const Ray ray{.origin = at.position, .direction = aim.direction, .origin_group = at.facet};
    if (!(measure(at, ray.direction) > 0.0)) continue;
    ElementHit hit;
    place.caster.closest_hits({&ray, 1}, {&hit, 1});
    if (!portals_->passes(aim, at.position, hit.t)) continue;
    const double aimed = aimed_density(place, ray, hit);
    add(place, ray, hit, static_cast<std::uint64_t>(place.rays + i), aimed, sum);
  }
}

// Adds light by rays aimed at the exits of a gap.
void PixelGather::aim_at_exits(const Place& place, Eigen::ArrayXd& sum) const {
  const ShadingPoint& at = place.at;
  const int count = GapExits::aimed(place.rays);
  constexpr std::uint64_t exits = 1;
  const std::uint64_t aim_key = random_key(place.key, RandomPurpose::pixel_gather_aims, exits);
  for (int i = 0; i < count; ++i) {
    const Eigen::Array4d u = exit_aims_.point(i, aim_key).cast<double>();
    const Ray ray{.origin = at.position,
                  .direction = place.exits->draw(at.normal, u[0], u[1], u[2]),
                  .origin_group = at.facet};
    if (!(measure(at, ray.direction) > 0.0)) continue;
    ElementHit hit;
    place.caster.closest_hits({&ray, 1}, {&hit, 1});
    add(place, ray, hit, static_cast<std::uint64_t>(2 * place.rays + i),
        aimed_density(place, ray, hit), sum);
  }
}

bool PixelGather::is_in_gap(const Place& place, const Ray& ray, const ElementHit& hit) const {
  return gaps_.stays_in(place.caster, place.exits ? &*place.exits : nullptr, place.at.normal, ray,
                        hit);
}

// Adds what a ray finds, times the point's gain.
void PixelGather::add(const Place& place, const Ray& ray, const ElementHit& hit,
                      std::uint64_t index, double aimed, Eigen::ArrayXd& sum) const {
  const ReceiverGain& gain = place.at.gain;
  if (gain.is_plain()) return add_flat(place, ray, hit, index, aimed, sum);
  Eigen::ArrayXd found = Eigen::ArrayXd::Zero(sum.size());
  add_flat(place, ray, hit, index, aimed, found);
  sum += gain.factor(ray.direction, place.at.smooth_normal) * found;
}

// Adds what a ray finds, by the balance heuristic. `aimed` is aimed_density(); `index` numbers the
// rays of the place.
void PixelGather::add_flat(const Place& place, const Ray& ray, const ElementHit& hit,
                           std::uint64_t index, double aimed, Eigen::ArrayXd& sum) const {
  if (hit.facet < 0) return;
  const std::uint64_t key = random_key(place.key, RandomPurpose::pixel_gather_paths, index);
  const double cosine = measure(place.at, ray.direction);
  const double by_cosine = place.rays * cosine * std::numbers::inv_pi;
  Shares shares;
  if (aimed > 0.0) shares.straight = shares.by_way = by_cosine / (by_cosine + aimed);
  if (is_in_gap(place, ray, hit) || (aimed > 0.0 && gaps_.is_narrow(place.caster, ray, hit))) {
    const GapAims aims{.exits = place.exits ? &*place.exits : nullptr,
                       .portals = place.portals.is_empty() ? nullptr : portals_.get()};
    if (shares.by_way == 1.0) {
      gaps_.add(place.caster, ray, hit, key, sum, aims);
      return;
    }
    Eigen::ArrayXd found = Eigen::ArrayXd::Zero(sum.size());
    gaps_.add(place.caster, ray, hit, key, found, aims);
    sum += shares.by_way * found;
    return;
  }
  if (!place.portals.is_empty() && gaps_.is_near_portal(*portals_, ray, hit)) {
    Eigen::ArrayXd found = Eigen::ArrayXd::Zero(sum.size());
    gaps_.add_near_portal(place.caster, *portals_, ray, hit, key, found);
    sum += shares.by_way * found;
    return;
  }
  if (!place.bright.is_empty()) {
    shares.straight = bright_.share(place.bright, cosine, place.rays, ray, hit, aimed);
  }
  shares.solid_angle = std::numbers::pi * shares.straight / (place.rays * cosine);
  sum += arriving(place.caster, ray, hit, key, shares).cast<double>();
}

// Radiosity B that a ray finds straight where it ends, for a ray that stands for `solid_angle`.
Spectrum PixelGather::straight_radiosity(const ElementCaster& caster, const Ray& ray,
                                         const ElementHit& hit, double solid_angle) const {
  Spectrum B = static_cast<float>(paths_.base_factor(caster, ray, hit)) *
               interpolate(caster.mesh(), radiosity_, hit);
  const Spectrum left = paths_.left_by_body(ray, hit);
  if (left.size() > 0) B *= left;
  return pictures_.varies(hit.element) ? Spectrum(B * pictures_.factor(ray, hit, solid_angle)) : B;
}

// Radiosity B at the end of a ray, weighted by `shares`.
Spectrum PixelGather::arriving(const ElementCaster& caster, const Ray& ray, const ElementHit& hit,
                               std::uint64_t key, const Shares& shares) const {
  const PatchMesh& mesh = caster.mesh();
  Spectrum B = Spectrum::Zero(radiosity_.cols());
  if (hit.element >= 0 && paths_.is_diffuse(hit.facet)) {
    B = static_cast<float>(shares.straight) *
        straight_radiosity(caster, ray, hit, shares.solid_angle);
  }
  if (!paths_.is_specular(hit.facet)) return B;
  const auto by_way = static_cast<float>(shares.by_way);
  const PathLosses losses = paths_.follow(
      caster, ray, hit, key,
      [&](const LightArrival& end) {
        B += by_way * static_cast<float>(end.base_factor) * end.throughput *
             interpolate(mesh, radiosity_, end.hit);
      },
      PathQuantity::radiance);
  if (losses.sky.size() > 0 && dome_.size() > 0) {
    B += std::numbers::pi_v<float> * by_way * dome_ * losses.sky;
  }
  return B;
}

}  // namespace lightwell
