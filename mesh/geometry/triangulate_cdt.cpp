#include <CDT.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/geometry/box_tree.h"
#include "mesh/geometry/triangulation_backend.h"
#include "scene/errors.h"

namespace lightwell::backend {
namespace {

using Triangulation = CDT::Triangulation<double>;
using Point = CDT::V2d<double>;

// Different points, and constraints between them.
struct Input {
  std::vector<Point> points{};
  std::vector<CDT::Edge> constraints{};
};

double orientation(const Point& a, const Point& b, const Point& c) {
  return predicates::orient2d(a.x, a.y, b.x, b.y, c.x, c.y);
}

BoxTree::Box box_of(const Point& a, const Point& b) {
  BoxTree::Box box(Eigen::Vector3d(a.x, a.y, 0.0));
  box.extend(Eigen::Vector3d(b.x, b.y, 0.0));
  return box;
}

// Splits constraints where they cross, at rounded points. CDT's own way fails where a rounded point
// comes to lie beyond another point or constraint; here the halves may bend, and their crossings
// with others, if there are any, are split in another round.
class CrossingSplitter {
 public:
  explicit CrossingSplitter(Input& input) : input_(input) {
    double largest = 0.0;
    for (const Point& p : input.points) {
      largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
    }
    // A crossing is rounded thrice, and so may be the points that it is to meet.
    snap_ = 8.0 * std::numeric_limits<double>::epsilon() * largest;
  }

  void split() {
    // The second round finds what bends of the first made; the limit only guards against a circle.
    constexpr int most_rounds = 100;
    for (int round = 0; round < most_rounds; ++round) {
      if (!split_once()) return;
    }
    throw InputError(
        "a facet could not be triangulated: its lines cross within rounding errors of each other; "
        "move these lines apart or join them");
  }

 private:
  const Point& at(CDT::VertInd v) const { return input_.points[v]; }

  bool do_cross(const CDT::Edge& one, const CDT::Edge& other) const {
    const Point &a = at(one.v1()), &b = at(one.v2()), &c = at(other.v1()), &d = at(other.v2());
    const auto are_apart = [](double left, double right) {
      return (left > 0.0 && right < 0.0) || (left < 0.0 && right > 0.0);
    };
    return are_apart(orientation(a, b, c), orientation(a, b, d)) &&
           are_apart(orientation(c, d, a), orientation(c, d, b));
  }

  // Cuts `other` at the ends of `one` that lie on it within rounding, and returns whether there are
  // any. Constraints that overlap along a line in any direction are then equal from end to end.
  bool cut_at_ends(const CDT::Edge& one, const CDT::Edge& other,
                   std::vector<CDT::VertInd>& cuts) const {
    const Point &c = at(other.v1()), &d = at(other.v2());
    const double length = CDT::distance(c, d);
    bool has_cut = false;
    for (const CDT::VertInd end : {one.v1(), one.v2()}) {
      const Point& p = at(end);
      const double along = (p.x - c.x) * (d.x - c.x) + (p.y - c.y) * (d.y - c.y);
      if (along <= 0.0 || along >= length * length) continue;
      if (std::abs(orientation(c, d, p)) > snap_ * length) continue;
      cuts.push_back(end);
      has_cut = true;
    }
    return has_cut;
  }

  // Number of the point where two constraints cross: a known one within rounding, if there is any,
  // so that many constraints through one place meet in one point.
  CDT::VertInd crossing(const CDT::Edge& one, const CDT::Edge& other) {
    const Point p = CDT::detail::intersectionPosition(at(one.v1()), at(one.v2()), at(other.v1()),
                                                      at(other.v2()));
    const auto is_near = [&](const Point& q) {
      return std::abs(p.x - q.x) <= snap_ && std::abs(p.y - q.y) <= snap_;
    };
    const auto found = std::find_if(input_.points.begin(), input_.points.end(), is_near);
    const auto number = static_cast<CDT::VertInd>(found - input_.points.begin());
    if (found == input_.points.end()) input_.points.push_back(p);
    return number;
  }

  // Returns false if no two constraints cross.
  bool split_once() {
    const std::vector<CDT::Edge> edges = input_.constraints;
    std::vector<BoxTree::Box> boxes;
    for (const CDT::Edge& edge : edges) boxes.push_back(box_of(at(edge.v1()), at(edge.v2())));
    const BoxTree tree(boxes);
    std::vector<std::vector<CDT::VertInd>> cuts(edges.size());
    std::vector<int> near;
    bool has_found = false;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      tree.find_overlaps(boxes[i], near);
      for (const int other : near) {
        const auto j = static_cast<std::size_t>(other);
        if (j <= i || !do_cross(edges[i], edges[j])) continue;
        has_found = true;
        const bool has_ends = cut_at_ends(edges[i], edges[j], cuts[j]);
        if (cut_at_ends(edges[j], edges[i], cuts[i]) || has_ends) continue;
        const CDT::VertInd point = crossing(edges[i], edges[j]);
        cuts[i].push_back(point);
        cuts[j].push_back(point);
      }
    }
    input_.constraints.clear();
    for (std::size_t i = 0; i < edges.size(); ++i) add_pieces(edges[i], std::move(cuts[i]));
    return has_found;
  }

