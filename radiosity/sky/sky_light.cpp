#include "radiosity/sky/sky_light.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "radiosity/visibility/seams.h"
#include "scene/random_purpose.h"
#include "scene/scenery_box.h"

namespace lightwell {

// A cell above a point's horizon that emits.
struct SkyLight::Share {
  int cell = 0;
  double E = 0.0;       // unobstructed, mean of the bands
  double likely = 0.0;  // weight of the site; 0: not known to be open
  double weight = 0.0;  // of the cell's rays
  bool is_open() const { return likely > 0.0; }
};

// All cells above a point's horizon, in the order of the curve.
struct SkyLight::Shares {
  std::vector<Share> cells{};
  std::vector<double> cdf{};  // running sum of the cells' weights
  double rays_per_open_ray = 1.0;
  Eigen::ArrayXd E_open{};  // unobstructed, of the open cells
};

SkyLight::SkyLight(const Scene& scene, const ElementCaster& caster)
    : bands_(scene.bands.count()),
      seam_(seam_share * scenery_length(scene)),
      panes_(scene),
      cells_(*scene.sky, bands_),
      sites_(cells_, panes_, scene_bounds(scene).diagonal(), caster),
      sobol_(most_sky_rays) {
  static std::atomic<std::uint64_t> count{0};
  number_ = ++count;
}

// Sets the weights of the cells' rays.
void SkyLight::set_weights(Shares& shares) const {
  double open = 0.0, elsewhere = 0.0, sum = 0.0;
  for (const Share& share : shares.cells) {
    (share.is_open() ? open : elsewhere) += share.E * (share.is_open() ? share.likely : 1.0);
  }
  const double thinning = thinning_elsewhere(open, elsewhere);
  shares.cdf.clear();
  shares.cdf.reserve(shares.cells.size());
  for (Share& share : shares.cells) {
    share.weight = share.E * (share.is_open() ? share.likely : thinning);
    shares.cdf.push_back(sum += share.weight);
  }
  shares.rays_per_open_ray = open > 0.0 ? sum / open : 1.0;
  shares.E_open = Eigen::ArrayXd::Zero(bands_);
  for (const Share& share : shares.cells) {
    if (!share.is_open()) continue;
    for (int k = 0; k < bands_; ++k) shares.E_open[k] += share.E * cells_.colour(share.cell, k);
  }
}

namespace {

// The irradiance of every cell for the normals of the last points; a table of one thread for one
// sky.
class RecentNormals {
 public:
  const Eigen::ArrayXf& irradiances(const SkyCells& cells, std::uint64_t sky,
                                    const Eigen::Vector3f& normal) {
    if (sky != sky_) entries_.assign(size, {});
    sky_ = sky;
    const auto bits = [&](int i) { return std::uint64_t{std::bit_cast<std::uint32_t>(normal[i])}; };
    Entry& entry = entries_[random_key(bits(0), bits(1), bits(2)) % size];
    if (entry.E.size() == 0 || entry.normal != normal) {
      entry = {normal, cells.irradiances(normal)};
    }
    return entry.E;
  }

