#include "raytrace/readings/specular_chains.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "scene/sampling.h"

namespace lightwell {
namespace {

// Offset of a path from its goal across its last straight part: m, or sines for a direction.
Eigen::Vector2d offset(const PathGoal& goal, const Eigen::Vector3d& origin,
                       const Eigen::Vector3d& exit, const Eigen::Matrix3d& axes) {
  if (goal.is_direction) {
    const Eigen::Vector3d d = exit - goal.position;
    return {d.dot(axes.col(0)), d.dot(axes.col(1))};
  }
  // The path crosses the plane through the goal, whose normal is axes.col(2), after t.
  const double along = exit.dot(axes.col(2));
  const double t = (goal.position - origin).dot(axes.col(2)) / along;
  const Eigen::Vector3d d = origin + t * exit - goal.position;
  return {d.dot(axes.col(0)), d.dot(axes.col(1))};
}

using RayDirection = std::array<double, 3>;

// Seeds of one of the first rays have the same direction to the bit.
RayDirection ray_direction(const SpecularSeed& seed) {
  return {seed.direction.x(), seed.direction.y(), seed.direction.z()};
}

}  // namespace

std::optional<SpecularPaths::Traced> SpecularPaths::trace(const Eigen::Vector3d& direction,
                                                          std::uint64_t chain,
                                                          const ChainTurns& turns) const {
  std::optional<Traced> found;
  if (!(direction.dot(at_.normal) > 0.0)) return found;
  tree_.trace_chain({.origin = at_.position, .direction = direction, .origin_group = at_.facet},
                    turns, [&](const SpecularSegment& part) {
                      if (part.chain != chain) return;
                      found = Traced{.origin = part.ray.origin,
                                     .exit = part.ray.direction.normalized(),
                                     .end = part.end * part.ray.direction.norm(),
                                     .weight = part.weight,
                                     .media = part.media,
                                     .facet = part.ray.origin_group};
                    });
  return found;
}

std::optional<PathToGoal> SpecularPaths::find(const PathGoal& goal, std::uint64_t key,
                                              const SpecularChain& chain, double clearance) const {
  const auto miss = [&](const SpecularSeed& seed) {
    const Eigen::Vector3d to = goal.is_direction
                                   ? goal.position
                                   : Eigen::Vector3d((goal.position - seed.origin).normalized());
    return -to.dot(seed.exit.normalized());
  };
  const auto& nearest = *std::ranges::min_element(
      chain.seeds, [&](const SpecularSeed& a, const SpecularSeed& b) { return miss(a) < miss(b); });
  Eigen::Vector3d w = nearest.direction.normalized();
  auto path = trace(w, key, chain.turns);
  constexpr int most_steps = 20;
  // Hits are known to about 1e-7 of their distance, and a difference over 1e-3 rad is exact to
  // 1e-6 where the chain is flat.
  constexpr double probe_angle = 1e-3;
  for (int step = 0; path && step < most_steps; ++step) {
    Eigen::Matrix3d axes;
    axes.col(2) = path->exit;
    Eigen::Vector3d a, b;
    tangent_frame(path->exit, a, b);
    axes.col(0) = a;
    axes.col(1) = b;
    const Eigen::Vector2d r = offset(goal, path->origin, path->exit, axes);
    Eigen::Vector3d p, q;
    tangent_frame(w, p, q);
    const auto derivative = [&](const Eigen::Vector3d& side) -> std::optional<Eigen::Vector2d> {
      const auto value = [&](double angle) -> std::optional<Eigen::Vector2d> {
        const auto beside = trace((w + angle * side).normalized(), key, chain.turns);
        if (!beside) return std::nullopt;
        return offset(goal, beside->origin, beside->exit, axes);
      };
      const auto above = value(probe_angle), below = value(-probe_angle);
      if (above && below) return (*above - *below) / (2.0 * probe_angle);
      if (above) return (*above - r) / probe_angle;
      if (below) return (r - *below) / probe_angle;
      return std::nullopt;
    };
    const auto dp = derivative(p), dq = derivative(q);
    if (!dp || !dq) return std::nullopt;
    Eigen::Matrix2d A;
    A << *dp, *dq;
    const double det = A.determinant();
    if (!(std::abs(det) > 0.0)) return std::nullopt;
    const double distance =
        goal.is_direction ? 0.0 : (goal.position - path->origin).dot(path->exit);
    const double scale = goal.is_direction ? 1.0 : std::max(distance, clearance);
    if (r.norm() <= 1e-6 * scale) {
      const bool is_hidden = goal.is_direction
                                 ? std::isfinite(path->end)
                                 : distance <= 0.0 || path->end < distance - clearance;
      if (is_hidden) return std::nullopt;
      const Ray last{.origin = path->origin, .direction = path->exit, .origin_group = path->facet};
      return PathToGoal{
          .direction = w,
          .exit = path->exit,
          .distance = distance,
          .spread = std::abs(det),
          .weight = goal.is_direction
                        ? path->weight
                        : Spectrum(path->weight * tree_.left_along(path->media, last, distance))};
    }
    Eigen::Vector2d move = -A.inverse() * r;
    if (!(move.norm() < 1e6)) return std::nullopt;
    if (move.norm() > 0.5) move *= 0.5 / move.norm();
    std::optional<Traced> next;
    Eigen::Vector3d moved = w;
    for (int halving = 0; halving < 8 && !next; ++halving, move *= 0.5) {
      moved = (w + move.x() * p + move.y() * q).normalized();
      next = trace(moved, key, chain.turns);
    }
    path = next;
    w = moved;
  }
  return std::nullopt;
}

double all_straight(const SpecularChains& chains, const PathGoal& goal,
                    const Eigen::Vector3d& towards, std::span<const std::uint64_t> found,
                    double clearance) {
  const double near = std::cos(std::numbers::pi / 18.0);
  const auto counts = [&](const SpecularSeed& seed) {
    if (seed.direction.dot(towards) < near) return false;
    const double distance = (goal.position - seed.origin).dot(seed.exit);
    return goal.is_direction ? !std::isfinite(seed.end)
                             : distance > 0.0 && seed.end >= distance - clearance;
  };
  double of_found = 0.0, of_others = 0.0;
  std::set<RayDirection> rays;
  for (const std::uint64_t key : found) {
    for (const SpecularSeed& seed : chains.at(key).seeds) {
      if (!counts(seed)) continue;
      of_found += seed.weight;
      rays.insert(ray_direction(seed));
    }
  }
  if (!(of_found > 0.0)) return 1.0;
  for (const auto& [key, chain] : chains) {
    if (!chain.is_straight || std::ranges::binary_search(found, key)) continue;
    for (const SpecularSeed& seed : chain.seeds) {
      if (counts(seed) && rays.contains(ray_direction(seed))) of_others += seed.weight;
    }
  }
  constexpr double most = 2.0;
  return std::min(most, (of_found + of_others) / of_found);
}

}  // namespace lightwell
