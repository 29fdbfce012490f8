#include "raytrace/readings/specular_light.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <vector>

#include "raytrace/readings/specular_chains.h"
#include "raytrace/shading/shade.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr int rays_per_stratum = 4;  // two by two

// A square of Malley's unit square, which cosine_direction() maps to the hemisphere. Squares of
// level 0 tile the unit square; a square may be split in four of the next level.
struct Stratum {
  int level = 0, column = 0, row = 0;
  int children = -1;  // the first of four; -1: none
  Spectrum mean{};
  double own = 0.0;  // standard error of the mean of bands, by the stratum's own rays
};

// Sum of the light of rays in one stratum.
struct RaySum {
  Spectrum light{};
  double square = 0.0;  // of the mean of bands
  int count = 0;

  void add(const Spectrum& L) {
    light += L;
    square += std::pow(double{L.mean()}, 2);
    ++count;
  }
  void set(Stratum& s) const {
    s.mean = light / static_cast<float>(count);
    const double variance = square / count - std::pow(double{s.mean.mean()}, 2);
    s.own = std::sqrt(std::max(variance, 0.0) / std::max(count - 1, 1));
  }
};

// True if rays of one direction differ: chance turns them at gloss, and ends most between coats.
bool depends_on_chance(const Scene& scene) {
  return std::ranges::any_of(scene.materials, [](const Material& m) {
    return m.gloss_roughness() > 0.0f || m.mirrors_by_coat();
  });
}

class PointLight {
 public:
  PointLight(const LitScene& lit, const RayTree& tree, const GatherPoint& at,
             const SpecularLightOptions& options, std::uint64_t key)
      : lit_(lit),
        tree_(tree),
        at_(at),
        options_(options),
        key_(key),
        bands_(lit.scene.bands.count()),
        by_chance_(depends_on_chance(lit.scene)),
        paths_(tree, at) {
    frame_.col(2) = at.normal;
    Eigen::Vector3d a, b;
    tangent_frame(at.normal, a, b);
    frame_.col(0) = a;
    frame_.col(1) = b;
  }

  // Adds the light to E and returns the variance of the mean of its bands. `other_light` is that of
  // SpecularLightOptions at the point.
  double gather(double other_light, Spectrum& E) {
    first_strata();
    if (!has_specular_) return 0.0;
    choose_chains();
    const Spectrum lamps = lamps_without_surface();
    split_around_emitters();
    const double known = (static_cast<double>(lamps.mean()) + other_light) * std::numbers::inv_pi;
    double variance = refine(known);
    if (by_chance_) variance = sample_anew(known);
    Spectrum sum = Spectrum::Zero(bands_);
    for (const Stratum& s : strata_) {
      if (s.children < 0) sum += s.mean * static_cast<float>(area(s));
    }
    E += std::numbers::pi_v<float> * sum + lamps;
    return std::numbers::pi * std::numbers::pi * variance;
  }

 private:
  static constexpr int first_side = 32;

  Eigen::Vector3d direction(double u, double v) const {
    return frame_ * cosine_direction(static_cast<float>(u), static_cast<float>(v));
  }
  Ray ray(const Eigen::Vector3d& direction) const {
    return {.origin = at_.position, .direction = direction, .origin_group = at_.facet};
  }

  static double side(const Stratum& s) { return std::ldexp(1.0 / first_side, -s.level); }
  static double area(const Stratum& s) { return side(s) * side(s); }

