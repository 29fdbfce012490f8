#include "radiosity/emitters/emission_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>

#include "radiosity/visibility/convex_polygon.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

// More leaves than a photograph needs to light a wall a tenth of its width away to 1 %.
constexpr int most_leaves = 512;

// Sums over cells left of and above each corner of the grid: area, M in three bands, and the square
// of M with bands added.
class CellSums {
 public:
  explicit CellSums(const PictureCells& cells, const Eigen::Array3f& factor)
      : stride_(cells.columns + 1),
        sums_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(cells.rows + 1),
              Sum::Zero()) {
    for (int row = 0; row < cells.rows; ++row) {
      Sum along = Sum::Zero();
      for (int column = 0; column < cells.columns; ++column) {
        const std::size_t i = cells.index(column, row);
        const Eigen::Array3d M = (factor * cells.value[i]).cast<double>();
        Sum of_cell;
        of_cell << 1.0, M, M.square().sum();
        along += cells.area[i] * of_cell;
        at(column + 1, row + 1) = at(column + 1, row) + along;
      }
    }
  }

  using Sum = Eigen::Array<double, 5, 1>;
  Sum within(int first, int end, int top, int bottom) const {
    return at(end, bottom) - at(first, bottom) - at(end, top) + at(first, top);
  }
  // Sum of squared deviations from the mean.
  static double deviation(const Sum& sum) {
    if (!(sum[0] > 0.0)) return 0.0;
    return std::max(0.0, sum[4] - sum.segment<3>(1).square().sum() / sum[0]);
  }

 private:
  Sum& at(int column, int row) { return sums_[static_cast<std::size_t>(row * stride_ + column)]; }
  const Sum& at(int column, int row) const {
    return sums_[static_cast<std::size_t>(row * stride_ + column)];
  }

  int stride_;
  std::vector<Sum> sums_;
};

std::vector<ConvexPolygon> parts_before(const std::vector<ConvexPolygon>& polygons,
                                        const HalfSpace& side) {
  std::vector<ConvexPolygon> inside;
  for (ConvexPolygon polygon : polygons) {
    if (clip(polygon, side)) inside.push_back(polygon);
  }
  return inside;
}

// Form factor from a point to a polygon that lies all above the point's horizon: the integral of
// cos cos / (pi r^2) over a fan of triangles, each by the middles of its edges.
double by_edge_middles(const SurfacePoint& at, const Loop& polygon) {
  double F = 0.0;
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    const Vector3d a = polygon[0] - at.position, b = polygon[k - 1] - at.position,
                   c = polygon[k] - at.position;
    const Vector3d doubled = (b - a).cross(c - a);  // twice the area, along the normal
    for (const Vector3d& r :
         {Vector3d(0.5 * (a + b)), Vector3d(0.5 * (b + c)), Vector3d(0.5 * (c + a))}) {
      const double r2 = r.squaredNorm();
      F += r.dot(at.normal) * std::abs(r.dot(doubled)) / (r2 * r2);
    }
  }
  return F / (6.0 * std::numbers::pi);
}

}  // namespace

// Parts the leaf with the largest sum of squared deviations, until no leaf deviates.
class EmissionTree::Builder {
 public:
  Builder(EmissionTree& tree, const PictureCells& cells)
      : tree_(tree), sums_(cells, tree.texture_.factor.head<3>()) {}

  void build(std::vector<ConvexPolygon> polygons, int columns, int rows) {
    add({.end = columns, .bottom = rows}, std::move(polygons));
    constexpr double even = 1e-3;  // deviation, as a share of the mean
    const Eigen::Array3d mean = tree_.mean().cast<double>();
    const double least = even * even * mean.square().sum() * tree_.nodes_.front().area;
    for (int leaves = 1; leaves < most_leaves && !queue_.empty(); ++leaves) {
      const auto [deviation, node] = queue_.top();
      if (!(deviation > least / most_leaves)) break;
      queue_.pop();
      part(node);
    }
  }

 private:
  struct Cut {
    int axis = 0, at = 0;
    double deviation = 0.0;  // of both parts
  };

