#include "mesh/facets/graded_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "mesh/facets/flat_box.h"
#include "mesh/geometry/cross.h"
#include "mesh/geometry/facet_plane.h"

namespace lightwell {
namespace {

using Eigen::Vector2d;

constexpr double one_degree = std::numbers::pi / 180.0;
constexpr double least_edge = 0.01;  // of the element size; shorter edges are ignored

struct Candidate {
  // Length of the triangle's shortest edge in millionths of an element, so that rounding decides no
  // ties.
  double rank = 0.0;
  int triangle = 0;
  double edge = 0.0;  // s, the length of that edge, metres
  Vector2d at = Vector2d::Zero();
};

class Grading {
 public:
  Grading(const PlanarTriangulation& triangulation, const std::vector<std::array<int, 2>>& lines,
          double element_size)
      : t_(triangulation), lines_(lines), element_size_(element_size), tree_(boxes()) {}

  std::vector<Candidate> candidates(const std::vector<char>& inside) const {
    std::vector<Candidate> found;
    for (int i = 0; i < static_cast<int>(t_.triangles.size()); ++i) {
      if (inside[i]) add_candidate(i, found);
    }
    std::sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) {
      return std::tie(a.rank, a.triangle) < std::tie(b.rank, b.triangle);
    });
    return found;
  }

 private:
  const Vector2d& corner(int triangle, int i) const {
    return t_.points[t_.triangles[triangle][i % 3]];
  }

  std::vector<BoxTree::Box> boxes() const {
    std::vector<BoxTree::Box> boxes;
    for (const auto& [a, b] : lines_) boxes.push_back(flat_box(t_.points[a], t_.points[b], 0.0));
    return boxes;
  }

  void add_candidate(int triangle, std::vector<Candidate>& found) const {
    const double bad = std::tan(15.0 * one_degree), good = std::tan(11.0 * one_degree);
    int apex = 0;
    double shortest = INFINITY;
    for (int i = 0; i < 3; ++i) {
      const double length = (corner(triangle, i + 2) - corner(triangle, i + 1)).norm();
      if (length < shortest) {
        shortest = length;
        apex = i;
      }
    }
    if (!(shortest >= least_edge * element_size_)) return;
    const Vector2d &p = corner(triangle, apex + 1), &q = corner(triangle, apex + 2),
                   &r = corner(triangle, apex);
    const Vector2d u = p - r, v = q - r;
    if (!(cross(u, v) < bad * u.dot(v))) return;
    const auto& constrained = t_.constrained[triangle];
    if (constrained[(apex + 1) % 3] && constrained[(apex + 2) % 3]) return;
    const Vector2d d = q - p, inwards = Vector2d(-d.y(), d.x()) / shortest;
    const Vector2d at = 0.5 * (p + q) + shortest / (2.0 * good) * inwards;
    if (!is_in_sight(triangle, at) || !is_clear(at, shortest)) return;
    found.push_back({std::round(1e6 * shortest / element_size_), triangle, shortest, at});
  }

  // True if the straight way from the triangle to the point crosses no line.
  bool is_in_sight(int triangle, const Vector2d& at) const {
    constexpr int most_steps = 64;
    for (int step = 0; step < most_steps; ++step) {
      int through = -1;
      for (int i = 0; i < 3 && through < 0; ++i) {
        const Vector2d &a = corner(triangle, i + 1), &b = corner(triangle, i + 2);
        if (cross(b - a, at - a) < 0.0) through = i;
      }
      if (through < 0) return true;
      if (t_.constrained[triangle][through]) return false;
      triangle = t_.neighbor[triangle][through];
      if (triangle < 0) return false;
    }
    return false;
  }

  bool is_clear(const Vector2d& at, double edge) const {
    constexpr double of_edge = 0.5, of_line = 0.3;
    std::vector<int> near;
    // No piece of a line is much longer than an element, which bounds the search.
    tree_.find_overlaps(flat_box(at, at, std::max(of_edge * edge, of_line * element_size_)), near);
    return std::none_of(near.begin(), near.end(), [&](int i) {
      const Vector2d &a = t_.points[lines_[i][0]], &b = t_.points[lines_[i][1]];
      return segment_distance(at, a, b) < std::max(of_edge * edge, of_line * (b - a).norm());
    });
  }

  const PlanarTriangulation& t_;
  const std::vector<std::array<int, 2>>& lines_;
  double element_size_;
  BoxTree tree_;
};

}  // namespace

std::vector<Vector2d> graded_points(const PlanarTriangulation& triangulation,
                                    const std::vector<char>& inside,
                                    const std::vector<std::array<int, 2>>& lines,
                                    double element_size, std::size_t most) {
  const auto candidates = Grading(triangulation, lines, element_size).candidates(inside);
  std::vector<BoxTree::Box> boxes;
  for (const Candidate& c : candidates) boxes.push_back(flat_box(c.at, c.at, 0.0));
  const BoxTree tree(std::move(boxes));
  constexpr double apart = 1.5;  // times the edge's length
  std::vector<char> is_taken(candidates.size(), 0);
  std::vector<Vector2d> points;
  std::vector<int> near;
  for (std::size_t k = 0; k < candidates.size() && points.size() < most; ++k) {
    const Candidate& c = candidates[k];
    const double least = apart * c.edge;
    tree.find_overlaps(flat_box(c.at, c.at, least), near);
    if (std::any_of(near.begin(), near.end(), [&](int i) {
          return is_taken[i] && (candidates[i].at - c.at).norm() < least;
        })) {
      continue;
    }
    is_taken[k] = 1;
    points.push_back(c.at);
  }
  return points;
}

}  // namespace lightwell
