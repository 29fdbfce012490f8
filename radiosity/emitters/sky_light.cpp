#include "radiosity/emitters/sky_light.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "scene/random_purpose.h"

namespace lightwell {

SkyLight::SkyLight(const Scene& scene, const PatchMesh& mesh)
    : bands_(scene.bands.count()),
      panes_(scene),
      cells_(*scene.sky, bands_),
      sites_(cells_, panes_, scene_bounds(scene).diagonal(), mesh),
      sobol_(most_sky_rays) {}

// The estimate at one point.
class SkyLight::Estimate {
 public:
  Estimate(const SkyLight& sky, const ElementCaster& caster, const SurfacePoint& at,
           std::uint64_t key)
      : sky_(sky), caster_(caster), at_(at), key_(key) {
    std::optional<SkySites::Weights> own;
    const SkySites::Weights* weights = sky.sites_.find(at);
    if (!weights) {
      weights = &own.emplace(
          sky.sites_.sample(caster, at, random_key(key, RandomPurpose::sky_point_rays)));
    }
    const Eigen::Vector3f n = at.normal.cast<float>();
    shares_.reserve(SkyCells::count / 2 + 2 * SkyCells::around);
    for (const int c : sky.cells_.order()) {
      const double E = sky.cells_.irradiance(c, n);
      if (!(E > 0.0)) continue;
      const auto likely = static_cast<double>((*weights)[static_cast<std::size_t>(c)]);
      shares_.push_back({.cell = c, .E = E, .likely = likely});
    }
  }

  SkyGlow glow(const SkyEffort& effort) {
    if (shares_.empty()) return {Spectrum::Zero(sky_.bands_)};
    const bool sees_nothing =
        std::ranges::none_of(shares_, [](const Share& share) { return share.is_open(); });
    const int first = sees_nothing ? std::max(8, effort.first / 4) : effort.first;
    set_weights();
    const Tally pilot = tally_of(first, 1);
    if (sees_nothing && pilot.clear == 0) return {result(pilot).cast<float>()};
    // A site may say little about the point, as beside a wall that parts light from dark; rays that
    // follow the site are then few for the light they find.
    constexpr double much = 0.2;
    if (pilot.seen_elsewhere.sum() > much * result(pilot).sum()) {
      for (Share& share : shares_) share.likely = 1.0;
      set_weights();
      const Tally all = tally_of(effort.most, 2);
      return {result(all).cast<float>(), std::sqrt(all.squared_noise)};
    }
    // The first rays often miss a small opening, so the point may see sky although none of them
    // gets out. If all of them get out, the point is unobstructed, unless rays of the site were
    // blocked.
    const bool is_clear =
        std::ranges::all_of(shares_, [](const Share& share) { return share.likely >= 1.0; });
    if (is_clear && pilot.clear == pilot.rays) return {result(pilot).cast<float>()};
    const Tally more = tally_of(effort.most, 2);
    const double share = static_cast<double>(first) / (first + effort.most);
    const Eigen::ArrayXd E =
        share * corrected(pilot, more) + (1.0 - share) * corrected(more, pilot);
    return {E.max(0.0).cast<float>(), std::hypot(share * std::sqrt(pilot.squared_noise),
                                                 (1.0 - share) * std::sqrt(more.squared_noise))};
  }

 private:
  // A cell above the point's horizon that emits.
  struct Share {
    int cell = 0;
    double E = 0.0;       // unobstructed, mean of the bands
    double likely = 0.0;  // weight of the site; 0: not known to be open
    double cdf = 0.0;     // running sum of weights
    double weight = 0.0;  // of the cell's rays
    bool is_open() const { return likely > 0.0; }
  };
  struct Tally {
    Eigen::ArrayXd seen_open, all_open, seen_elsewhere;  // per band
    int rays = 0, clear = 0;
    double squared_noise = 0.0;  // of `corrected`, mean of the bands
  };