  // Traces a ray through quarter i of a stratum. `chains` gets the ray's paths; null: not wanted.
  Spectrum trace_quarter(const Stratum& s, int i, SpecularChains* chains) {
    const std::uint64_t key =
        random_key(key_, RandomPurpose::specular_light, static_cast<std::uint64_t>(rays_++));
    const double u = side(s) * (s.column + 0.5 * (i % 2 + random_uniform(key)));
    const double v = side(s) * (s.row + 0.5 * (i / 2 + random_uniform(random_key(key, 1))));
    const Eigen::Vector3d d = direction(std::min(u, almost_one), std::min(v, almost_one));
    std::function<void(const SpecularSegment&)> visit;
    if (chains) {
      visit = [&](const SpecularSegment& part) {
        has_specular_ = true;
        if (part.turns.count == 0) return;
        SpecularChain& chain = (*chains)[part.chain];
        chain.turns = part.turns;
        const double length = part.ray.direction.norm();
        chain.add({.direction = d.normalized(),
                   .origin = part.ray.origin,
                   .exit = part.ray.direction / length,
                   .end = part.end * length,
                   .weight = static_cast<double>(part.weight.mean())});
      };
    }
    return tree_.trace_lamps(ray(d), key, visit);
  }

  void add_rays(const Stratum& s, SpecularChains* chains, RaySum& sum) {
    for (int i = 0; i < rays_per_stratum; ++i) sum.add(trace_quarter(s, i, chains));
  }

  // Traces a stratum's rays.
  void sample(Stratum& s, SpecularChains* chains) {
    RaySum sum{.light = Spectrum::Zero(bands_)};
    add_rays(s, chains, sum);
    sum.set(s);
    has_specular_ = has_specular_ || (s.mean > 0.0f).any();
  }

  void first_strata() {
    for (int row = 0; row < first_side; ++row) {
      for (int column = 0; column < first_side; ++column) {
        strata_.push_back({.column = column, .row = row});
        sample(strata_.back(), &chains_);
      }
    }
  }

  // Chooses the chains that are sought, the heaviest of both kinds. SpecularChains through parallel
  // faces are many, since light goes to and fro between any two of them; see all_straight() for the
  // others.
  void choose_chains() {
    constexpr std::size_t most = 256;
    std::array<std::vector<SpecularChain*>, 2> kinds;
    for (auto& [key, chain] : chains_) kinds[chain.is_straight ? 1 : 0].push_back(&chain);
    for (std::vector<SpecularChain*>& kind : kinds) {
      std::ranges::stable_sort(kind, [](const SpecularChain* a, const SpecularChain* b) {
        return a->weight > b->weight;
      });
      if (kind.size() > most) kind.resize(most);
      for (SpecularChain* chain : kind) chain->is_sought = true;
    }
  }

  void split(int i) {
    const Stratum parent = strata_[static_cast<std::size_t>(i)];
    strata_[static_cast<std::size_t>(i)].children = static_cast<int>(strata_.size());
    Spectrum change = -parent.mean;
    for (int k = 0; k < 4; ++k) {
      strata_.push_back({.level = parent.level + 1,
                         .column = 2 * parent.column + k % 2,
                         .row = 2 * parent.row + k / 2});
      sample(strata_.back(), nullptr);
      change += 0.25f * strata_.back().mean;
    }
    // Neighbours that are not split compare themselves with these squares: half of an emitter may
    // lie in one whose own rays missed it.
    for (int up = 0; up <= parent.level; ++up, change *= 0.25f) {
      const int around = stratum_at(parent.level - up, parent.column >> up, parent.row >> up);
      strata_[static_cast<std::size_t>(around)].mean += change;
    }
  }

  // Returns the stratum of a square, split or not, or the smallest one around the square.
  int stratum_at(int level, int column, int row) const {
    int i = (row >> level) * first_side + (column >> level);
    for (int down = level - 1; down >= 0; --down) {
      const int children = strata_[static_cast<std::size_t>(i)].children;
      if (children < 0) break;
      i = children + 2 * ((row >> down) & 1) + ((column >> down) & 1);
    }
    return i;
  }