 private:
  static constexpr std::size_t size = 128;  // 8 kB each
  struct Entry {
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    Eigen::ArrayXf E{};
  };
  std::uint64_t sky_ = 0;
  std::vector<Entry> entries_{};
};

}  // namespace

SkyLight::Shares SkyLight::shares_of(const SkySites::Weights& site,
                                     const Eigen::Vector3d& normal) const {
  thread_local RecentNormals recent;
  const Eigen::ArrayXf& E = recent.irradiances(cells_, number_, normal.cast<float>());
  Shares shares;
  shares.cells.reserve(SkyCells::count / 2 + 2 * SkyCells::around);
  for (const int c : cells_.order()) {
    if (!(E[c] > 0.0f)) continue;
    const auto likely = static_cast<double>(site[static_cast<std::size_t>(c)]);
    shares.cells.push_back({.cell = c, .E = static_cast<double>(E[c]), .likely = likely});
  }
  set_weights(shares);
  return shares;
}

// The shares of a point before serve again where both lie in the same site and face the same way,
// as most vertices of a facet and neighbouring pixels do.
std::shared_ptr<const SkyLight::Shares> SkyLight::shares_at(const ElementCaster& caster,
                                                            const SurfacePoint& at,
                                                            std::uint64_t key) const {
  const SkySites::Site* site = sites_.find(at);
  if (!site) {
    const SkySites::Weights own =
        sites_.sample(caster, at, random_key(key, RandomPurpose::sky_point_rays));
    return std::make_shared<const Shares>(shares_of(own, at.normal));
  }
  struct Known {
    std::uint64_t sky = 0;
    const SkySites::Site* site = nullptr;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    std::shared_ptr<const Shares> shares{};
  };
  constexpr std::size_t size = 64;  // some 30 kB each
  thread_local std::array<Known, size> all_known;
  const auto bits = [&](int i) { return std::bit_cast<std::uint64_t>(at.normal[i]); };
  const std::uint64_t facing = random_key(bits(0), bits(1), bits(2));
  Known& known = all_known[random_key(facing, std::bit_cast<std::uintptr_t>(site)) % size];
  if (known.sky != number_ || known.site != site || known.normal != at.normal) {
    known = {number_, site, at.normal,
             std::make_shared<const Shares>(shares_of(site->weights, at.normal))};
  }
  return known.shares;
}

// The estimate at one point.
class SkyLight::Estimate {
 public:
  Estimate(const SkyLight& sky, const ElementCaster& caster, const SurfacePoint& at,
           std::uint64_t key, const ReceiverGain& gain)
      : sky_(sky),
        caster_(caster),
        at_(at),
        key_(key),
        receiver_(gain),
        shares_(sky.shares_at(caster, at, key)) {}

  // Mean of the receiver's factor over the light that all rays so far have found.
  double gain() const { return found_ > 0.0 ? gained_ / found_ : 1.0; }

  SkyGlow glow(const SkyEffort& effort) {
    if (cells().empty()) return {Spectrum::Zero(sky_.bands_)};
    const bool sees_nothing =
        std::ranges::none_of(cells(), [](const Share& share) { return share.is_open(); });
    const int first = sees_nothing ? std::max(8, effort.first / 4) : effort.first;
    const Tally pilot = tally_of(first, 1);
    if (sees_nothing && pilot.clear == 0) return {result(pilot).cast<float>()};
    // A site may say little about the point, as beside a wall that parts light from dark; rays that
    // follow the site are then few for the light they find.
    constexpr double much = 0.2;
    if (pilot.seen_elsewhere.sum() > much * result(pilot).sum()) {
      Shares all_alike = *shares_;
      for (Share& share : all_alike.cells) share.likely = 1.0;
      sky_.set_weights(all_alike);
      shares_ = std::make_shared<const Shares>(std::move(all_alike));
      const Tally all = tally_of(rays_after(pilot, first, effort), 2);
      return {result(all).cast<float>(), std::sqrt(all.squared_noise)};
    }
    // The first rays often miss a small opening, so the point may see sky although none of them
    // gets out. If all of them get out, the point is unobstructed, unless rays of the site were
    // blocked.
    const bool is_clear =
        std::ranges::all_of(cells(), [](const Share& share) { return share.likely >= 1.0; });
    if (is_clear && pilot.clear == pilot.rays) return {result(pilot).cast<float>()};
    const int following = rays_after(pilot, first, effort);
    const Tally more = tally_of(following, 2);
    // The number of rays that follow a goal is decided by what the first rays found. Their own
    // light would count for more where they found little, and the mean would be too dark.
    const double share =
        effort.goal.is_set() ? 0.0 : static_cast<double>(first) / (first + following);
    const Eigen::ArrayXd E =
        share * corrected(pilot, more) + (1.0 - share) * corrected(more, pilot);
    return {E.max(0.0).cast<float>(), std::hypot(share * std::sqrt(pilot.squared_noise),
                                                 (1.0 - share) * std::sqrt(more.squared_noise))};
  }

 private:
  struct Tally {
    Eigen::ArrayXd seen_open, all_open, seen_elsewhere;  // per band
    int rays = 0, clear = 0;
    double squared_noise = 0.0;  // of `corrected`, mean of the bands
  };