  // At most a third as many rays as go to open cells go elsewhere; if no cell is known as open, all
  // do. Fewer would be as exact in the mean, but each ray that gets out would weigh more and leave
  // a bright dot in a picture.
  void set_weights() {
    constexpr double most_elsewhere = 1.0 / 3.0;
    double open = 0.0, elsewhere = 0.0, sum = 0.0;
    for (const Share& share : shares_) {
      (share.is_open() ? open : elsewhere) += share.E * (share.is_open() ? share.likely : 1.0);
    }
    const double thinning =
        open > 0.0 ? std::min(1.0, most_elsewhere * open / std::max(elsewhere, 1e-300)) : 1.0;
    for (Share& share : shares_) {
      share.weight = share.E * (share.is_open() ? share.likely : thinning);
      share.cdf = sum += share.weight;
    }
    rays_per_open_ray_ = open > 0.0 ? sum / open : 1.0;
    E_open_ = Eigen::ArrayXd::Zero(sky_.bands_);
    for (const Share& share : shares_) {
      if (share.is_open()) E_open_ += share.E * sky_.cells_.colour(share.cell);
    }
  }

  Tally tally_of(int rays, std::uint64_t round) const {
    Tally tally{.seen_open = Eigen::ArrayXd::Zero(sky_.bands_),
                .all_open = Eigen::ArrayXd::Zero(sky_.bands_),
                .seen_elsewhere = Eigen::ArrayXd::Zero(sky_.bands_)};
    const auto count = static_cast<int>(std::lround(rays_per_open_ray_ * rays));
    cast(std::clamp(count, 1, most_sky_rays), random_key(key_, round), tally);
    return tally;
  }

  // Casts one ray in each of `rays` equal steps through the running sum of the weights.
  void cast(int rays, std::uint64_t key, Tally& tally) const {
    struct Sample {
      double weight = 0.0;
      int cell = 0;
      bool is_open = false;
    };
    std::vector<Ray> ray;
    std::vector<Sample> samples;
    ray.reserve(static_cast<std::size_t>(rays));
    samples.reserve(static_cast<std::size_t>(rays));
    const double all = shares_.back().cdf;
    std::size_t s = 0;
    for (int i = 0; i < rays; ++i) {
      const double within =
          random_uniform(random_key(key, RandomPurpose::sky_rays, static_cast<std::uint64_t>(i)));
      const double wanted = (i + within) / rays * all;
      while (s + 1 < shares_.size() && !(shares_[s].cdf > wanted)) ++s;
      const Share& share = shares_[s];
      const Eigen::Array4f u = sky_.sobol_.point(i, key);
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
    std::vector<double> passed_share;
    passed_share.reserve(ray.size());
    for (std::size_t i = 0; i < ray.size(); ++i) {
      const Sample& sample = samples[i];
      const Eigen::ArrayXd weight = sample.weight * sky_.cells_.colour(sample.cell);
      passed_share.push_back(blocked[i] == 0 ? 1.0 : 0.0);
      if (sample.is_open) tally.all_open += weight;
      ++tally.rays;
      if (blocked[i] == 0) {
        (sample.is_open ? tally.seen_open : tally.seen_elsewhere) += weight;
        ++tally.clear;
        continue;
      }
      if (sky_.panes_.empty()) continue;
      const Spectrum passed = sky_.panes_.passed(caster_, ray[i]);
      passed_share.back() = passed.cast<double>().mean();
      if (!(passed > 0.0f).any()) continue;
      (sample.is_open ? tally.seen_open : tally.seen_elsewhere) += weight * passed.cast<double>();
      ++tally.clear;
    }
    const double visible = tally.all_open.sum() > 0.0 ? seen_share(tally).mean() : 0.0;
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
    return E_open_ * seen_share(tally) + tally.seen_elsewhere;
  }
  // The control variate. The visible share comes from the other rays: from the same rays it would
  // be a ratio of two estimates, which is biased.
  Eigen::ArrayXd corrected(const Tally& tally, const Tally& other) const {
    return tally.seen_open + seen_share(other) * (E_open_ - tally.all_open) + tally.seen_elsewhere;
  }

  const SkyLight& sky_;
  const ElementCaster& caster_;
  const SurfacePoint& at_;
  std::uint64_t key_;
  std::vector<Share> shares_{};
  double rays_per_open_ray_ = 1.0;
  Eigen::ArrayXd E_open_{};  // unobstructed, of the open cells
};

SkyGlow SkyLight::irradiance(const ElementCaster& caster, const SurfacePoint& at, std::uint64_t key,
                             const SkyEffort& effort) const {
  return Estimate(*this, caster, at, key).glow(effort);
}

}  // namespace lightwell