  Cut best_cut(const Node& n) const {
    Cut best{.deviation = std::numeric_limits<double>::infinity()};
    double best_distance = 0.0;
    const auto consider = [&](int axis, int at, double deviation) {
      const double middle = axis == 0 ? 0.5 * (n.first + n.end) : 0.5 * (n.top + n.bottom);
      // Ties between equally good cuts go to the one nearest to the middle.
      const double distance =
          std::abs(at - middle) / (axis == 0 ? n.end - n.first : n.bottom - n.top);
      constexpr double equal = 1e-9;
      const bool is_better = deviation < best.deviation * (1.0 - equal);
      if (!is_better && (deviation > best.deviation * (1.0 + equal) || distance >= best_distance)) {
        return;
      }
      best = {axis, at, deviation};
      best_distance = distance;
    };
    for (int i = n.first + 1; i < n.end; ++i) {
      consider(0, i,
               CellSums::deviation(sums_.within(n.first, i, n.top, n.bottom)) +
                   CellSums::deviation(sums_.within(i, n.end, n.top, n.bottom)));
    }
    for (int j = n.top + 1; j < n.bottom; ++j) {
      consider(1, j,
               CellSums::deviation(sums_.within(n.first, n.end, n.top, j)) +
                   CellSums::deviation(sums_.within(n.first, n.end, j, n.bottom)));
    }
    return best;
  }

  void part(int number) {
    const Node whole = tree_.nodes_[static_cast<std::size_t>(number)];
    const Cut cut = best_cut(whole);
    const auto row = tree_.place_.row(cut.axis);
    const HalfSpace beyond{row.head<3>().transpose(), cut.at - row[3]};
    Node low = whole, high = whole;
    (cut.axis == 0 ? low.end : low.bottom) = cut.at;
    (cut.axis == 0 ? high.first : high.top) = cut.at;
    const auto first = polygons_[static_cast<std::size_t>(number)];
    tree_.nodes_[static_cast<std::size_t>(number)].child = static_cast<int>(tree_.nodes_.size());
    add(low, parts_before(first, beyond.opposite()));
    add(high, parts_before(first, beyond));
    polygons_[static_cast<std::size_t>(number)] = {};
  }

  void add(Node node, std::vector<ConvexPolygon> polygons) {
    const CellSums::Sum sum = sums_.within(node.first, node.end, node.top, node.bottom);
    const double deviation = CellSums::deviation(sum);
    node.child = -1;
    node.area = 0.0;
    node.center.setZero();
    node.first_polygon = static_cast<int>(tree_.polygons_.size());
    Eigen::AlignedBox3d box;
    for (const ConvexPolygon& polygon : polygons) {
      node.area += polygon.area();
      for (const Vector3d& corner : polygon.corners()) box.extend(corner);
      tree_.polygons_.emplace_back(polygon.corners().begin(), polygon.corners().end());
    }
    node.end_polygon = static_cast<int>(tree_.polygons_.size());
    if (!polygons.empty()) {
      node.center = box.center();
      node.radius = 0.5 * box.diagonal().norm();
    }
    if (sum[0] > 0.0) {
      node.mean = (sum.segment<3>(1) / sum[0]).cast<float>();
      // The root of a sum over bands exceeds no sum of the bands' deviations by more than sqrt(3).
      node.spread = static_cast<float>(std::sqrt(3.0 * deviation / sum[0]));
    }
    const bool has_cut = node.end - node.first > 1 || node.bottom - node.top > 1;
    if (has_cut && !polygons.empty()) {
      queue_.emplace(deviation, static_cast<int>(tree_.nodes_.size()));
    }
    tree_.nodes_.push_back(node);
    polygons_.push_back(std::move(polygons));
  }

  EmissionTree& tree_;
  CellSums sums_;
  std::vector<std::vector<ConvexPolygon>> polygons_{};  // of leaves
  std::priority_queue<std::pair<double, int>> queue_{};
};

EmissionTree::EmissionTree(const EmissionTexture& texture, const UvMap& uv,
                           const PictureCells& cells, const std::vector<Loop>& loops,
                           const Vector3d& normal)
    : texture_(texture), uv_(uv), place_(cells.place) {
  std::vector<ConvexPolygon> polygons = convex_pieces(loops, normal);
  if (polygons.empty()) return;
  Builder(*this, cells).build(std::move(polygons), cells.columns, cells.rows);
}

const Eigen::Array3f& EmissionTree::taken_at(const Vector3d& point) const {
  const Eigen::Vector2d place = place_.leftCols<3>() * point + place_.col(3);
  const Node* node = &nodes_.front();
  while (node->child >= 0) {
    const Node& low = nodes_[static_cast<std::size_t>(node->child)];
    const bool is_low = place.x() < low.end && place.y() < low.bottom;
    node = is_low ? &low : &low + 1;
  }
  return node->mean;
}

