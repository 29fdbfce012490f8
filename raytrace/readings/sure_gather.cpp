#include "raytrace/readings/sure_gather.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <vector>

#include "radiosity/sky/sky_light.h"

namespace lightwell {
namespace {

// Student's t of a two-sided 95 % with 7 degrees of freedom is 2.36. Gathers that stop because
// their bound happens to be small ask for a little more.
constexpr double student_t = 2.5;

enum class Part { direct, indirect };

// One part of the light at each point.
struct PartOfLight {
  BandArray mean{};          // points x bands
  Eigen::ArrayXd lux{};      // of the mean
  Eigen::ArrayXd squared{};  // squared standard error of lux
  Eigen::ArrayXd rare{};     // lx that the rays may have missed altogether
  std::vector<int> rays{};   // of each set; of direct light, to the sky
};

int power_of_two_from(double count) {
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::ceil(std::max(1.0, count)))));
}

class SureGather {
 public:
  SureGather(const LitScene& lit, const BandArray& radiosity, const GatherPoints& points,
             const GatherOptions& options, const SureGoal& goal)
      : lit_(lit), radiosity_(radiosity), points_(points), options_(options), goal_(goal) {
    const auto count = static_cast<Eigen::Index>(points.size());
    for (PartOfLight* part : {&direct_, &indirect_}) {
      part->mean = BandArray::Zero(count, lit.scene.bands.count());
      part->lux = part->squared = part->rare = Eigen::ArrayXd::Zero(count);
    }
    const int sky =
        options.shadows.sky_rays > 0 ? options.shadows.sky_rays : options.shadows.max_rays;
    direct_.rays.assign(static_cast<std::size_t>(count), std::max(1, sky / rays_over_set));
    indirect_.rays.assign(static_cast<std::size_t>(count),
                          std::max(1, options.rays / rays_over_set));
    if (radiosity.rows() > 0) {
      const Eigen::Array<double, 1, Eigen::Dynamic> mean =
          radiosity.cast<double>().colwise().mean();
      mean_lux_ = luminous(lit.scene.bands, mean.cast<float>().transpose());
    }
  }

  SureIrradiance run() {
    const double accuracy = goal_.accuracy;
    std::vector<int> all(static_cast<std::size_t>(points_.size()));
    std::iota(all.begin(), all.end(), 0);
    gather(Part::direct, all);
    gather(Part::indirect, all);
    std::vector<int> more_direct, more_indirect;
    while (accuracy > 0.0) {
      more_direct.clear();
      more_indirect.clear();
      for (const int i : all) {
        const double goal = noise_goal(i);
        if (!(noise_bound(i) > goal)) continue;
        if (raise(Part::direct, i, goal)) more_direct.push_back(i);
        if (raise(Part::indirect, i, goal)) more_indirect.push_back(i);
      }
      if (more_direct.empty() && more_indirect.empty()) break;
      gather(Part::direct, more_direct);
      gather(Part::indirect, more_indirect);
    }
    SureIrradiance result{.irradiance = direct_.mean + indirect_.mean,
                          .lux_within = Eigen::ArrayXd::Zero(points_.size())};
    for (const int i : all) {
      const bool is_known = lux(i) > 0.0 || bound(i) > 0.0;
      result.lux_within[i] = is_known ? bound(i) : std::numeric_limits<double>::quiet_NaN();
      if (accuracy > 0.0 && bound(i) > accuracy * lux(i)) ++result.missed;
    }
    return result;
  }

 private:
  double lux(int i) const { return direct_.lux[i] + indirect_.lux[i]; }
  double noise_bound(int i) const {
    return std::hypot(student_t * std::sqrt(direct_.squared[i] + indirect_.squared[i]),
                      indirect_.rare[i]);
  }
  double besides(int i) const { return goal_.besides.size() > 0 ? goal_.besides[i] : 0.0; }
  double bound(int i) const { return std::hypot(noise_bound(i), besides(i)); }
  double noise_goal(int i) const {
    const double goal = goal_.accuracy * lux(i);
    return std::sqrt(std::max(goal * goal - besides(i) * besides(i), 0.25 * goal * goal));
  }

