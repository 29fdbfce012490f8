#include "radiosity/many_lights/light_tree.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>

#include "radiosity/many_lights/node_weight.h"
#include "scene/projected_picture.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr int angle_steps = static_cast<int>(IntensityByAngle{}.size());
constexpr double angle_step = pi / angle_steps;

// The step of an angle, by its cosine: the number of steps whose ends are smaller angles.
int step_of_cosine(double cosine) {
  static const std::array<double, angle_steps - 1> ends = [] {
    std::array<double, angle_steps - 1> cosines{};
    for (int k = 1; k < angle_steps; ++k)
      cosines[static_cast<std::size_t>(k) - 1] = std::cos(k * angle_step);
    return cosines;
  }();
  const auto end = std::ranges::lower_bound(ends, cosine, std::greater<>());
  return static_cast<int>(end - ends.begin());
}

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// The greatest value of `shape` within each step, for a function of the angle that falls from 0 to
// pi.
template <class Shape>
IntensityByAngle falling(double scale, Shape shape) {
  IntensityByAngle result;
  for (int k = 0; k < angle_steps; ++k) {
    result[static_cast<std::size_t>(k)] = static_cast<float>(scale * shape(k * angle_step));
  }
  return result;
}

// The greatest value of a web within each step. Values are linear between measured angles, so that
// the greatest are at these and at the ends of steps.
IntensityByAngle greatest_of_web(const PhotometricWeb& web) {
  constexpr double degrees = 180.0 / pi;
  const std::vector<double>& gammas = web.gammas();
  IntensityByAngle result{};
  const auto add = [&](int k, double value) {
    float& greatest = result[static_cast<std::size_t>(k)];
    greatest = std::max(greatest, static_cast<float>(value));
  };
  for (int k = 0; k < angle_steps; ++k) {
    const double first = k * angle_step * degrees, last = (k + 1) * angle_step * degrees;
    for (std::size_t g = 0; g < gammas.size(); ++g) {
      if (gammas[g] >= first && gammas[g] <= last) add(k, web.values().col(g).maxCoeff());
      if (g + 1 == gammas.size()) break;
      for (const double end : {first, last}) {
        const double t = (end - gammas[g]) / (gammas[g + 1] - gammas[g]);
        if (t < 0.0 || t > 1.0) continue;
        add(k, ((1.0 - t) * web.values().col(g) + t * web.values().col(g + 1)).maxCoeff());
      }
    }
  }
  return result;
}

// The cosine of an angle in front of a surface, else 0. Rounding leaves a cosine above 0 at a right
// angle.
double cosine(double angle) {
  constexpr double rounding = 1e-12;
  return std::max(0.0, std::cos(angle) - rounding);
}

LightBound bound_of(const VirtualLight& light, int number, float flux) {
  return {.light = number,
          .box = {light.position, light.position},
          .axis = light.normal,
          .intensity = falling(flux / pi, cosine),
          .most = static_cast<double>(flux) / pi * light.most};
}

// The greatest intensity of a lamp that projects a picture within each step, mean of the bands.
// Bands of a colour rise with each of its red, green and blue.
IntensityByAngle greatest_of_picture(const ProjectedPicture& picture, const Spectrum& light) {
  IntensityByAngle result{};
  const std::vector<Eigen::Array3d> greatest = picture.greatest_by_angle(angle_steps);
  for (std::size_t k = 0; k < result.size(); ++k) {
    result[k] = (light * picture.in_bands(greatest[k])).mean();
  }
  return result;
}

Eigen::AlignedBox3d box_of(const Lamp& lamp) {
  const Vector3d half = 0.5 * lamp.opening.along_c0 * lamp.axes.col(0).cwiseAbs() +
                        0.5 * lamp.opening.along_c90 * lamp.axes.col(1).cwiseAbs();
  return {lamp.position - half, lamp.position + half};
}

