#include "raytrace/disc_kernel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/sampling.h"

namespace lightwell {
namespace {

// In the sharpest corner worth the name some percent are left, and less is rounding.
constexpr double least_within = 0.02;

struct FlatEdge {
  Eigen::Vector2d from, to;
};

// The part of an edge that a disc of radius 1 about the origin reaches, from x0 to x1 along it at
// distance h, which is above 0 if it runs counter-clockwise, and the angle that is seen under.
struct Chord {
  double h = 0.0, x0 = 0.0, x1 = 0.0, angle = 0.0;
};

Chord chord(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const double length = (to - from).norm();
  if (!(length > 0.0)) return {};
  const Eigen::Vector2d along = (to - from) / length;
  const double h = from.x() * along.y() - from.y() * along.x();
  // An edge through the very centre has no side to be on; it cuts off nothing.
  if (!(std::abs(h) < 1.0) || h == 0.0) return {};
  const double half = std::sqrt(1.0 - h * h);
  const double x0 = std::clamp(from.dot(along), -half, half);
  const double x1 = std::clamp(to.dot(along), -half, half);
  return {h, x0, x1, std::atan(x1 / h) - std::atan(x0 / h)};
}

// Edges in the plane of a disc, which has radius 1 there and lies about the origin.
struct FlatBoundary {
  Eigen::Vector3d right, up;
  std::vector<FlatEdge> edges{};

  FlatBoundary(const Eigen::Vector3d& center, const Eigen::Vector3d& normal, double radius,
               std::span<const LightRegions::Edge> of) {
    tangent_frame(normal, right, up);
    for (const LightRegions::Edge& edge : of) {
      const Eigen::Vector3d from = (edge.from - center) / radius, to = (edge.to - center) / radius;
      edges.push_back({{from.dot(right), from.dot(up)}, {to.dot(right), to.dot(up)}});
    }
  }

  // What is left of the kernel of a disc elsewhere. If that is outside, the edges turn around its
  // centre by nothing, which leaves what they cut off with the other sign.
  double kernel_within(const Eigen::Vector2d& of, bool is_inside) const {
    double beyond = 0.0;
    for (const FlatEdge& edge : edges) beyond += kernel_beyond(edge.from - of, edge.to - of);
    if (is_inside) return std::clamp(1.0 - beyond, 0.0, 1.0);
    // Mirrored across a thin gap, a centre may lie within again.
    constexpr double rounding = 1e-9;
    return std::clamp(beyond > rounding ? 1.0 - beyond : -beyond, 0.0, 1.0);
  }
};

// The nearest places of edges that are seen at a right angle, once each: at a corner that juts in
// a mirror as long as its line would show what is there anyway.
std::vector<Eigen::Vector2d> mirrors_in_reach(std::span<const FlatEdge> edges) {
  constexpr std::size_t most = 8;
  constexpr double alike = 1e-4;  // of the radius
  std::vector<Eigen::Vector2d> feet;
  for (const FlatEdge& edge : edges) {
    const double length = (edge.to - edge.from).norm();
    if (!(length > 0.0) || feet.size() == most) continue;
    const Eigen::Vector2d along = (edge.to - edge.from) / length;
    const double h = edge.from.x() * along.y() - edge.from.y() * along.x();
    const bool is_beside = edge.from.dot(along) <= alike && edge.to.dot(along) >= -alike;
    if (!is_beside || !(h > 0.0) || !(h < 1.0)) continue;
    const Eigen::Vector2d foot = h * Eigen::Vector2d(along.y(), -along.x());
    const auto is_same = [&](const Eigen::Vector2d& other) {
      return (foot - other).norm() < alike;
    };
    if (std::none_of(feet.begin(), feet.end(), is_same)) feet.push_back(foot);
  }
  return feet;
}

// Once across each edge, and across both edges of a right corner that is within reach.
std::vector<Eigen::Vector2d> mirrored_centers(const std::vector<Eigen::Vector2d>& feet) {
  constexpr double nearly_right = 0.05;  // cosine
  std::vector<Eigen::Vector2d> centers;
  for (std::size_t i = 0; i < feet.size(); ++i) {
    centers.push_back(2.0 * feet[i]);
    for (std::size_t j = 0; j < i; ++j) {
      const double cosine = feet[i].dot(feet[j]) / (feet[i].norm() * feet[j].norm());
      const Eigen::Vector2d corner = feet[i] + feet[j];
      if (std::abs(cosine) < nearly_right && corner.norm() < 1.0) centers.push_back(2.0 * corner);
    }
  }
  return centers;
}

}  // namespace

double kernel_beyond(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const Chord c = chord(from, to);
  // Around the centre by an angle t, the kernel within the edge at x = h tan(t) is
  //   G(s) dt, G = (s^2 - s^4 / 2) / pi with s^2 = h^2 / cos^2(t),
  // and 1 / (2 pi) dt without it.
  const auto within = [&](double x) {
    return (c.h * x - 0.5 * (c.h * c.h * c.h * x + c.h * x * x * x / 3.0)) / std::numbers::pi;
  };
  return c.angle / (2.0 * std::numbers::pi) - (within(c.x1) - within(c.x0));
}

double disc_beyond(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const Chord c = chord(from, to);
  return (c.angle - c.h * (c.x1 - c.x0)) / (2.0 * std::numbers::pi);
}

FoldedDisc fold(const Eigen::Vector3d& center, const Eigen::Vector3d& normal, double radius,
                std::span<const LightRegions::Edge> edges) {
  if (edges.empty()) return {};
  const FlatBoundary flat(center, normal, radius, edges);
  FoldedDisc folded{.within = flat.kernel_within(Eigen::Vector2d::Zero(), true)};
  for (const Eigen::Vector2d& c : mirrored_centers(mirrors_in_reach(flat.edges))) {
    folded.within += flat.kernel_within(c, false);
    folded.mirrored.push_back(center + radius * (c.x() * flat.right + c.y() * flat.up));
  }
  folded.within = std::max(folded.within, least_within);
  return folded;
}

double disc_within(const Eigen::Vector3d& center, const Eigen::Vector3d& normal, double radius,
                   std::span<const LightRegions::Edge> edges) {
  if (edges.empty()) return 1.0;
  const FlatBoundary flat(center, normal, radius, edges);
  double beyond = 0.0;
  for (const FlatEdge& edge : flat.edges) beyond += disc_beyond(edge.from, edge.to);
  return std::clamp(1.0 - beyond, least_within, 1.0);
}

}  // namespace lightwell
