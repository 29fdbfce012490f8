#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "radiosity/many_lights/light_tree.h"
#include "raytrace/product_cuts/pixel_point.h"

namespace lightwell {

/// A node of GatherTree: a gather point, or a cluster of gather points.
struct GatherNode {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero(), half = middle;  ///< of the box, m
  double radius = 0.0;                                              ///< of the ball about it, m
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();                  ///< of the cone of all normals
  double cosine = 1.0, sine = 0.0;                                  ///< of that cone's half angle
  double strength = 0.0;  ///< sum of PixelPoint::strength(), 1/sr
  int child = -1;         ///< the first of two; -1: one point
  int point = 0;          ///< the number of the one point
};

/// About what points of a node send on of lights that shine alike in all directions, by cosine and
/// distance of middles, 1/(m^2 sr). It is 0 only if no point gets light.
double share_of_light(const GatherNode& points, const LightNode& lights);

/// The gather points of a pixel, clustered by place and normal (Walter et al. 2006).
class GatherTree {
 public:
  /// `reach`, m: about the distance of the lights. Normals as far apart as a radian count as places
  /// as far apart as that. Precondition: `points` is not empty.
  GatherTree(std::span<const PixelPoint> points, double reach);

  const GatherNode& node(int number) const { return nodes_[static_cast<std::size_t>(number)]; }
  bool is_cluster(int number) const { return node(number).child >= 0; }

  /// A point of a node and the chance by which it was drawn.
  struct Draw {
    int point = 0;  ///< -1: one of those that get nothing
    double chance = 1.0;
  };
  /// Draws a point of a node for u in [0,1), in proportion to share_of_light().
  Draw draw(int number, const LightNode& lights, double u) const;

 private:
  void fill(int number, std::span<int> order, std::span<const PixelPoint> points, double reach);

  std::vector<GatherNode> nodes_{};
};

}  // namespace lightwell