  void add_pieces(const CDT::Edge& edge, std::vector<CDT::VertInd> cuts) {
    const Point from = at(edge.v1()), to = at(edge.v2());
    const auto along = [&](CDT::VertInd v) {
      return (at(v).x - from.x) * (to.x - from.x) + (at(v).y - from.y) * (to.y - from.y);
    };
    std::ranges::sort(cuts, {}, [&](CDT::VertInd v) { return std::pair(along(v), v); });
    cuts.push_back(edge.v2());
    CDT::VertInd last = edge.v1();
    for (const CDT::VertInd next : cuts) {
      if (next != last) input_.constraints.emplace_back(last, next);
      last = next;
    }
  }

  Input& input_;
  double snap_ = 0.0;
};

Triangulation triangulation_of(const Input& input) {
  Triangulation triangulation(CDT::VertexInsertionOrder::Auto,
                              CDT::IntersectingConstraintEdges::NotAllowed, 0.0);
  triangulation.insertVertices(input.points);
  triangulation.insertEdges(input.constraints);
  triangulation.eraseSuperTriangle();
  return triangulation;
}

// Adds points to the input where constraints cross.
Triangulation crossing_triangulation_of(Input& input) {
  try {
    return triangulation_of(input);
  } catch (const CDT::IntersectingConstraintsError&) {
    CrossingSplitter(input).split();
    return triangulation_of(input);
  }
}

// Numbers of the first among equal points, in the order of the different ones.
std::vector<int> first_numbers(const CDT::DuplicatesInfo& equal, std::size_t different) {
  std::vector<int> numbers(different, -1);
  for (std::size_t i = 0; i < equal.mapping.size(); ++i) {
    int& first = numbers[equal.mapping[i]];
    if (first < 0) first = static_cast<int>(i);
  }
  return numbers;
}

void add_triangle(PlanarTriangulation& result, const Triangulation& found,
                  const CDT::Triangle& face, const std::vector<int>& number) {
  auto& triangle = result.triangles.emplace_back();
  auto& neighbor = result.neighbor.emplace_back();
  auto& constrained = result.constrained.emplace_back();
  for (std::size_t i = 0; i < 3; ++i) {
    // CDT's neighbour i lies across the edge from corner i to corner i + 1.
    const std::size_t next = (i + 1) % 3, last = (i + 2) % 3;
    triangle[i] = number[face.vertices[i]];
    const CDT::TriInd across = face.neighbors[next];
    neighbor[i] = across == CDT::noNeighbor ? -1 : static_cast<int>(across);
    constrained[i] = found.fixedEdges.contains(CDT::Edge(face.vertices[next], face.vertices[last]));
  }
}

}  // namespace

PlanarTriangulation delaunay(const std::vector<Eigen::Vector2d>& points,
                             const std::vector<std::array<int, 2>>& constraints) {
  PlanarTriangulation result{.points = points};
  if (points.empty()) return result;
  Input input;
  for (const Eigen::Vector2d& p : points) input.points.emplace_back(p.x(), p.y());
  const CDT::DuplicatesInfo equal = CDT::RemoveDuplicates(input.points);
  std::vector<int> number = first_numbers(equal, input.points.size());
  for (const auto& [a, b] : constraints) {
    const auto from = static_cast<CDT::VertInd>(equal.mapping[static_cast<std::size_t>(a)]),
               to = static_cast<CDT::VertInd>(equal.mapping[static_cast<std::size_t>(b)]);
    if (from != to) input.constraints.emplace_back(from, to);
  }
  const Triangulation found = crossing_triangulation_of(input);
  for (std::size_t v = number.size(); v < found.vertices.size(); ++v) {
    number.push_back(static_cast<int>(result.points.size()));
    result.points.emplace_back(found.vertices[v].x, found.vertices[v].y);
  }
  result.is_as_given = equal.duplicates.empty() && result.points.size() == points.size();
  for (const CDT::Triangle& face : found.triangles) add_triangle(result, found, face, number);
  return result;
}

int side_of_circle(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                   const Eigen::Vector2d& d) {
  const double side = predicates::incircle(a.x(), a.y(), b.x(), b.y(), c.x(), c.y(), d.x(), d.y());
  return side > 0.0 ? 1 : side < 0.0 ? -1 : 0;
}

}  // namespace lightwell::backend
