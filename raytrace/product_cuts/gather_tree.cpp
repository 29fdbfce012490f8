#include "raytrace/product_cuts/gather_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "radiosity/many_lights/drawn_half.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;
using Box3d = Eigen::AlignedBox3d;

// A cluster without its halves.
GatherNode node_about(std::span<const int> order, std::span<const PixelPoint> points) {
  GatherNode node;
  Box3d box;
  Vector3d normals = Vector3d::Zero();
  for (const int i : order) {
    const PixelPoint& point = points[static_cast<std::size_t>(i)];
    box.extend(point.at.position);
    normals += point.at.normal;
    node.strength += point.strength();
  }
  node.middle = box.center();
  node.half = 0.5 * box.sizes();
  node.radius = node.half.norm();
  if (order.size() == 1) {
    node.axis = points[static_cast<std::size_t>(order.front())].at.normal;
    return node;
  }
  node.axis = normals.norm() > 0.0 ? Vector3d(normals.normalized()) : points[0].at.normal;
  for (const int i : order) {
    const double cosine = node.axis.dot(points[static_cast<std::size_t>(i)].at.normal);
    node.cosine = std::min(node.cosine, cosine);
  }
  node.sine = std::sqrt(std::max(0.0, 1.0 - node.cosine * node.cosine));
  return node;
}

// The order of points along the longest side of the box about their places and normals.
void halve(std::span<int> order, std::span<const PixelPoint> points, double reach) {
  Box3d places, normals;
  for (const int i : order) {
    places.extend(points[static_cast<std::size_t>(i)].at.position);
    normals.extend(points[static_cast<std::size_t>(i)].at.normal);
  }
  Eigen::Index of_place = 0, of_normal = 0;
  const double wide = places.sizes().maxCoeff(&of_place);
  const bool by_normal = reach * normals.sizes().maxCoeff(&of_normal) > wide;
  const auto along = [&](int i) {
    const SurfacePoint& at = points[static_cast<std::size_t>(i)].at;
    return by_normal ? at.normal[of_normal] : at.position[of_place];
  };
  std::ranges::nth_element(order, order.begin() + static_cast<std::ptrdiff_t>(order.size() / 2),
                           [&](int a, int b) {
                             const double x = along(a), y = along(b);
                             return x != y ? x < y : a < b;
                           });
}

}  // namespace

// Normals of the cone are higher than its axis by the sine of the half angle.
double share_of_light(const GatherNode& points, const LightNode& lights) {
  const Vector3d to = lights.middle - points.middle;
  const double distance = to.norm(), radius = points.radius + lights.radius;
  const double along =
      to.dot(points.axis) + (points.half + lights.half).dot(points.axis.cwiseAbs());
  const double lean = points.cosine > 0.0 ? points.sine : 1.0;
  const double height =
      (along > 0.0 ? along : along * std::max(0.0, points.cosine)) + lean * (distance + radius);
  if (!(height > 0.0)) return 0.0;
  const double away = std::max(distance, radius);
  return points.strength * std::min(height, away) / (away * away * away);
}

double PixelPoint::strength() const {
  // ReliefSlope::gain() is 2 at most. A base gets no more than all light over the mean of what
  // passes the coat.
  double most = relief ? 2.0 : 1.0;
  if (base) most /= 1.0 - base->mean_mirrored();
  return most * static_cast<double>(weight.mean());
}

GatherTree::GatherTree(std::span<const PixelPoint> points, double reach) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  nodes_.reserve(2 * points.size());
  nodes_.emplace_back();
  fill(0, order, points, reach);
}

void GatherTree::fill(int number, std::span<int> order, std::span<const PixelPoint> points,
                      double reach) {
  GatherNode filled = node_about(order, points);
  if (order.size() == 1) {
    filled.point = order.front();
  } else {
    halve(order, points, reach);
    filled.child = static_cast<int>(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
    const std::size_t half = order.size() / 2;
    fill(filled.child, order.first(half), points, reach);
    fill(filled.child + 1, order.subspan(half), points, reach);
  }
  nodes_[static_cast<std::size_t>(number)] = filled;
}

GatherTree::Draw GatherTree::draw(int number, const LightNode& lights, double u) const {
  Draw draw;
  while (is_cluster(number)) {
    const int child = node(number).child;
    const DrawnHalf drawn =
        draw_half(share_of_light(node(child), lights), share_of_light(node(child + 1), lights), u);
    if (drawn.half < 0) return {.point = -1};
    draw.chance *= drawn.chance;
    u = drawn.u;
    number = child + drawn.half;
  }
  draw.point = node(number).point;
  return draw;
}

}  // namespace lightwell
