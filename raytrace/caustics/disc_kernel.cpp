#include "raytrace/caustics/disc_kernel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/sampling.h"

namespace lightwell {
namespace {

// Least share within the boundary. The sharpest corners that matter leave some percent of the disc;
// smaller shares are rounding.
constexpr double least_within = 0.02;

struct FlatEdge {
  Eigen::Vector2d from, to;
};

// Part of an edge within the unit disc about the origin: from x0 to x1 along the edge, at a signed
// distance h from the origin, positive for counter-clockwise edges. `angle` is the angle of the
// part at the origin, radians.
struct Chord {
  double h = 0.0, x0 = 0.0, x1 = 0.0, angle = 0.0;
};

Chord chord(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const double length = (to - from).norm();
  if (!(length > 0.0)) return {};
  const Eigen::Vector2d along = (to - from) / length;
  const double h = from.x() * along.y() - from.y() * along.x();
  // An edge through the centre cuts off nothing, since its side is undefined.
  if (!(std::abs(h) < 1.0) || h == 0.0) return {};
  const double half = std::sqrt(1.0 - h * h);
  const double x0 = std::clamp(from.dot(along), -half, half);
  const double x1 = std::clamp(to.dot(along), -half, half);
  return {h, x0, x1, std::atan(x1 / h) - std::atan(x0 / h)};
}

// Edges in the plane of a disc, in coordinates where the disc has radius 1 about the origin.
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

  // Integral within the boundary of the kernel of the unit disc about `of`. If the centre is
  // outside, the edges' winding number around it is 0, and the integral is minus the sum over
  // edges.
  double kernel_within(const Eigen::Vector2d& of, bool is_inside) const {
    double beyond = 0.0;
    for (const FlatEdge& edge : edges) beyond += kernel_beyond(edge.from - of, edge.to - of);
    if (is_inside) return std::clamp(1.0 - beyond, 0.0, 1.0);
    // The image of a centre across a thin gap may lie inside the boundary again.
    constexpr double rounding = 1e-9;
    return std::clamp(beyond > rounding ? 1.0 - beyond : -beyond, 0.0, 1.0);
  }
};

// Feet of the perpendiculars from the origin to edges in reach, each foot once. An edge without its
// foot is no mirror: at a reflex corner, the mirror of the edge's whole line would show what is
// there anyway.
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

// Images of the disc's centre across each mirror, and across both mirrors of a right corner within
// reach.
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
  // The kernel within the edge at x = h tan(t), for a sector of angle dt at the centre, is
  //       G(s) dt, G = (s^2 - s^4 / 2) / pi with s^2 = h^2 / cos^2(t),
  // the kernel of the whole sector is 1 / (2 pi) dt.
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
