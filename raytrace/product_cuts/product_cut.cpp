#include "raytrace/product_cuts/product_cut.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lightwell {
namespace {

using Eigen::Vector3d;

// Differences between places of two boxes fill a box about the difference of their middles.
struct Differences {
  Vector3d middle, half;
  double near = 0.0, distance = 0.0, radius = 0.0;

  Differences(const LightNode& lights, const GatherNode& points)
      : middle(lights.middle - points.middle),
        half(lights.half + points.half),
        near((middle.cwiseAbs() - half).cwiseMax(0.0).norm()),
        distance(middle.norm()),
        radius(half.norm()) {}

  // The greatest cosine between one of them and a direction.
  double greatest_cosine(const Vector3d& direction) const {
    const double along = middle.dot(direction) + half.dot(direction.cwiseAbs());
    if (along > 0.0) return near > 0.0 ? std::min(1.0, along / near) : 1.0;
    return along / (distance + radius);
  }
};

// The cosine of an angle less another, for angles by cosine and sine; 1 if the other is greater.
double cosine_of_difference(double cosine, double of_other, double sine_of_other) {
  if (cosine >= of_other) return 1.0;
  return cosine * of_other + std::sqrt(std::max(0.0, 1.0 - cosine * cosine)) * sine_of_other;
}

// Bound of the intensity by angles to the axes, which the box of differences bounds as the ball
// about the node does: the smaller of both.
double intensity_bound(const LightNode& lights, const Differences& between) {
  LightNode wide = lights;
  wide.half = between.half;
  wide.radius = between.radius;
  const double of_ball = greatest_intensity(wide, lights.middle - between.middle);
  if (!(between.near > 0.0)) return of_ball;
  const double cosine =
      cosine_of_difference(between.greatest_cosine(-lights.axis), lights.cosine, lights.sine);
  if (cosine >= 1.0) return of_ball;
  constexpr double rounding = 1e-9;
  const auto steps = static_cast<double>(lights.intensity.size());
  const double angle = std::acos(std::max(-1.0, cosine));
  const auto first = static_cast<std::ptrdiff_t>(
      std::clamp(angle * steps / std::numbers::pi - rounding, 0.0, steps - 1.0));
  const float of_box = *std::max_element(lights.intensity.begin() + first, lights.intensity.end());
  return std::min(of_ball, static_cast<double>(of_box));
}

LightPair pair_of(const LightTree* tree, int light, const GatherTree& points, int gather) {
  const GatherNode& cluster = points.node(gather);
  const PairLight seen = pair_light(tree->node(light), cluster);
  return {.tree = tree,
          .light = light,
          .gather = gather,
          .bound = cluster.strength > 0.0 ? cluster.strength * seen.bound : 0.0,
          .about = cluster.strength * seen.about};
}

// True if halves of the points bound the pair's light more narrowly than halves of the lights do:
// points are farther apart, by place or by normal.
bool splits_points(const LightPair& pair, const GatherTree& points) {
  if (!points.is_cluster(pair.gather)) return false;
  if (!pair.tree->is_cluster(pair.light)) return true;
  const GatherNode& cluster = points.node(pair.gather);
  const LightNode& lights = pair.tree->node(pair.light);
  const double distance = (lights.middle - cluster.middle).norm();
  const double turn = cluster.cosine > 0.0 ? cluster.sine : 1.0;
  return cluster.radius + turn * distance > lights.radius;
}

std::array<LightPair, 2> halves(const LightPair& pair, const GatherTree& points) {
  if (splits_points(pair, points)) {
    const int child = points.node(pair.gather).child;
    return {pair_of(pair.tree, pair.light, points, child),
            pair_of(pair.tree, pair.light, points, child + 1)};
  }
  const int child = pair.tree->node(pair.light).child;
  return {pair_of(pair.tree, child, points, pair.gather),
          pair_of(pair.tree, child + 1, points, pair.gather)};
}

}  // namespace

PairLight pair_light(const LightNode& lights, const GatherNode& points) {
  const Differences between(lights, points);
  const double cosine =
      cosine_of_difference(between.greatest_cosine(points.axis), points.cosine, points.sine);
  if (!(cosine > 0.0)) return {};
  const double I = intensity_bound(lights, between);
  if (!(I > 0.0)) return {};
  const double near = between.near, far = std::max(between.distance, between.radius);
  const double bound = near > 0.0 ? std::min(lights.most, I * cosine / (near * near)) : lights.most;
  const double height = std::max(0.0, between.middle.dot(points.axis));
  return {.bound = bound,
          .about = far > 0.0 ? std::min(bound, I * height / (far * far * far)) : 0.0};
}

std::vector<LightPair> product_cut(const std::vector<const LightTree*>& trees,
                                   const GatherTree& points, const ProductGoal& goal) {
  constexpr double least = 0.01;
  std::vector<LightPair> open, done;
  double about = 0.0;
  const auto by_bound = [](const LightPair& a, const LightPair& b) { return a.bound < b.bound; };
  const auto add = [&](const LightPair& pair) {
    if (!(pair.bound > 0.0)) return;
    about += pair.about;
    if (!pair.tree->is_cluster(pair.light) && !points.is_cluster(pair.gather)) {
      done.push_back(pair);
      return;
    }
    open.push_back(pair);
    std::ranges::push_heap(open, by_bound);
  };
  for (const LightTree* tree : trees) add(pair_of(tree, 0, points, 0));
  const auto is_over = [&](const LightPair& pair) {
    // Nothing can be drawn from a pair without a finite bound.
    if (!std::isfinite(pair.bound)) return true;
    return pair.bound > goal.share * std::max(goal.light, least * about) &&
           static_cast<int>(open.size() + done.size()) < goal.most;
  };
  while (!open.empty() && is_over(open.front())) {
    std::ranges::pop_heap(open, by_bound);
    const LightPair whole = open.back();
    open.pop_back();
    about -= whole.about;
    for (const LightPair& half : halves(whole, points)) add(half);
  }
  done.insert(done.end(), open.begin(), open.end());
  return done;
}

}  // namespace lightwell