  // Returns the standard error of a stratum's mean. Where an outline crosses a stratum, its few
  // rays may agree by chance. The share p of the stratum before the outline is as likely to be any,
  // so the expected squared error is 2 int p^4 (1 - p)^2 dp = 2/105 of the squared step.
  double error(const Stratum& s) const {
    constexpr double chance = 2.0 / 105.0;
    const int end = first_side << s.level;
    double step = 0.0;
    for (int n = 0; n < 9; ++n) {
      const int column = s.column + n % 3 - 1, row = s.row + n / 3 - 1;
      if (column < 0 || row < 0 || column >= end || row >= end) continue;
      const Stratum& other = strata_[static_cast<std::size_t>(stratum_at(s.level, column, row))];
      step = std::max(step, static_cast<double>(std::abs(s.mean.mean() - other.mean.mean())));
    }
    return std::sqrt(s.own * s.own + chance * step * step);
  }

  // Splits the strata that differ most, in rounds, until the estimated error or the number of rays
  // is reached. `known` is light that strata do not have to find. Returns the variance of the sum.
  double refine(double known) {
    const int most = rays_ + (by_chance_ ? options_.most_rays / 2 : options_.most_rays);
    while (true) {
      const std::vector<double> deviation = deviations();
      const double variance = squared_sum(deviation), worst = std::ranges::max(deviation);
      if (rays_ >= most || is_sure(variance, known)) return variance;
      bool is_split = false;
      for (std::size_t i = 0; i < deviation.size() && rays_ < most; ++i) {
        if (deviation[i] < 0.25 * worst || deviation[i] <= 0.0 || strata_[i].level >= deepest) {
          continue;
        }
        split(static_cast<int>(i));
        is_split = true;
      }
      if (!is_split) return variance;
    }
  }

  // Standard errors of what strata add to the mean; 0 for those that are split.
  std::vector<double> deviations() const {
    std::vector<double> deviation(strata_.size(), 0.0);
    for (std::size_t i = 0; i < strata_.size(); ++i) {
      if (strata_[i].children < 0) deviation[i] = area(strata_[i]) * error(strata_[i]);
    }
    return deviation;
  }
  static double squared_sum(const std::vector<double>& deviation) {
    return std::inner_product(deviation.begin(), deviation.end(), deviation.begin(), 0.0);
  }
  bool is_sure(double variance, double known) const {
    double mean = known;
    for (const Stratum& s : strata_) {
      if (s.children < 0) mean += static_cast<double>(s.mean.mean()) * area(s);
    }
    return std::sqrt(variance) <= options_.accuracy * mean;
  }

  // Gives the final strata the means of new rays. Light that chance finds, as off one rough surface
  // or coat by way of another, is too low before: strata whose rays found much were split, and
  // their parts have other rays, while strata whose rays missed it stay as they are. The new rays
  // of a stratum are as many as the first ones decide; half of all are spread evenly. Returns the
  // variance of the sum.
  double sample_anew(double known) {
    const std::vector<double> first = deviations();
    const double all = std::max(std::accumulate(first.begin(), first.end(), 0.0), 1e-300);
    const double rays = rays_;
    std::vector<int> count(strata_.size(), 0);
    std::vector<RaySum> sum(strata_.size(), RaySum{.light = Spectrum::Zero(bands_)});
    for (std::size_t i = 0; i < strata_.size(); ++i) {
      if (strata_[i].children >= 0) continue;
      const double share = 0.5 * (area(strata_[i]) + first[i] / all);
      count[i] = std::max(1, static_cast<int>(std::lround(share * rays / rays_per_stratum)));
    }
    const int most = first_rays + options_.most_rays;
    const int round = rays_per_stratum * std::accumulate(count.begin(), count.end(), 0);
    double variance = 0.0;
    do {
      for (std::size_t i = 0; i < strata_.size(); ++i) {
        for (int k = 0; k < count[i]; ++k) add_rays(strata_[i], nullptr, sum[i]);
        if (count[i] > 0) sum[i].set(strata_[i]);
      }
      variance = squared_sum(deviations());
    } while (!is_sure(variance, known) && rays_ + round <= most);
    return variance;
  }

