#include "raytrace/product_cuts/gathered_light.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "radiosity/many_lights/light_sampler.h"
#include "raytrace/product_cuts/product_cut.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// As many as the parts of a cut for one point.
constexpr int most_pairs = 2048;

// The light of some lights at a point, as the pixel has it.
Spectrum radiance(const DirectLight& direct_light, const PixelPoint& point, std::uint64_t key,
                  const ShadowOptions& shadows, const std::vector<LightSample>& lights) {
  const LightQuery query{.at = point.at,
                         .key = key,
                         .shadows = shadows,
                         .lights = point.lights,
                         .base = point.base.get(),
                         .relief = point.relief ? &*point.relief : nullptr,
                         .asked = &lights};
  return point.weight * direct_light.irradiance(*point.caster, query);
}

// Sum over the points of a product cut.
class PairSum {
 public:
  PairSum(const DirectLight& direct_light, std::span<const PixelPoint> points,
          const GatherTree& tree, const GatherEffort& effort)
      : direct_light_(direct_light), points_(points), tree_(tree), effort_(effort) {
    sum_.radiance = Spectrum::Zero(points.front().weight.size());
  }

  // Adds a point that asks one light. `least`: what is worth a shadow ray.
  void add_single(const LightPair& pair, std::size_t number, double least) {
    const double rays = std::min(std::ceil(pair.bound / least), double(effort_.shadows.max_rays));
    ask(tree_.node(pair.gather).point, {.light = pair.tree->light(pair.light), .cluster = 0},
        static_cast<int>(std::max(1.0, rays)), key(number, 0));
  }

  // Adds two members, each for one half of the pair. Halves are those of the chances of lights; a
  // light by itself is met at points of both halves of theirs.
  void add_pair(const LightPair& pair, std::size_t number) {
    const double of_point = random(number, RandomPurpose::gather_points);
    const double of_light = random(number, RandomPurpose::light_pairs);
    std::array<double, 2> found{};
    for (const int half : {0, 1}) {
      const double u = of_point + 0.5 * half;
      const GatherTree::Draw at = tree_.draw(pair.gather, u < 1.0 ? u : u - 1.0);
      LightTree::Draw draw{
          .light = pair.tree->is_cluster(pair.light) ? -1 : pair.tree->light(pair.light)};
      if (pair.tree->is_cluster(pair.light)) {
        draw = pair.tree->draw(pair.light, points_[static_cast<std::size_t>(at.point)].at,
                               0.5 * (half + of_light));
      }
      if (draw.light < 0) continue;
      found[static_cast<std::size_t>(half)] = ask(
          at.point, {.light = draw.light, .chance = 2.0 * at.chance * draw.chance, .cluster = 0}, 1,
          key(number, half));
    }
    variance_ += std::pow(found[0] - found[1], 2);
  }

  GatheredLight result() && {
    sum_.noise = std::sqrt(variance_);
    return std::move(sum_);
  }

  // Adds what a point gets of lights without clusters.
  void add_others(int point, const std::vector<LightSample>& lights) {
    const std::uint64_t key =
        random_key(effort_.key, RandomPurpose::single_lights, static_cast<std::uint64_t>(point));
    sum_.radiance += radiance(direct_light_, points_[static_cast<std::size_t>(point)], key,
                              effort_.shadows, lights);
    sum_.asked += static_cast<int>(lights.size());
  }

 private:
  std::uint64_t key(std::size_t number, int half) const {
    return random_key(effort_.key, RandomPurpose::pair_shadows, number,
                      static_cast<std::uint64_t>(half));
  }
  double random(std::size_t number, RandomPurpose purpose) const {
    return random_uniform(random_key(effort_.key, purpose, number));
  }
  double ask(int point, const LightSample& light, int rays, std::uint64_t key) {
    one_[0] = light;
    const Spectrum L = radiance(direct_light_, points_[static_cast<std::size_t>(point)], key,
                                {.min_rays = rays, .max_rays = rays}, one_);
    sum_.radiance += L;
    ++sum_.asked;
    return static_cast<double>(L.mean());
  }

  const DirectLight& direct_light_;
  std::span<const PixelPoint> points_;
  const GatherTree& tree_;
  const GatherEffort& effort_;
  GatheredLight sum_{};
  double variance_ = 0.0;
  std::vector<LightSample> one_{1};
};

// About the distance of lights from points: half the diagonal of the box about all.
double reach_of(const std::vector<const LightTree*>& trees, std::span<const PixelPoint> points) {
  Eigen::AlignedBox3d box;
  for (const LightTree* tree : trees) box.extend(tree->node(0).box());
  for (const PixelPoint& point : points) box.extend(point.at.position);
  return 0.5 * box.diagonal().norm();
}

}  // namespace

GatheredLight gathered_light(const DirectLight& direct_light, std::span<const PixelPoint> points,
                             const GatherEffort& effort) {
  const std::vector<const LightTree*> trees = direct_light.sampler().trees(Lights::all);
  const GatherTree tree(points, reach_of(trees, points));
  double light = effort.other;
  for (const PixelPoint& point : points) light += point.about;
  const ProductGoal goal{.share = effort.shadows.cluster_share, .light = light, .most = most_pairs};
  const std::vector<LightPair> cut = product_cut(trees, tree, goal);
  PairSum sum(direct_light, points, tree, effort);
  for (std::size_t k = 0; k < cut.size(); ++k) {
    const LightPair& pair = cut[k];
    if (pair.tree->is_cluster(pair.light) || tree.is_cluster(pair.gather)) {
      sum.add_pair(pair, k);
    } else {
      sum.add_single(pair, k, goal.share * goal.light);
    }
  }
  const std::vector<LightSample> others = direct_light.sampler().singles(Lights::all);
  for (std::size_t i = 0; i < points.size() && !others.empty(); ++i) {
    sum.add_others(static_cast<int>(i), others);
  }
  return std::move(sum).result();
}

}  // namespace lightwell