// The smallest cone about two cones: axis and half angle.
std::pair<Vector3d, double> joined(const Vector3d& a, double of_a, const Vector3d& b, double of_b) {
  const double between = angle_between(a, b);
  if (between + of_b <= of_a) return {a, of_a};
  if (between + of_a <= of_b) return {b, of_b};
  const double half = 0.5 * (of_a + of_b + between);
  Vector3d side = b - b.dot(a) * a;
  if (half >= pi || !(side.norm() > 0.0)) return {a, pi};
  const double turn = half - of_a;
  return {std::cos(turn) * a + std::sin(turn) * side.normalized(), half};
}

// Steps of IntensityByAngle, first to last, into which a point may lie; and that of the middle.
struct Steps {
  int first = 0, last = 0, middle = 0;
};

// Adds the angles between the node's axis and an axis of a light, and between directions from the
// node's middle and from another of its points, by their sines and cosines. `to`: from the point to
// the node's middle.
Steps steps_to(const LightNode& node, const Vector3d& to, double distance) {
  constexpr int end = angle_steps - 1;
  if (!(distance > node.radius)) return {.last = end};
  const double cos_at = -node.axis.dot(to) / distance,
               sin_at = std::sqrt(std::max(0.0, 1.0 - cos_at * cos_at));
  const double sin_ball = node.radius / distance, cos_ball = std::sqrt(1.0 - sin_ball * sin_ball);
  const double cos_all = node.cosine * cos_ball - node.sine * sin_ball,
               sin_all = node.sine * cos_ball + node.cosine * sin_ball;
  Steps result{.last = end, .middle = step_of_cosine(cos_at)};
  if (sin_all < 0.0) return result;  // more than half a turn
  if (cos_at < cos_all) result.first = step_of_cosine(cos_at * cos_all + sin_at * sin_all);
  if (cos_at > -cos_all) result.last = step_of_cosine(cos_at * cos_all - sin_at * sin_all);
  return result;
}

double greatest(const LightNode& node, const Steps& within) {
  float greatest = 0.0f;
  for (int k = within.first; k <= within.last; ++k) {
    greatest = std::max(greatest, node.intensity[static_cast<std::size_t>(k)]);
  }
  return static_cast<double>(greatest);
}

}  // namespace

double greatest_intensity(const LightNode& node, const Vector3d& point) {
  const Vector3d to = node.middle - point;
  return greatest(node, steps_to(node, to, to.norm()));
}

std::vector<LightBound> bounds_of(std::span<const Emitter> emitters) {
  std::vector<LightBound> bounds;
  for (std::size_t e = 0; e < emitters.size(); ++e) {
    const Emitter& emitter = emitters[e];
    const double M = static_cast<double>(emitter.exitance.mean());
    if (!(M > 0.0)) continue;
    LightBound bound{.light = static_cast<int>(e), .axis = emitter.normal};
    if (emitter.is_sphere) {
      const Vector3d radius = Vector3d::Constant(emitter.sphere.radius);
      bound.box = {emitter.sphere.center - radius, emitter.sphere.center + radius};
      bound.intensity.fill(static_cast<float>(M * emitter.sphere.radius * emitter.sphere.radius));
    } else {
      for (const Loop& loop : emitter.loops) {
        for (const Vector3d& corner : loop) bound.box.extend(corner);
      }
      // A picture may be brighter than its mean where a point sees only a part of the facet, which
      // only single lights are near enough for.
      bound.intensity = falling(M * emitter.area / pi, cosine);
      if (emitter.emits_both_sides) {
        for (int k = 0; k < angle_steps / 2; ++k) {
          bound.intensity[static_cast<std::size_t>(angle_steps - 1 - k)] =
              bound.intensity[static_cast<std::size_t>(k)];
        }
      }
    }
    bounds.push_back(bound);
  }
  return bounds;
}

