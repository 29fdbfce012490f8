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

// Gauss's rule of n nodes and the least `room` (see room_for()) at which its error is below 1e-12:
// rho^(-2 n) with rho the sum of the axes of the ellipse, room = (rho + 1 / rho) / 2.
struct SizedRule {
  explicit SizedRule(int n) : nodes(gauss_legendre(n)) {
    constexpr double error = 1e-12;
    const double rho = std::pow(error, -0.5 / n);
    least_room = 0.5 * (rho + 1.0 / rho);
  }
  std::vector<Node> nodes;
  double least_room;
};

struct Rules {
  // For edges farther than 6 lengths: an error of 24^-6 = 5e-9 of terms that are smooth by then and
  // cancel around the loops.
  std::vector<Node> far = gauss_legendre(3);
  std::vector<Node> touching = double_exponential();
  std::array<SizedRule, 6> sized = {SizedRule(4),  SizedRule(6),  SizedRule(8),
                                    SizedRule(12), SizedRule(16), SizedRule(20)};
  double least_room = sized.back().least_room;

  // Precondition: room >= least_room.
  const std::vector<Node>& rule_for(double room) const {
    for (const SizedRule& rule : sized) {
      if (room >= rule.least_room) return rule.nodes;
    }
    return sized.back().nodes;
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

// Sine of edges that count as parallel: it moves their ends by 1e-12 of their length.
constexpr double parallel = 1e-12;

// Second antiderivative of ln sqrt(x^2 + D^2).
double log_antiderivative(double x, double D) {
  const double squared = x * x + D * D;
  if (!(squared > 0.0)) return 0.0;
  return 0.25 * (x * x - D * D) * std::log(squared) - 0.75 * x * x + x * D * std::atan2(x, D);
}

// int int ln r ds dt over parallel edges, in closed form: `begin` and `end` of one edge along the
// other, which reaches from 0 to `length`, at distance D of each other.
double parallel_pair(double begin, double end, double length, double D) {
  const auto above = [&](double x) {
    return log_antiderivative(x, D) - log_antiderivative(x - length, D);
  };
  return above(std::max(begin, end)) - above(std::min(begin, end));
}

// Point t = at +- i height of the complex plane where the integral of ln r over the other edge, as
// a function of the place t along an edge, is not analytic.
struct Singularity {
  double at, height;
};

// Quadrature of log_integral along `edge`, in pieces that shrink towards its singularities. There
// are three: r = 0 at either end of `other`, and r = 0 on the line of `other`, which counts where
// the nearest point of that line lies on the edge.
class GradedQuadrature {
 public:
  GradedQuadrature(const Rules& rules, const EdgeOf& edge, const EdgeOf& other)
      : rules_(rules), edge_(edge), other_(other) {
    const Vector3d between = other.from - edge.from;
    for (const double s : {0.0, other.length}) {
      const Vector3d to_end = between + s * other.along;
      const double at = to_end.dot(edge.along);
      add({at, (to_end - at * edge.along).norm()});
    }
    const Vector3d across = edge.along.cross(other.along);
    const double sine2 = across.squaredNorm();
    if (!(sine2 > parallel * parallel)) return;
    const double at = between.cross(other.along).dot(across) / sine2;
    const double on_other = between.cross(edge.along).dot(across) / sine2;
    if (on_other < 0.0 || on_other > other.length) return;
    add({at, std::abs(between.dot(across)) / sine2});
  }

  double value() const { return over(0.0, edge_.length); }

 private:
  void add(const Singularity& s) { singularities_[static_cast<std::size_t>(count_++)] = s; }

  // Half the sum of the axes of the ellipse through a singularity whose foci are the ends of the
  // piece, in units of half the piece. Gauss's rule converges with the largest ellipse that is free
  // of singularities.
  static double room_for(const Singularity& s, double begin, double end) {
    return (std::hypot(s.at - begin, s.height) + std::hypot(s.at - end, s.height)) / (end - begin);
  }
  static bool is_at(const Singularity& s, double place, double size) {
    constexpr double touching = 1e-9;
    return s.height <= touching * size && std::abs(s.at - place) <= touching * size;
  }

  double apply(const std::vector<Node>& rule, double begin, double end) const {
    double sum = 0.0;
    for (const Node& node : rule) {
      const double t = begin + node.at * (end - begin);
      sum += node.weight * log_integral(edge_.from + t * edge_.along, other_);
    }
    return sum * (end - begin);
  }

  double over(double begin, double end) const {
    // A piece so short contributes less than its rounding.
    constexpr double shortest = 1e-10;
    const double size = end - begin;
    double room = HUGE_VAL, room_inside = HUGE_VAL;
    const Singularity* nearest = nullptr;
    for (int k = 0; k < count_; ++k) {
      const Singularity& s = singularities_[static_cast<std::size_t>(k)];
      const double here = room_for(s, begin, end);
      if (here < room) {
        room = here;
        nearest = &s;
      }
      if (!is_at(s, begin, size) && !is_at(s, end, size)) room_inside = std::min(room_inside, here);
    }
    if (room >= rules_.least_room) return apply(rules_.rule_for(room), begin, end);
    if (room_inside >= rules_.least_room) return apply(rules_.touching, begin, end);
    if (size < shortest * edge_.length) return apply(rules_.sized.front().nodes, begin, end);
    // A cut opposite the singularity, else towards the end that is nearer to it.
    constexpr double aside = 1e-3, step = 0.25;
    double cut = nearest->at;
    if (cut < begin + aside * size) {
      cut = begin + step * size;
    } else if (cut > end - aside * size) {
      cut = end - step * size;
    }
    return over(begin, cut) + over(cut, end);
  }

  const Rules& rules_;
  const EdgeOf &edge_, &other_;
  std::array<Singularity, 3> singularities_{};
  int count_ = 0;
};

// int int ln r ds dt over two edges: in closed form for near parallel edges, otherwise quadrature
// along the first, closed form along the second.
double edge_pair(const Rules& rules, const EdgeOf& edge, const EdgeOf& other) {
  const auto& [a, along, length] = edge;
  constexpr double far = 6.0;
  if (gap_between(edge, other) > far * length) {
    double sum = 0.0;
    for (const Node& node : rules.far) {
      sum += node.weight * log_integral(a + node.at * length * along, other);
    }
    return sum * length;
  }
  // The closed form is a second difference of terms of size reach^2, so its rounding is
  // (reach / length)^2 times that of a double.
  constexpr double longest_reach = 100.0;
  if (along.cross(other.along).squaredNorm() < parallel * parallel) {
    const Vector3d between = other.from - a;
    const double begin = between.dot(along);
    const double end = begin + other.length * along.dot(other.along);
    const double reach = std::max(std::abs(begin), std::abs(end));
    if (reach < longest_reach * length) {
      return parallel_pair(begin, end, length, (between - begin * along).norm());
    }
  }
  return GradedQuadrature(rules, edge, other).value();
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