int EmissionTree::leaf_count() const {
  return static_cast<int>(std::ranges::count_if(nodes_, [](auto& n) { return n.child < 0; }));
}

double EmissionTree::form_factor(const Node& node, const SurfacePoint& at) const {
  const Vector3d to_center = node.center - at.position;
  const double distance = to_center.norm();
  // From farther than `far` radii the rule of edge middles, which is exact for quadratic kernels,
  // takes the place of the closed form: off by less than (radius / distance)^4, 1e-4 of F.
  constexpr double far = 10.0;
  const bool is_far = distance > far * node.radius;
  double F = 0.0;
  if (is_far && to_center.dot(at.normal) > node.radius) {
    for (int i = node.first_polygon; i < node.end_polygon; ++i) {
      F += by_edge_middles(at, polygons_[static_cast<std::size_t>(i)]);
    }
    return F;
  }
  for (int i = node.first_polygon; i < node.end_polygon; ++i) {
    const Loop& polygon = polygons_[static_cast<std::size_t>(i)];
    F += std::abs(point_to_polygon(at.position, at.normal, polygon));
  }
  return F;
}

EmissionTree::View EmissionTree::view(const SurfacePoint& at, double form_factor_of_all) const {
  // Light that the parting of a rectangle may move within the view, as a share of all light. The
  // bound is that of a picture and a kernel that vary together, so that errors of many rectangles
  // add up to less.
  constexpr double least = 6e-3;
  const double most = least * static_cast<double>(mean().sum()) * form_factor_of_all;
  View view;
  double sum = 0.0;
  struct Seen {
    int node;
    double F;
  };
  std::vector<Seen> waiting = {{0, form_factor_of_all}};
  while (!waiting.empty()) {
    const auto [number, F] = waiting.back();
    waiting.pop_back();
    const Node& node = nodes_[static_cast<std::size_t>(number)];
    const double distance = (node.center - at.position).norm();
    const double slope = std::min(1.0, 2.0 * node.radius / std::max(distance, 1e-300));
    if (node.child >= 0 && static_cast<double>(node.spread) * F * slope > most) {
      // The parts of a rectangle send what the rectangle sends.
      const double of_low =
          std::min(F, form_factor(nodes_[static_cast<std::size_t>(node.child)], at));
      if (F - of_low > 0.0) waiting.push_back({node.child + 1, F - of_low});
      if (of_low > 0.0) waiting.push_back({node.child, of_low});
      continue;
    }
    view.light += F * node.mean.cast<double>();
    const double light = F * static_cast<double>(node.mean.sum());
    if (!(light > 0.0)) continue;
    sum += light;
    view.parts.push_back({.node = number, .up_to = sum});
  }
  for (Part& part : view.parts) part.up_to /= sum;
  return view;
}

EmissionTree::Sample EmissionTree::sample(const View& view, double u, double v) const {
  const auto found = std::upper_bound(view.parts.begin(), view.parts.end() - 1, u,
                                      [](double x, const Part& part) { return x < part.up_to; });
  const double before = found == view.parts.begin() ? 0.0 : (found - 1)->up_to;
  const double share = found->up_to - before;
  const Node& node = nodes_[static_cast<std::size_t>(found->node)];
  double along = std::clamp((u - before) / share, 0.0, 1.0) * node.area;
  Sample sample{.area_per_share = node.area / share, .exitance = &node.mean};
  for (int i = node.first_polygon; i < node.end_polygon; ++i) {
    const Loop& polygon = polygons_[static_cast<std::size_t>(i)];
    for (std::size_t k = 2; k < polygon.size(); ++k) {
      const Vector3d a = polygon[k - 1] - polygon[0], b = polygon[k] - polygon[0];
      const double area = 0.5 * a.cross(b).norm();
      const bool is_last = i + 1 == node.end_polygon && k + 1 == polygon.size();
      if (along >= area && !is_last) {
        along -= area;
        continue;
      }
      const double within = area > 0.0 ? std::clamp(along / area, 0.0, 1.0) : 0.0;
      const Vector3d w = triangle_point(static_cast<float>(within), static_cast<float>(v));
      sample.point = polygon[0] + w[1] * a + w[2] * b;
      return sample;
    }
  }
  return sample;
}

}  // namespace lightwell