std::vector<LightBound> bounds_of(std::span<const FreeSource> sources, int first) {
  std::map<const PhotometricWeb*, IntensityByAngle> webs;
  std::vector<LightBound> bounds;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    if (!sources[s].is_on()) continue;
    const int number = first + static_cast<int>(s);
    if (const auto* virtual_light = std::get_if<VirtualLight>(&sources[s].shape)) {
      bounds.push_back(bound_of(*virtual_light, number, sources[s].light.mean()));
      continue;
    }
    const auto* light = std::get_if<LampLight>(&sources[s].shape);
    if (!light) continue;
    const Lamp& lamp = light->lamp;
    LightBound bound{.light = number, .box = box_of(lamp), .axis = lamp.aim()};
    if (const auto* web = std::get_if<SharedWeb>(&lamp.shape)) {
      const auto [known, is_new] = webs.try_emplace(web->get());
      if (is_new) known->second = greatest_of_web(**web);
      bound.intensity = known->second;
    } else if (const auto* picture = std::get_if<SharedPicture>(&lamp.shape)) {
      bound.intensity = greatest_of_picture(**picture, sources[s].light);
      bounds.push_back(bound);
      continue;
    } else {
      const Vector3d across = lamp.axes.col(0);
      bound.intensity = falling(1.0, [&](double angle) {
        return relative_intensity(lamp, std::cos(angle) * lamp.aim() + std::sin(angle) * across);
      });
    }
    for (float& value : bound.intensity) value *= sources[s].light.mean();
    bounds.push_back(bound);
  }
  return bounds;
}

LightTree::LightTree(std::vector<LightBound> lights) {
  nodes_.reserve(2 * lights.size());
  nodes_.emplace_back();
  fill(0, lights);
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const int child = nodes_[n].child;
    if (child >= 0) {
      for (const int half : {child, child + 1}) {
        nodes_[static_cast<std::size_t>(half)].parent = static_cast<int>(n);
      }
      continue;
    }
    const auto light = static_cast<std::size_t>(nodes_[n].light);
    leaf_of_.resize(std::max(leaf_of_.size(), light + 1), -1);
    leaf_of_[light] = static_cast<int>(n);
  }
}

