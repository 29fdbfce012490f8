#include "radiosity/closed_forms/polygon_exchange.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace lightwell {
namespace {

using Eigen::Vector3d;
using Loops = std::vector<std::vector<Vector3d>>;

// Clips the loops to the side of the plane to which `normal` points. Where a loop falls into
// pieces, the pieces stay joined by pairs of opposite edges, which cancel in the contour integral.
Loops clipped(const Loops& loops, const Vector3d& on_plane, const Vector3d& normal,
              double tolerance) {
  Loops result;
  for (const auto& loop : loops) {
    std::vector<Vector3d> kept;
    const std::size_t n = loop.size();
    bool any_before = false;
    for (std::size_t i = 0; i < n; ++i) {
      const Vector3d &a = loop[i], &b = loop[(i + 1) % n];
      const double height_a = normal.dot(a - on_plane), height_b = normal.dot(b - on_plane);
      any_before = any_before || height_a > tolerance;
      if (height_a >= -tolerance) kept.push_back(a);
      const bool crosses = (height_a > tolerance && height_b < -tolerance) ||
                           (height_a < -tolerance && height_b > tolerance);
      if (crosses) kept.push_back(a + height_a / (height_a - height_b) * (b - a));
    }
    if (any_before && kept.size() >= 3) result.push_back(std::move(kept));
  }
  return result;
}

struct EdgeOf {
  Vector3d from, along;  // start, unit direction
  double length;
};

// int ln |x - point| over the edge.
double log_integral(const Vector3d& point, const EdgeOf& edge) {
  const Vector3d to_start = edge.from - point;
  const double start = to_start.dot(edge.along), end = start + edge.length;
  const double squared = (to_start - start * edge.along).squaredNorm();  // no cancellation near 0
  const double distance = std::sqrt(squared);
  const auto antiderivative = [&](double x) {
    const double r2 = x * x + squared;
    return (r2 > 0.0 ? 0.5 * x * std::log(r2) : 0.0) - x;
  };
  double value = antiderivative(end) - antiderivative(start);
  // atan(end / d) - atan(start / d) as a single arc tangent.
  if (distance > 0.0) value += distance * std::atan2(distance * edge.length, squared + start * end);
  return value;
}

struct Node {
  double at;  // in [0, 1]
  double weight;
};

// Gauss-Legendre rule with n nodes on [0, 1]; nodes by Newton's method on the Legendre polynomial.
std::vector<Node> gauss_legendre(int n) {
  std::vector<Node> nodes;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 1.0;
    constexpr int steps = 60;
    for (int step = 0; step < steps; ++step) {
      double before = 1.0, p = x;
      for (int k = 2; k <= n; ++k) {
        const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
        before = p;
        p = next;
      }
      slope = n * (x * p - before) / (x * x - 1.0);
      x -= p / slope;
    }
    nodes.push_back({0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope)});
  }
  return nodes;
}

// Double-exponential rule on [0, 1] (Takahasi & Mori 1974), which also converges for integrands
// such as t ln t, singular at an end.
std::vector<Node> double_exponential() {
  std::vector<Node> nodes;
  constexpr double step = 0.14, reach = 3.2;
  for (double x = -reach; x <= reach + 0.5 * step; x += step) {
    const double u = 0.5 * std::numbers::pi * std::sinh(x);
    const double c = std::cosh(u);
    const double weight = 0.25 * std::numbers::pi * step * std::cosh(x) / (c * c);
    nodes.push_back({0.5 * std::exp(u) / c, weight});
  }
  return nodes;
}

struct Rules {
  std::vector<Node> far = gauss_legendre(3), middle = gauss_legendre(6), near = gauss_legendre(12),
                    touching = double_exponential();

  // `gap`: distance between the piece and the other edge, in lengths of the piece.
  const std::vector<Node>& rule_for(double gap) const {
    if (gap > 6.0) return far;
    if (gap > 1.5) return middle;
    if (gap > 0.4) return near;
    return touching;
  }
};