  // Raises the rays of a part at a point if the part has more than its half of the allowed squared
  // error; returns whether it did. Rays are chosen for 60 % of the goal, 85 % for both parts.
  bool raise(Part part, int i, double goal) {
    PartOfLight& light = part == Part::direct ? direct_ : indirect_;
    const double found = student_t * std::sqrt(light.squared[i]);
    if (!(found > std::sqrt(0.5) * goal)) return false;
    constexpr double aim = 0.6, law = 4.0 / 3.0, least = 2.0, most = 16.0;
    const double factor = goal > 0.0 ? std::pow(found / (aim * goal), law) : most;
    int& rays = light.rays[static_cast<std::size_t>(i)];
    if (rays >= most_sure_rays) return false;
    rays = std::min(most_sure_rays,
                    power_of_two_from(rays * std::clamp(factor, least, most) / std::sqrt(2.0)));
    return true;
  }

  // Shadow rays to emitters in proportion to those to the sky.
  ShadowOptions shadows(int rays) const {
    constexpr int fewest = 16;
    const int at_first =
        options_.shadows.sky_rays > 0 ? options_.shadows.sky_rays : options_.shadows.max_rays;
    const double share = static_cast<double>(rays) / at_first;
    const auto scaled = [&](int count) {
      return std::clamp(static_cast<int>(std::lround(share * count)), std::min(fewest, count),
                        most_probe_shadow_rays);
    };
    return {.min_rays = scaled(options_.shadows.min_rays),
            .max_rays = scaled(options_.shadows.max_rays),
            .sky_rays = rays,
            // Clusters of a tenth leave 0.04 % of noise among 10 000 lamps, below any accuracy that
            // can be asked for.
            .cluster_share = 0.1 * options_.shadows.cluster_share / std::max(1.0, share)};
  }

  // Gathers a part at points, those with equally many rays together.
  void gather(Part part, const std::vector<int>& at) {
    PartOfLight& light = part == Part::direct ? direct_ : indirect_;
    std::map<int, std::vector<int>> by_rays;
    for (const int i : at) by_rays[light.rays[static_cast<std::size_t>(i)]].push_back(i);
    for (const auto& [rays, some] : by_rays) {
      GatherOptions options = options_;
      options.shadows = shadows(rays);
      options.rays = rays;
      options.replica = random_key(options_.replica, static_cast<std::uint64_t>(rays));
      const GatherPoints sets(sure_sets * static_cast<int>(some.size()), [&](int k) {
        const int i = some[static_cast<std::size_t>(k / sure_sets)];
        GatherPoint point = points_[i];
        point.key = random_key(point.key.value_or(static_cast<std::uint64_t>(i)),
                               static_cast<std::uint64_t>(k % sure_sets));
        point.rays = 0;
        return point;
      });
      const BandArray E = part == Part::direct
                              ? gather_direct(lit_, sets, options)
                              : gather_indirect(lit_, radiosity_, sets, options).indirect;
      for (std::size_t k = 0; k < some.size(); ++k) {
        set(light, some[k], E.middleRows(static_cast<Eigen::Index>(k) * sure_sets, sure_sets));
      }
    }
  }

  void set(PartOfLight& light, int i, const BandArray& E) {
    const Bands& bands = lit_.scene.bands;
    light.mean.row(i) = E.colwise().mean();
    Eigen::ArrayXd lux(sure_sets);
    for (Eigen::Index k = 0; k < sure_sets; ++k) lux[k] = luminous(bands, E.row(k).transpose());
    light.lux[i] = lux.mean();
    light.squared[i] = (lux - lux.mean()).square().sum() / (sure_sets * (sure_sets - 1));
    if (&light != &indirect_ || (lux > 0.0).all()) return;
    constexpr double of_three = 3.0;
    light.rare[i] = of_three / (sure_sets * light.rays[static_cast<std::size_t>(i)]) * mean_lux_;
  }

  LitScene lit_;
  const BandArray& radiosity_;
  const GatherPoints& points_;
  const GatherOptions& options_;
  const SureGoal& goal_;
  double mean_lux_ = 0.0;  // radiosity of the scene
  PartOfLight direct_{}, indirect_{};
};

}  // namespace

SureIrradiance sure_gather(const LitScene& lit, const BandArray& radiosity,
                           const GatherPoints& points, const GatherOptions& options,
                           const SureGoal& goal) {
  return SureGather(lit, radiosity, points, options, goal).run();
}

}  // namespace lightwell