  // The rays that follow the first. If all of these or none get out, a share of 1 / n of the open
  // cells may still be of the other kind.
  int rays_after(const Tally& pilot, int first, const SkyEffort& effort) const {
    if (!effort.goal.is_set()) return effort.most;
    const bool is_even = pilot.clear == 0 || pilot.clear == pilot.rays;
    const double unseen = is_even ? shares_->E_open.mean() / first : 0.0;
    const double square = pilot.squared_noise + unseen * unseen;
    const double enough =
        std::max(effort.goal.irradiance, effort.goal.share * result(pilot).mean());
    // The first rays do not count, and would be missed where there cannot be rays enough.
    const double most =
        std::min(1.0 * effort.goal.most_times * effort.most + first, 1.0 * most_sky_rays);
    const double rays = enough > 0.0 ? first * square / (enough * enough) : most;
    return static_cast<int>(std::lround(std::clamp(rays, std::max(1.0, 0.5 * first), most)));
  }

  const std::vector<Share>& cells() const { return shares_->cells; }

  Tally tally_of(int rays, std::uint64_t round) {
    Tally tally{.seen_open = Eigen::ArrayXd::Zero(sky_.bands_),
                .all_open = Eigen::ArrayXd::Zero(sky_.bands_),
                .seen_elsewhere = Eigen::ArrayXd::Zero(sky_.bands_)};
    const auto count = static_cast<int>(std::lround(shares_->rays_per_open_ray * rays));
    cast(std::clamp(count, 1, most_sky_rays), random_key(key_, round), tally);
    return tally;
  }

  // Casts one ray in each of `rays` equal steps through the running sum of the weights.
  void cast(int rays, std::uint64_t key, Tally& tally) {
    struct Sample {
      double weight = 0.0;
      int cell = 0;
      bool is_open = false;
    };
    std::vector<Ray> ray;
    std::vector<Sample> samples;
    ray.reserve(static_cast<std::size_t>(rays));
    samples.reserve(static_cast<std::size_t>(rays));
    std::vector<Eigen::Array4f> points(static_cast<std::size_t>(rays));
    sky_.sobol_.points(0, key, points);
    const std::vector<double>& cdf = shares_->cdf;
    const double all = cdf.back();
    std::size_t s = 0;
    for (int i = 0; i < rays; ++i) {
      const Eigen::Array4f& u = points[static_cast<std::size_t>(i)];
      const double wanted = (i + static_cast<double>(u[2])) / rays * all;
      while (s + 1 < cdf.size() && !(cdf[s] > wanted)) ++s;
      const Share& share = cells()[s];
      const SkyCells::Sample drawn =
          sky_.cells_.sample(share.cell, static_cast<double>(u[0]), static_cast<double>(u[1]));
      const double cosine = drawn.direction.dot(at_.normal);
      if (!(cosine > 0.0) || !(drawn.density > 0.0)) continue;
      // L cos over the density of the direction: its density within the cell times weight / all.
      const double power = sky_.cells_.power(share.cell);
      samples.push_back({.weight = cosine * power * all / (share.weight * rays),
                         .cell = share.cell,
                         .is_open = share.is_open()});
      ray.push_back(
          {.origin = at_.position, .direction = drawn.direction, .origin_group = at_.facet});
    }
    std::vector<std::uint8_t> blocked(ray.size());
    caster_.occluded(ray, blocked);
    stop_in_seams(caster_, ray, sky_.seam_, blocked);
    std::vector<double> passed_share;
    passed_share.reserve(ray.size());
    const Spectrum whole = Spectrum::Ones(sky_.bands_);
    const auto add = [&](const Sample& sample, const Spectrum& passed, Eigen::ArrayXd& sum) {
      for (int k = 0; k < sky_.bands_; ++k) {
        sum[k] += sample.weight * sky_.cells_.colour(sample.cell, k) * double{passed[k]};
      }
    };
    for (std::size_t i = 0; i < ray.size(); ++i) {
      const Sample& sample = samples[i];
      Eigen::ArrayXd& seen = sample.is_open ? tally.seen_open : tally.seen_elsewhere;
      passed_share.push_back(blocked[i] == 0 ? 1.0 : 0.0);
      if (sample.is_open) add(sample, whole, tally.all_open);
      ++tally.rays;
      if (blocked[i] == 0) {
        add(sample, whole, seen);
        ++tally.clear;
        continue;
      }
      if (sky_.panes_.empty()) continue;
      const Spectrum passed = sky_.panes_.passed(caster_, ray[i]);
      passed_share.back() = passed.cast<double>().mean();
      if (!(passed > 0.0f).any()) continue;
      add(sample, passed, seen);
      ++tally.clear;
    }
    for (std::size_t i = 0; !receiver_.is_plain() && i < ray.size(); ++i) {
      const double found = samples[i].weight * passed_share[i];
      found_ += found;
      gained_ += found * receiver_.factor(ray[i].direction, at_.normal);
    }
    const double visible = tally.all_open.sum() > 0.0 ? control_share(tally).mean() : 0.0;
    const auto term = [&](std::size_t i) {
      return samples[i].weight * (passed_share[i] - (samples[i].is_open ? visible : 0.0));
    };
    for (std::size_t i = 0; i + 1 < samples.size(); i += 2) {
      const double difference = term(i) - term(i + 1);
      tally.squared_noise += difference * difference;
    }
  }