double distance_to_edge(const Vector3d& p, const EdgeOf& edge) {
  const double t = std::clamp((p - edge.from).dot(edge.along), 0.0, edge.length);
  return (edge.from + t * edge.along - p).norm();
}

// Lower bound of the distance between two edges, sharp where the edges are far apart.
double gap_between(const EdgeOf& edge, const EdgeOf& other) {
  const Vector3d middle = edge.from + 0.5 * edge.length * edge.along;
  return std::max(0.0, distance_to_edge(middle, other) - 0.5 * edge.length);
}

// int int ln r ds dt over two edges: quadrature along the first, closed form along the second.
double edge_pair(const Rules& rules, const EdgeOf& edge, const EdgeOf& other) {
  const auto& [a, along, length] = edge;
  // The integrand is least smooth opposite the ends of the other edge, so close edges are cut
  // there.
  std::array<double, 4> cut = {0.0, (other.from - a).dot(along),
                               (other.from + other.length * other.along - a).dot(along), length};
  for (double& c : cut) c = std::clamp(c, 0.0, length);
  const bool is_close = gap_between(edge, other) < 1.5 * length;
  if (!is_close) cut[1] = cut[2] = 0.0;
  std::sort(cut.begin(), cut.end());
  double sum = 0.0;
  for (int piece = 0; piece < 3; ++piece) {
    const double part = cut[piece + 1] - cut[piece];
    if (!(part > 1e-12 * length)) continue;
    const Vector3d start = a + cut[piece] * along;
    const double gap = gap_between({start, along, part}, other);
    for (const Node& node : rules.rule_for(gap / part)) {
      sum += node.weight * part * log_integral(start + node.at * part * along, other);
    }
  }
  return sum;
}

EdgeOf in_units(const EdgeOf& edge, double unit) {
  return {edge.from / unit, edge.along, edge.length / unit};
}

std::vector<EdgeOf> edges_of(const Loops& loops) {
  std::vector<EdgeOf> edges;
  for (const auto& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vector3d edge = loop[(i + 1) % loop.size()] - loop[i];
      const double length = edge.norm();
      if (length > 0.0) edges.push_back({loop[i], edge / length, length});
    }
  }
  return edges;
}

}  // namespace

double polygon_exchange(const PatchOutline& first, const PatchOutline& second) {
  if (!first.is_polygon() || !second.is_polygon()) return 0.0;
  static const Rules rules;
  constexpr double on_plane = 1e-9;  // relative to the pair's size
  const double tolerance =
      on_plane * (first.radius + second.radius + (first.center - second.center).norm());
  const Loops a = clipped(first.loops, second.loops[0][0], second.normal, tolerance);
  const Loops b = clipped(second.loops, first.loops[0][0], first.normal, tolerance);
  if (a.empty() || b.empty()) return 0.0;
  const std::vector<EdgeOf> edges = edges_of(a), others = edges_of(b);
  // Lengths relative to the pair's size avoid cancellation. The unit does not matter: a constant
  // added to ln r integrates to 0 around a loop.
  const double unit = first.radius + second.radius;
  double sum = 0.0;
  for (const EdgeOf& p : edges) {
    for (const EdgeOf& q : others) {
      const double cosine = p.along.dot(q.along);
      if (std::abs(cosine) < 1e-14) continue;
      // Quadrature along the shorter edge, closed form along the longer.
      const bool first_is_shorter = p.length <= q.length;
      const EdgeOf& outer = first_is_shorter ? p : q;
      const EdgeOf& inner = first_is_shorter ? q : p;
      sum += cosine * edge_pair(rules, in_units(outer, unit), in_units(inner, unit));
    }
  }
  return std::max(0.0, sum * unit * unit / (2.0 * std::numbers::pi));
}

}  // namespace lightwell