  // Light of lamps without surface, and of the sun, by way of smooth surfaces.
  Spectrum lamps_without_surface() const {
    Spectrum E = Spectrum::Zero(bands_);
    for (const FreeSource& source : lit_.direct_light.free_sources()) {
      if (source.is_dome() || !source.is_on()) continue;
      const int side = has_sharp_shadows(source) ? 1 : opening_side;
      for (int k = 0; k < side * side; ++k) {
        const double u = (k % side + 0.5) / side, v = (k / side + 0.5) / side;
        E += lamp_light(source, u, v) / static_cast<float>(side * side);
      }
    }
    return E;
  }

  Spectrum lamp_light(const FreeSource& source, double u, double v) const {
    Spectrum E = Spectrum::Zero(bands_);
    const SourceSample seen = sample_source(source, at_.position, u, v);
    const auto* lamp = std::get_if<LampLight>(&source.shape);
    PathGoal goal{.position = seen.direction, .is_direction = true};
    double clearance = 0.0;
    if (lamp) {
      clearance = lamp->clearance;
      goal = {.position = at_.position + (seen.distance + clearance) * seen.direction};
    }
    Spectrum straight = Spectrum::Zero(bands_);
    std::vector<std::uint64_t> found;  // straight chains, ascending
    Eigen::Vector3d towards = Eigen::Vector3d::Zero();
    for (const auto& [key, chain] : chains_) {
      if (!chain.is_sought) continue;
      const auto path = paths_.find(goal, key, chain, clearance);
      if (!path) continue;
      double intensity = 1.0;
      Spectrum light = source.light;
      if (lamp) {
        // A picture is as sharp as at the end of a straight path that spreads as much.
        const double distance = std::sqrt(path->spread);
        intensity = relative_intensity(lamp->lamp, -path->exit, distance);
        light = with_color(light, relative_color(lamp->lamp, -path->exit, distance));
      }
      const double kernel = intensity * path->direction.dot(at_.normal) / path->spread;
      (chain.is_straight ? straight : E) += path->weight * light * static_cast<float>(kernel);
      if (!chain.is_straight) continue;
      found.push_back(key);
      towards = path->direction;
    }
    if (found.empty()) return E;
    return E +
           static_cast<float>(all_straight(chains_, goal, towards, found, clearance)) * straight;
  }

  // Splits the strata in which emitters are seen by way of smooth surfaces until a stratum is not
  // larger than the emitter.
  void split_around_emitters() {
    const auto& emitters = lit_.direct_light.emitters();
    if (emitters.size() > most_sought) return;
    for (const Emitter& emitter : emitters) {
      Eigen::Vector3d middle = emitter.sphere.center;
      if (!emitter.is_sphere) {
        middle.setZero();
        for (const Eigen::Vector3d& corner : emitter.loops.front()) middle += corner;
        middle /= static_cast<double>(emitter.loops.front().size());
      }
      const double radius = emitter.is_sphere ? emitter.sphere.radius : std::sqrt(emitter.area);
      for (const auto& [key, chain] : chains_) {
        if (!chain.is_sought || chain.heaviest < least_sought) continue;
        const auto path = paths_.find({.position = middle}, key, chain, 2.0 * radius);
        if (!path) continue;
        const double facing = emitter.is_sphere ? 1.0 : std::abs(path->exit.dot(emitter.normal));
        const double cosine = path->direction.dot(at_.normal);
        const double share = emitter.area * facing * cosine / (path->spread * std::numbers::pi);
        split_around(path->direction, 0.25 * share);
      }
    }
  }

