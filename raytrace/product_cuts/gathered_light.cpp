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

// The most pairs of a cut: as many as a cut for one point has parts (see LightSampler).
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

// Steps of a sequence in two dimensions of low discrepancy: powers of the number g of which g^3 is
// g + 1, as the golden ratio's serve one dimension (Roberts 2018).
constexpr double step_of_point = 0.7548776662466927, step_of_light = 0.5698402909980532;

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
    ask(tree_.node(pair.gather).point, {.light = pair.tree->light(pair.light)},
        static_cast<int>(std::max(1.0, rays)), key(number, 0));
  }

  // Adds two members, each for one half of the pair. Halves are those of the chances of lights; a
  // light by itself is met at points of both halves of theirs. Random numbers of all pairs are one
  // sequence, so that what neighbouring pairs have too much and too little cancels.
  void add_pair(const LightPair& pair, std::size_t number) {
    const double u = shifted(of_point_, step_of_point, number);
    const double v = shifted(of_light_, step_of_light, number);
    std::array<double, 2> found{};
    for (const int half : {0, 1}) {
      const GatherTree::Draw at =
          tree_.draw(pair.gather, pair.tree->node(pair.light), shifted(u, 0.5, half));
      if (at.point < 0) continue;
      const LightTree::Draw draw = draw_light(pair, at.point, 0.5 * (half + v));
      if (draw.light < 0) continue;
      const LightSample light{
          .light = draw.light, .chance = 2.0 * at.chance * draw.chance, .cluster = 0};
      found[static_cast<std::size_t>(half)] = ask(at.point, light, 1, key(number, half));
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
  LightTree::Draw draw_light(const LightPair& pair, int point, double u) const {
    if (!pair.tree->is_cluster(pair.light)) return {.light = pair.tree->light(pair.light)};
    return pair.tree->draw(pair.light, points_[static_cast<std::size_t>(point)].at, u);
  }
  // Number `i` of a sequence in [0,1) that begins at `first`.
  static double shifted(double first, double step, std::size_t i) {
    const double u = first + step * static_cast<double>(i);
    return u - std::floor(u);
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
  double of_point_ = random_uniform(random_key(effort_.key, RandomPurpose::gather_points));
  double of_light_ = random_uniform(random_key(effort_.key, RandomPurpose::light_pairs));
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

// Adds the part of a pair's light that each point below a node gets.
void add_shares(const LightPair& pair, int number, double of_share, const GatherTree& tree,
                std::vector<double>& light) {
  if (tree.is_cluster(number)) {
    const int child = tree.node(number).child;
    for (const int half : {child, child + 1}) add_shares(pair, half, of_share, tree, light);
    return;
  }
  light[static_cast<std::size_t>(tree.node(number).point)] +=
      of_share * share_of_light(tree.node(number), pair.tree->node(pair.light));
}

// GatheredLight::spread of a cut. `arriving`: the sum over points, mean of the bands.
double spread_of(const std::vector<LightPair>& cut, const GatherTree& tree, std::size_t count,
                 double arriving) {
  constexpr std::size_t most = 32;
  if (count < 2 || count > most) return 0.0;
  std::vector<double> light(count, 0.0);
  for (const LightPair& pair : cut) {
    const double all = share_of_light(tree.node(pair.gather), pair.tree->node(pair.light));
    if (all > 0.0) add_shares(pair, pair.gather, pair.about / all, tree, light);
  }
  double sum = 0.0, squares = 0.0;
  for (const double of_point : light) {
    sum += of_point;
    squares += of_point * of_point;
  }
  if (!(sum > 0.0)) return 0.0;
  const auto n = static_cast<double>(count);
  return std::max(0.0, n * squares / (sum * sum) - 1.0) * std::pow(arriving / n, 2);
}

// The pairs of a cut so that neighbours have points, and then lights, beside each other.
std::vector<LightPair> in_order(std::vector<LightPair> cut) {
  std::ranges::stable_sort(cut, [](const LightPair& a, const LightPair& b) {
    return a.gather != b.gather ? a.gather < b.gather : a.light < b.light;
  });
  return cut;
}

}  // namespace

GatheredLight gathered_light(const DirectLight& direct_light, std::span<const PixelPoint> points,
                             const GatherEffort& effort) {
  const std::vector<const LightTree*> trees = direct_light.sampler().trees(Lights::all);
  const GatherTree tree(points, reach_of(trees, points));
  double light = effort.other;
  for (const PixelPoint& point : points) light += point.about;
  const ProductGoal goal{.share = effort.shadows.cluster_share, .light = light, .most = most_pairs};
  const std::vector<LightPair> cut = in_order(product_cut(trees, tree, goal));
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
  GatheredLight result = std::move(sum).result();
  result.spread = spread_of(cut, tree, points.size(), static_cast<double>(result.radiance.mean()));
  return result;
}

}  // namespace lightwell