  static Eigen::ArrayXd seen_share(const Tally& tally) {
    return (tally.all_open > 0.0).select(tally.seen_open / tally.all_open.max(1e-300), 0.0);
  }
  Eigen::ArrayXd result(const Tally& tally) const {
    return shares_->E_open * seen_share(tally) + tally.seen_elsewhere;
  }
  // The visible share p if it is a half or more, otherwise 0.
  // - A control variate lowers the variance by p / (1 - p) of the share that the spread of the
  //   weights of rays has in it: little where p is small.
  // - It may be negative where no ray gets out, and cut at 0, which makes the mean too bright. From
  //   p = 1/2 on, none of 4 rays, the fewest that follow, gets out once in 16 times at most, and
  //   none of 16 once in 65 000 times.
  static Eigen::ArrayXd control_share(const Tally& tally) {
    constexpr double least = 0.5;
    const Eigen::ArrayXd share = seen_share(tally);
    return (share >= least).select(share, 0.0);
  }
  // The control variate. The visible share comes from the other rays: from the same rays it would
  // be a ratio of two estimates, which is biased.
  Eigen::ArrayXd corrected(const Tally& tally, const Tally& other) const {
    return tally.seen_open + control_share(other) * (shares_->E_open - tally.all_open) +
           tally.seen_elsewhere;
  }