  // Splits the stratum of a direction until its area is `share` at most.
  void split_around(const Eigen::Vector3d& d, double share) {
    const Eigen::Vector3d local = frame_.transpose() * d;
    const Eigen::Vector2d at = square_point(local.x(), local.y());
    while (rays_ < first_rays + options_.most_rays / 2) {
      constexpr int finest = first_side << deepest;
      const int i = stratum_at(deepest, std::min(static_cast<int>(at.x() * finest), finest - 1),
                               std::min(static_cast<int>(at.y() * finest), finest - 1));
      const Stratum& s = strata_[static_cast<std::size_t>(i)];
      if (area(s) <= share || s.level >= deepest) return;
      split(i);
    }
  }

  // Inverse of cosine_direction().
  static Eigen::Vector2d square_point(double x, double y) {
    const double r = std::hypot(x, y);
    if (!(r > 0.0)) return {0.5, 0.5};
    constexpr double four_over_pi = 4.0 * std::numbers::inv_pi;
    double a = 0.0, b = 0.0;
    if (std::abs(x) > std::abs(y)) {
      a = std::copysign(r, x);
      b = a * four_over_pi * std::atan(y / x);
    } else {
      b = std::copysign(r, y);
      a = b * four_over_pi * std::atan(x / y);
    }
    return {0.5 * (a + 1.0), 0.5 * (b + 1.0)};
  }

  static constexpr double least_sought = 1e-2;  // of chains in which emitters are sought
  static constexpr int first_rays = first_side * first_side * rays_per_stratum;
  static constexpr int opening_side = 3;           // points of a lamp's opening along each side
  static constexpr std::size_t most_sought = 256;  // emitters that are looked for one by one
  static constexpr int deepest = 11;               // level; float directions have no more digits
  static constexpr double almost_one = 1.0 - 1e-7;

  const LitScene& lit_;
  const RayTree& tree_;
  const GatherPoint& at_;
  const SpecularLightOptions& options_;
  std::uint64_t key_;
  int bands_, rays_ = 0;
  bool by_chance_;
  SpecularPaths paths_;
  bool has_specular_ = false;
  Eigen::Matrix3d frame_;
  std::vector<Stratum> strata_{};
  SpecularChains chains_{};
};

}  // namespace

SpecularIrradiance specular_irradiance(const LitScene& lit, const RadiositySolution& solution,
                                       std::span<const GatherPoint> points,
                                       const SpecularLightOptions& options) {
  const auto count = static_cast<Eigen::Index>(points.size());
  const int bands = lit.scene.bands.count();
  SpecularIrradiance result{.irradiance = BandArray::Zero(count, bands),
                            .variance = Eigen::ArrayXf::Zero(count)};
  if (std::ranges::none_of(lit.scene.materials, &Material::is_specular) ||
      lit.direct_light.light_count() == 0) {
    return result;
  }
  // The mean over many directions needs few branches of each.
  const RenderOptions tree_options{.max_depth = options.max_depth,
                                   .min_contribution = 1e-2f,
                                   .slant = std::make_shared<const BandArray>(),
                                   .base_gains = std::make_shared<const BandArray>(),
                                   .visible_lamps = std::make_shared<const VisibleLamps>()};
  const RayTree tree(lit.scene, lit.caster, lit.direct_light, solution, tree_options);
  std::atomic<int> done = 0;
  parallel_for(static_cast<int>(count), 1, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const GatherPoint& at = points[static_cast<std::size_t>(i)];
      const std::uint64_t key = random_key(at.key.value_or(static_cast<std::uint64_t>(i)),
                                           RandomPurpose::specular_light, options.replica);
      Spectrum E = Spectrum::Zero(bands);
      const double other =
          options.other_light.empty() ? 0.0 : options.other_light[static_cast<std::size_t>(i)];
      PointLight light(lit, tree, at, options, key);
      result.variance[i] = static_cast<float>(light.gather(other, E));
      result.irradiance.row(i) = E.transpose();
      report(options.progress, "mirrored light", static_cast<double>(++done) / count);
    }
  });
  return result;
}

}  // namespace lightwell