// Halves a cluster at the median along the longest side of the box about the lights' middles.
void LightTree::fill(int node, std::span<LightBound> lights) {
  LightNode filled;
  if (lights.size() == 1) {
    const LightBound& light = lights.front();
    filled.middle = light.box.center();
    filled.half = 0.5 * light.box.sizes();
    filled.axis = light.axis;
    filled.intensity = light.intensity;
    filled.most = light.most;
    filled.light = light.light;
  } else {
    Eigen::AlignedBox3d middles;
    for (const LightBound& light : lights) middles.extend(light.box.center());
    Eigen::Index axis = 0;
    middles.sizes().maxCoeff(&axis);
    const auto half = lights.begin() + static_cast<std::ptrdiff_t>(lights.size() / 2);
    std::nth_element(lights.begin(), half, lights.end(),
                     [&](const LightBound& a, const LightBound& b) {
                       const double x = a.box.center()[axis], y = b.box.center()[axis];
                       return x != y ? x < y : a.light < b.light;
                     });
    filled.child = static_cast<int>(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
    fill(filled.child, {lights.begin(), half});
    fill(filled.child + 1, {half, lights.end()});
    const LightNode &a = nodes_[static_cast<std::size_t>(filled.child)],
                    &b = nodes_[static_cast<std::size_t>(filled.child) + 1];
    const Eigen::AlignedBox3d box = a.box().merged(b.box());
    filled.middle = box.center();
    filled.half = 0.5 * box.sizes();
    std::tie(filled.axis, filled.half_angle) = joined(a.axis, a.half_angle, b.axis, b.half_angle);
    filled.most = a.most + b.most;
    for (std::size_t k = 0; k < filled.intensity.size(); ++k) {
      filled.intensity[k] = a.intensity[k] + b.intensity[k];
    }
  }
  filled.radius = filled.half.norm();
  filled.cosine = std::cos(filled.half_angle);
  filled.sine = std::sin(filled.half_angle);
  nodes_[static_cast<std::size_t>(node)] = filled;
}

LightTree::Seen LightTree::seen(int node, const SurfacePoint& at) const {
  const LightNode& n = this->node(node);
  const Vector3d to = n.middle - at.position;
  const double height = to.dot(at.normal), reach = n.half.dot(at.normal.cwiseAbs());
  if (!(height + reach > 0.0)) return {.node = node};
  const double near = (to.cwiseAbs() - n.half).cwiseMax(0.0).norm(), distance = to.norm();
  Steps steps = steps_to(n, to, distance);
  if (near > 0.0) {
    // The box bounds the cosine to the node's axis as it bounds that at the point, and axes within
    // the cone are nearer to the direction by the cone's half angle at most.
    const double above = n.half.dot(n.axis.cwiseAbs()) - n.axis.dot(to);
    const double cosine = std::clamp(above / near, 0.0, 1.0);
    if (cosine < n.cosine) {
      const double sine = std::sqrt(1.0 - cosine * cosine);
      steps.first = std::max(steps.first, step_of_cosine(cosine * n.cosine + sine * n.sine));
    }
  }
  const double I = greatest(n, steps);
  if (!(I > 0.0)) return {.node = node};
  const double bound =
      near > 0.0 ? std::min(n.most, I * std::min(1.0, (height + reach) / near) / (near * near))
                 : n.most;
  // The middle of a cluster counts as no nearer than the ball about the cluster.
  const double away = std::max(distance, n.radius);
  const double along = static_cast<double>(n.intensity[static_cast<std::size_t>(steps.middle)]);
  const double about = away > 0.0 ? along * std::max(0.0, height) / (away * away * away) : 0.0;
  return {.node = node, .bound = bound, .about = std::min(about, bound)};
}

std::array<LightTree::Seen, 2> LightTree::halves(int node, const SurfacePoint& at) const {
  const int child = nodes_[static_cast<std::size_t>(node)].child;
  return {seen(child, at), seen(child + 1, at)};
}

// Halves are weighed by the intensity that the cluster's steps bound, and by cosine and distance of
// their middles. The weight is 0 only where the bound is.
LightTree::Draw LightTree::draw(int node, const SurfacePoint& at, double u) const {
  const LightNode& cluster = this->node(node);
  const Vector3d to_cluster = cluster.middle - at.position;
  const Steps steps = steps_to(cluster, to_cluster, to_cluster.norm());
  const auto weight = [&](const LightNode& n) { return may_give(n, greatest(n, steps), at); };
  return draw_by(node, u, weight);
}

std::vector<CutPart> roots(const std::vector<const LightTree*>& trees, const SurfacePoint& at) {
  std::vector<CutPart> parts;
  for (const LightTree* tree : trees) {
    const LightTree::Seen seen = tree->root(at);
    if (seen.bound > 0.0) parts.push_back({tree, seen});
  }
  return parts;
}

std::vector<CutPart> light_cut(std::vector<CutPart> parts, const SurfacePoint& at,
                               const CutGoal& goal) {
  std::vector<CutPart> clusters, done;
  double about = 0.0;
  const auto by_bound = [](const CutPart& a, const CutPart& b) {
    return a.seen.bound < b.seen.bound;
  };
  const auto add = [&](const LightTree* tree, const LightTree::Seen& seen) {
    if (!(seen.bound > 0.0)) return;
    about += seen.about;
    if (!tree->is_cluster(seen.node)) {
      done.push_back({tree, seen});
      return;
    }
    clusters.push_back({tree, seen});
    std::push_heap(clusters.begin(), clusters.end(), by_bound);
  };
  for (const CutPart& part : parts) add(part.tree, part.seen);
  const auto is_over = [&](const CutPart& part) {
    // Nothing can be drawn from a cluster without a finite bound.
    if (!std::isfinite(part.seen.bound)) return true;
    return part.seen.bound > goal.share * (goal.light > 0.0 ? goal.light : about) &&
           static_cast<int>(clusters.size() + done.size()) < goal.most;
  };
  while (!clusters.empty() && is_over(clusters.front())) {
    std::pop_heap(clusters.begin(), clusters.end(), by_bound);
    const CutPart whole = clusters.back();
    clusters.pop_back();
    about -= whole.seen.about;
    for (const LightTree::Seen& half : whole.tree->halves(whole.seen.node, at)) {
      add(whole.tree, half);
    }
  }
  done.insert(done.end(), clusters.begin(), clusters.end());
  return done;
}

}  // namespace lightwell