  const SkyLight& sky_;
  const ElementCaster& caster_;
  const SurfacePoint& at_;
  std::uint64_t key_;
  ReceiverGain receiver_;
  double found_ = 0.0, gained_ = 0.0;
  std::shared_ptr<const Shares> shares_;
};

SkyGlow SkyLight::irradiance(const ElementCaster& caster, const SurfacePoint& at, std::uint64_t key,
                             const SkyEffort& effort, const ReceiverGain& gain) const {
  Estimate estimate(*this, caster, at, key, gain);
  SkyGlow glow = estimate.glow(effort);
  glow.gain = estimate.gain();
  glow.irradiance *= static_cast<float>(glow.gain);
  return glow;
}

Eigen::Array2d SkyByCosine::at_base(const CoatedBase& base) const {
  Eigen::Array2d sum = Eigen::Array2d::Zero();
  for (std::size_t i = 0; i < light.size(); ++i) {
    if (light[i] > 0.0) sum += light[i] * Eigen::Array2d(base.factor(cosine[i]), 1.0);
  }
  return sum;
}

SkyByCosine SkyLight::light_by_cosine(const SkySites::Site& site,
                                      const Eigen::Vector3d& normal) const {
  thread_local RecentNormals recent;
  const Eigen::ArrayXf& E = recent.irradiances(cells_, number_, normal.cast<float>());
  SkyByCosine sum;
  for (int c = 0; c < SkyCells::count; ++c) {
    const double light = double{E[c]} * double{site.open[static_cast<std::size_t>(c)]};
    if (!(light > 0.0)) continue;
    std::array<double, 4> cosine;
    double all = 0.0;
    for (std::size_t i = 0; i < cosine.size(); ++i) {
      const double u = i % 2 == 0 ? 0.25 : 0.75, v = i < 2 ? 0.25 : 0.75;
      // All four may lie below the horizon, where it cuts a cell.
      constexpr double least = 1e-3;
      cosine[i] = std::max(cells_.direction(c, u, v).dot(normal), least);
      all += cosine[i];
    }
    for (const double mu : cosine) {
      const auto step =
          static_cast<std::size_t>(std::min(SkyByCosine::steps * mu, SkyByCosine::steps - 1.0));
      const double part = light * mu / all;
      sum.light[step] += part;
      sum.cosine[step] += part * mu;
    }
  }
  for (std::size_t i = 0; i < sum.light.size(); ++i) {
    if (sum.light[i] > 0.0) sum.cosine[i] /= sum.light[i];
  }
  return sum;
}

// The light of the point before serves again, as in shares_at().
std::shared_ptr<const SkyByCosine> SkyLight::by_cosine(const SurfacePoint& at) const {
  const SkySites::Site* found = sites_.find(at);
  const SkySites::Site& site = found ? *found : sites_.unknown();
  struct Last {
    std::uint64_t sky = 0;
    const SkySites::Site* site = nullptr;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    std::shared_ptr<const SkyByCosine> light{};
  };
  thread_local Last last;
  if (last.sky != number_ || last.site != &site || last.normal != at.normal) {
    last = {number_, &site, at.normal,
            std::make_shared<const SkyByCosine>(light_by_cosine(site, at.normal))};
  }
  return last.light;
}

double SkyLight::open_share(const SurfacePoint& at, const Eigen::Vector3d& direction) const {
  const SkySites::Site* site = sites_.find(at);
  if (!site) return 1.0;
  return double{site->open[static_cast<std::size_t>(cells_.cell_of(direction))]};
}

// A cell of a site, and its step of the running sum.
struct SkyLight::Draw {
  int cell = 0;
  float step = 0.0f;
};

SkyLight::Draw SkyLight::draw_cell(const SkySites::Site& site, double which) {
  const auto wanted = static_cast<float>(which * static_cast<double>(site.sum.back()));
  const auto drawn = std::upper_bound(site.sum.begin(), site.sum.end() - 1, wanted);
  const float before = drawn == site.sum.begin() ? 0.0f : *(drawn - 1);
  return {static_cast<int>(drawn - site.sum.begin()), *drawn - before};
}

SkyLight::Aim SkyLight::aim(const SkySites::Site& site, double which, double u, double v) const {
  const auto [cell, step] = draw_cell(site, which);
  if (!(step > 0.0f)) return {};
  const SkyCells::Sample sample = cells_.sample(cell, u, v);
  return {sample.direction, sample.density * static_cast<double>(step / site.sum.back())};
}

double SkyLight::density(const SkySites::Site& site, const Eigen::Vector3d& direction) const {
  const int cell = cells_.cell_of(direction);
  const auto c = static_cast<std::size_t>(cell);
  const float step = site.sum[c] - (c == 0 ? 0.0f : site.sum[c - 1]);
  if (!(step > 0.0f)) return 0.0;
  return cells_.density(cell, direction) * static_cast<double>(step / site.sum.back());
}

Spectrum SkyLight::irradiance_by_one_ray(const ElementCaster& caster, const SurfacePoint& at,
                                         std::uint64_t key, const ReceiverGain& gain) const {
  const SkySites::Site* found = sites_.find(at);
  const SkySites::Site& site = found ? *found : sites_.unknown();
  const auto u = [&](std::uint64_t i) {
    return random_uniform(random_key(key, RandomPurpose::sky_rays, i));
  };
  const auto [cell, step] = draw_cell(site, u(0));
  const SkyCells::Sample sample = cells_.sample(cell, u(1), u(2));
  const double cosine = sample.direction.dot(at.normal);
  if (!(cosine > 0.0) || !(sample.density > 0.0) || !(step > 0.0f)) return Spectrum::Zero(bands_);
  const Ray ray{.origin = at.position, .direction = sample.direction, .origin_group = at.facet};
  Spectrum passed = Spectrum::Ones(bands_);
  std::uint8_t blocked = 0;
  caster.occluded({&ray, 1}, {&blocked, 1});
  if (blocked != 0) {
    if (panes_.empty()) return Spectrum::Zero(bands_);
    passed = panes_.passed(caster, ray);
  }
  // L cos over the density of the direction: its density within the cell times step / all.
  double weight = cosine * cells_.power(cell) * static_cast<double>(site.sum.back() / step);
  if (!gain.is_plain()) weight *= gain.factor(sample.direction, at.normal);
  return passed * (weight * cells_.colour(cell)).cast<float>();
}

}  // namespace lightwell
