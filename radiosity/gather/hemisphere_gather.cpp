#include "radiosity/gather/hemisphere_gather.h"

#include <algorithm>
#include <numbers>
#include <tuple>
#include <utility>

#include "radiosity/emitters/free_source.h"
#include "scene/random_purpose.h"

namespace lightwell {
namespace {

constexpr int gather_batch = 128;
// Numbers of keys of gap rays that no ray has.
constexpr std::uint64_t pilots = 1ULL << 40, exit_aims = pilots + 1;

int ray_count(const GatherPoint& at, const GatherOptions& options) {
  return at.rays > 0 ? at.rays : std::max(1, options.rays);
}

}  // namespace

HemisphereGather::HemisphereGather(const LitScene& lit, const BandArray& radiosity,
                                   const GatherOptions& options, const GatherPoints& points)
    : HemisphereGather(lit, ReadRadiosity(lit.mesh(), radiosity),
                       BrightPatches(lit.scene, lit.caster, radiosity), options, points) {}

HemisphereGather::HemisphereGather(const LitScene& lit, const GatherOptions& options,
                                   const GatherPoints& points)
    : HemisphereGather(lit, ReadRadiosity(lit.mesh(), lit.scene.bands.count()), BrightPatches(),
                       options, points) {}

HemisphereGather::HemisphereGather(const LitScene& lit, ReadRadiosity radiosity,
                                   BrightPatches bright, const GatherOptions& options,
                                   const GatherPoints& points)
    : caster_(lit.caster),
      radiosity_(radiosity),
      paths_(lit.scene, lit.caster, options.max_specular_depth),
      options_(options),
      bands_(lit.scene.bands.count()),
      bright_(std::move(bright)),
      gaps_(lit, radiosity, paths_,
            options.aims_out_of_gaps ? widest_gap_at_readings : widest_gap) {
  if (const FreeSource* dome = lit.direct_light.dome()) {
    dome_ = dome->light;
    if (lit.direct_light.column_count() == radiosity.columns())
      dome_column_ = dome->channel * bands_;
  }
  for (int i = 0; i < points.size(); ++i) {
    const int rays = ray_count(points[i], options);
    if (!sets_.contains(rays)) sets_.emplace(rays, HemisphereSets(rays));
    if (!bright_.is_empty() && !aims_.contains(rays)) {
      aims_.emplace(rays, SobolPoints(bright_.aimed(rays)));
    }
    if (options.portals && !portal_aims_.contains(rays)) {
      portal_aims_.emplace(rays, SobolPoints(Portals::aimed(rays)));
    }
  }
}

void HemisphereGather::gather(const GatherPoint& at, std::uint64_t key, float* irradiance,
                              float& variance) const {
  Place place{.at = at, .key = key};
  const Sums sum = sums(place);
  Eigen::Map<Eigen::ArrayXf>(irradiance, radiosity_.columns()) =
      ((sum[0] + sum[1]) / place.rays).cast<float>();
  variance = half_difference(sum, place.rays);
}

Eigen::ArrayX2d HemisphereGather::gather_at_base(const GatherPoint& at, std::uint64_t key,
                                                 const CoatedBase& base) const {
  const Eigen::Index columns = radiosity_.columns();
  AtBase at_base{.base = base, .light = Eigen::ArrayXd::Zero(columns)};
  Place place{.at = at, .key = key, .at_base = &at_base};
  const Sums sum = sums(place);
  Eigen::ArrayX2d light(columns, 2);
  light.col(0) = at_base.factors > 0.0 ? Eigen::ArrayXd(at_base.light / at_base.factors)
                                       : Eigen::ArrayXd(Eigen::ArrayXd::Zero(columns));
  light.col(1) = (sum[0] + sum[1]) / place.rays;
  return light;
}

// Adds what `add` finds along a ray to a sum, and by the base's factor to what the base gets.
template <class Add>
void HemisphereGather::add_to(const Place& place, const Ray& ray, Eigen::ArrayXd& sum, Add&& add) {
  if (!place.at_base) return add(sum);
  Eigen::ArrayXd found = Eigen::ArrayXd::Zero(sum.size());
  add(found);
  sum += found;
  place.at_base->light +=
      place.at_base->base.factor(place.at.normal.dot(ray.direction.normalized())) * found;
}

// The light of all rays of a place; completes the place.
HemisphereGather::Sums HemisphereGather::sums(Place& place) const {
  const auto& [at, key] = std::tie(place.at, place.key);
  const Eigen::Index columns = radiosity_.columns();
  Sums sum{Eigen::ArrayXd::Zero(columns), Eigen::ArrayXd::Zero(columns)};
  const HemisphereSets& set = sets_.at(ray_count(at, options_));
  const HemisphereSets::Draw draw = set.draw(random_key(key, RandomPurpose::gather_rays));
  const Eigen::Matrix3d frame = draw.frame(at.normal);
  const int count = place.rays = set.count();
  if (!bright_.is_empty()) place.bright = bright_.view(at.position, at.normal, count);
  if (options_.portals) place.portals = options_.portals->view(at.position, at.normal, count);
  std::array<Ray, gather_batch> ray;
  std::array<ElementHit, gather_batch> hit;
  for (int begin = 0; begin < set.count(); begin += gather_batch) {
    const auto points =
        draw.all().subspan(static_cast<std::size_t>(begin),
                           static_cast<std::size_t>(std::min(gather_batch, set.count() - begin)));
    const std::size_t n = points.size();
    for (std::size_t r = 0; r < n; ++r) {
      ray[r] = {.origin = at.position,
                .direction = frame * Eigen::Vector3d(points[r].x, points[r].y, points[r].z),
                .origin_group = at.facet};
    }
    caster_.closest_hits({ray.data(), n}, {hit.data(), n});
    if (begin == 0 && options_.aims_out_of_gaps && at.facet >= 0) {
      const SurfacePoint here{.position = at.position, .normal = at.normal, .facet = at.facet};
      place.exits =
          gaps_.exits(caster_, here, count, random_key(key, RandomPurpose::gap_rays, pilots));
    }
    for (std::size_t r = 0; r < n; ++r) {
      const std::uint64_t index = static_cast<std::uint64_t>(begin) + r;
      const int rank = begin / HemisphereSets::block * HemisphereSets::block + points[r].rank;
      add_to(place, ray[r], sum[rank < count / 2 ? 0 : 1], [&](Eigen::ArrayXd& half) {
        add(place, ray[r], hit[r], index, aimed_density(place, ray[r], hit[r]), half);
      });
      if (place.at_base) {
        place.at_base->factors += place.at_base->base.factor(at.normal.dot(ray[r].direction));
      }
    }
  }
  if (!place.bright.is_empty()) aim_at_bright(place, sum);
  if (!place.portals.is_empty()) aim_at_portals(place, sum);
  if (place.exits) aim_at_exits(place, sum);
  return sum;
}

// Number times density, 1/sr, of rays aimed at the portals that the ray passes, and at exits.
double HemisphereGather::aimed_density(const Place& place, const Ray& ray,
                                       const ElementHit& hit) const {
  double sum = 0.0;
  if (!place.portals.is_empty()) {
    sum += Portals::aimed(place.rays) *
           options_.portals->density(place.portals, ray.origin, ray.direction, hit.t);
  }
  if (place.exits) {
    sum += GapExits::aimed(place.rays) * place.exits->density(place.at.normal, ray.direction);
  }
  return sum;
}

// Adds rays towards bright patches; each counts only the light straight from a bright element.
void HemisphereGather::aim_at_bright(const Place& place, Sums& sum) const {
  const GatherPoint& at = place.at;
  const SobolPoints& aims = aims_.at(place.rays);
  std::array<Ray, gather_batch> ray;
  std::array<ElementHit, gather_batch> hit;
  std::array<BrightPatches::Aim, gather_batch> aim;
  for (int begin = 0; begin < aims.count(); begin += gather_batch) {
    const auto n = static_cast<std::size_t>(std::min(gather_batch, aims.count() - begin));
    for (std::size_t r = 0; r < n; ++r) {
      const Eigen::Array4d u =
          aims.point(begin + static_cast<int>(r), random_key(place.key, RandomPurpose::gather_aims))
              .cast<double>();
      aim[r] = bright_.draw(place.bright, u[0], u[1], u[2]);
      ray[r] = {.origin = at.position, .direction = aim[r].direction, .origin_group = at.facet};
    }
    caster_.closest_hits({ray.data(), n}, {hit.data(), n});
    for (std::size_t r = 0; r < n; ++r) {
      if (!bright_.counts(aim[r], hit[r]) || !paths_.is_diffuse(hit[r].facet)) continue;
      if (is_in_gap(place, ray[r], hit[r])) continue;
      if (is_near_portal(place, ray[r], hit[r])) continue;
      const bool is_first = begin + static_cast<int>(r) < aims.count() / 2;
      const double share = bright_.share(place.bright, at.normal.dot(ray[r].direction), place.rays,
                                         ray[r], hit[r], aimed_density(place, ray[r], hit[r]));
      add_to(place, ray[r], sum[is_first ? 0 : 1],
             [&](Eigen::ArrayXd& half) { add_straight(place, ray[r], hit[r], share, half); });
    }
  }
}

// Adds rays towards portals. Each counts whatever it finds, if it passes its portal.
void HemisphereGather::aim_at_portals(const Place& place, Sums& sum) const {
  const Portals& portals = *options_.portals;
  const Eigen::Vector3d& from = place.at.position;
  aim(
      place, portal_aims_.at(place.rays), random_key(place.key, RandomPurpose::gather_portals),
      place.rays,
      [&](const Eigen::Array4d& u) { return portals.draw(place.portals, from, u[0], u[1], u[2]); },
      [&](const Portals::Aim& aim, double distance) { return portals.passes(aim, from, distance); },
      sum);
}

// Adds rays towards the exits of a gap. Each counts whatever it finds.
void HemisphereGather::aim_at_exits(const Place& place, Sums& sum) const {
  struct Aim {
    Eigen::Vector3d direction;
  };
  aim(
      place, SobolPoints(GapExits::aimed(place.rays)),
      random_key(place.key, RandomPurpose::gap_rays, exit_aims), 2 * place.rays,
      [&](const Eigen::Array4d& u) {
        return Aim{place.exits->draw(place.at.normal, u[0], u[1], u[2])};
      },
      [](const Aim&, double) { return true; }, sum);
}

// Adds aimed rays, which `draw` makes of four random numbers, and which are numbered from
// `first_index` on. `counts` decides by a ray's aim and length.
template <class Draw, class Counts>
void HemisphereGather::aim(const Place& place, const SobolPoints& aims, std::uint64_t key,
                           int first_index, Draw draw, Counts counts, Sums& sum) const {
  const GatherPoint& at = place.at;
  std::array<Ray, gather_batch> ray;
  std::array<ElementHit, gather_batch> hit;
  std::array<decltype(draw(Eigen::Array4d())), gather_batch> drawn;
  for (int begin = 0; begin < aims.count(); begin += gather_batch) {
    const auto n = static_cast<std::size_t>(std::min(gather_batch, aims.count() - begin));
    for (std::size_t r = 0; r < n; ++r) {
      drawn[r] = draw(aims.point(begin + static_cast<int>(r), key).template cast<double>());
      ray[r] = {.origin = at.position, .direction = drawn[r].direction, .origin_group = at.facet};
    }
    caster_.closest_hits({ray.data(), n}, {hit.data(), n});
    for (std::size_t r = 0; r < n; ++r) {
      if (!counts(drawn[r], hit[r].t)) continue;
      const double density = aimed_density(place, ray[r], hit[r]);
      if (!(density > 0.0) || !(at.normal.dot(ray[r].direction) > 0.0)) continue;
      const std::size_t index = static_cast<std::size_t>(begin) + r;
      const bool is_first = index < static_cast<std::size_t>(aims.count() / 2);
      add_to(place, ray[r], sum[is_first ? 0 : 1], [&](Eigen::ArrayXd& half) {
        add(place, ray[r], hit[r], static_cast<std::uint64_t>(first_index) + index, density, half);
      });
    }
  }
}

// Adds what a ray finds, by the balance heuristic. `aimed` is aimed_density(); `index` numbers
// the rays of the place. Bright patches are not aimed at through mirrors and glass.
void HemisphereGather::add(const Place& place, const Ray& ray, const ElementHit& hit,
                           std::uint64_t index, double aimed, Eigen::ArrayXd& sum) const {
  if (hit.facet < 0) return;
  const GatherPoint& at = place.at;
  const double by_cosine =
      place.rays * std::max(at.normal.dot(ray.direction), 0.0) * std::numbers::inv_pi;
  const double share = aimed > 0.0 ? by_cosine / (by_cosine + aimed) : 1.0;
  const bool in_gap =
      is_in_gap(place, ray, hit) || (aimed > 0.0 && gaps_.is_narrow(caster_, ray, hit));
  if (in_gap) {
    add_of_gap(place, ray, hit, random_key(place.key, RandomPurpose::gap_rays, index), share, sum);
    return;
  }
  if (is_near_portal(place, ray, hit)) {
    Eigen::ArrayXd found = Eigen::ArrayXd::Zero(sum.size());
    gaps_.add_near_portal(caster_, *options_.portals, ray, hit,
                          random_key(place.key, RandomPurpose::gap_rays, index), found);
    sum += share * found;
    return;
  }
  if (hit.element >= 0 && paths_.is_diffuse(hit.facet)) {
    const double straight = place.bright.is_empty()
                                ? share
                                : bright_.share(place.bright, at.normal.dot(ray.direction),
                                                place.rays, ray, hit, aimed);
    add_straight(place, ray, hit, straight, sum);
  }
  if (paths_.is_specular(hit.facet)) {
    add_path(ray, hit, random_key(place.key, RandomPurpose::gather_paths, index), share, sum);
  }
}

// Adds `share` of the light that arrives straight from where a ray ends. The rays of all kinds have
// the density cos / (pi share) times their number, and each stands for the inverse.
void HemisphereGather::add_straight(const Place& place, const Ray& ray, const ElementHit& hit,
                                    double share, Eigen::ArrayXd& sum) const {
  const double cosine = place.at.normal.dot(ray.direction);
  if (!(cosine > 0.0)) return;
  const double solid_angle = std::numbers::pi * share / (place.rays * cosine);
  const double weight = share * paths_.base_factor(ray, hit);
  const Spectrum left = paths_.left_by_body(ray, hit);
  if (left.size() == 0) return radiosity_.add_seen(ray, hit, solid_angle, weight, sum);
  radiosity_.add_seen(ray, hit, solid_angle, Spectrum(static_cast<float>(weight) * left), sum);
}

void HemisphereGather::add_of_gap(const Place& place, const Ray& ray, const ElementHit& hit,
                                  std::uint64_t key, double share, Eigen::ArrayXd& sum) const {
  const GapAims aims{.exits = place.exits ? &*place.exits : nullptr,
                     .portals = place.portals.is_empty() ? nullptr : options_.portals.get()};
  if (share == 1.0) {
    gaps_.add(caster_, ray, hit, key, sum, aims);
    return;
  }
  Eigen::ArrayXd found = Eigen::ArrayXd::Zero(sum.size());
  gaps_.add(caster_, ray, hit, key, found, aims);
  sum += share * found;
}

bool HemisphereGather::is_in_gap(const Place& place, const Ray& ray, const ElementHit& hit) const {
  return place.at.facet >= 0 &&
         gaps_.stays_in(caster_, place.exits ? &*place.exits : nullptr, place.at.normal, ray, hit);
}

bool HemisphereGather::is_near_portal(const Place& place, const Ray& ray,
                                      const ElementHit& hit) const {
  return !place.portals.is_empty() && gaps_.is_near_portal(*options_.portals, ray, hit);
}

// Adds light that arrives through mirrors and glass.
void HemisphereGather::add_path(const Ray& ray, const ElementHit& hit, std::uint64_t key,
                                double share, Eigen::ArrayXd& sum) const {
  const auto weight = static_cast<float>(share);
  const PathLosses losses = paths_.follow(
      ray, hit, key,
      [&](const ElementHit& end, const Spectrum& throughput) {
        if (end.element >= 0) radiosity_.add(end, Spectrum(weight * throughput), sum);
      },
      PathQuantity::radiance);
  if (losses.sky.size() == 0 || dome_.size() == 0) return;
  sum.segment(dome_column_, bands_) +=
      (std::numbers::pi_v<float> * weight * dome_ * losses.sky).cast<double>();
}

// The square of half the difference between the halves' means.
float HemisphereGather::half_difference(const std::array<Eigen::ArrayXd, 2>& sum, int count) const {
  const int first = count / 2, second = count - first;
  const Eigen::ArrayXd by_column =
      0.5 * (first > 0 ? Eigen::ArrayXd(sum[1] / second - sum[0] / first) : 2.0 * sum[1]);
  Eigen::ArrayXd difference = Eigen::ArrayXd::Zero(bands_);
  for (Eigen::Index k = 0; k < by_column.size(); k += bands_) {
    difference += by_column.segment(k, bands_);
  }
  return static_cast<float>(difference.square().mean());
}

}  // namespace lightwell
