#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <span>
#include <vector>

#include "radiosity/emitters/direct_light.h"
#include "scene/surface_point.h"

namespace lightwell {

/// Greatest radiant intensity of lights by the angle to the axis of each, W/sr, in equal steps from
/// 0 to pi.
using IntensityByAngle = std::array<float, 16>;

/// Bounds of a light's place and intensity, for LightTree.
struct LightBound {
  int light = 0;                                    ///< number of the light
  Eigen::AlignedBox3d box{};                        ///< of all points that shine, m
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit
  IntensityByAngle intensity{};                     ///< W/sr, mean of the bands
};

/// The bounds of emitters that are on, numbered from 0.
std::vector<LightBound> bounds_of(std::span<const Emitter> emitters);
/// The bounds of lamps among free sources that are on; the first source has the number `first`.
std::vector<LightBound> bounds_of(std::span<const FreeSource> sources, int first);

/// Lights clustered by their places: a tree in which a node bounds what all of its lights can give
/// a point (lightcuts; Walter et al. 2005). Where many lights shine, a point takes the light of
/// distant clusters from a few of their members, drawn at random.
class LightTree {
 public:
  /// Precondition: `lights` is not empty.
  explicit LightTree(std::vector<LightBound> lights);

  /// A node as a point sees it, without occluders.
  struct Seen {
    int node = 0;
    double bound = 0.0;  ///< of the irradiance from all lights of the node, W/m^2; may be infinite
    double about = 0.0;  ///< that irradiance as if all light came from the node's middle, W/m^2
  };
  Seen root(const SurfacePoint& at) const { return seen(0, at); }
  /// The two halves of a node that is_cluster().
  std::array<Seen, 2> halves(int node, const SurfacePoint& at) const;
  bool is_cluster(int node) const { return nodes_[static_cast<std::size_t>(node)].child >= 0; }
  /// The light of a node that is no cluster.
  int light(int node) const { return nodes_[static_cast<std::size_t>(node)].light; }

  /// A light of a node and the chance by which it was drawn.
  struct Draw {
    int light = 0;  ///< -1: one of those that give nothing
    double chance = 1.0;
  };
  /// Draws a light in proportion to about what it may give, for u in [0,1). What the light gives,
  /// over the chance, is hardly more than the node's bound. Precondition: the bound is above 0 and
  /// finite.
  Draw draw(int node, const SurfacePoint& at, double u) const;

 private:
  struct Node {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero(), half = middle;  // of the box
    double radius = 0.0;                                              // of the ball about it
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();                  // of the cone of all axes
    double half_angle = 0.0, cosine = 1.0, sine = 0.0;                // of that cone
    IntensityByAngle intensity{};                                     // sum over lights
    int child = -1;                                                   // of two; -1: one light
    int light = 0;

    Eigen::AlignedBox3d box() const { return {middle - half, middle + half}; }
  };
  // Steps of IntensityByAngle, first to last, into which a point may lie; and that of the middle.
  struct Steps {
    int first = 0, last = 0, middle = 0;
  };
  void fill(int node, std::span<LightBound> lights);
  Seen seen(int node, const SurfacePoint& at) const;
  static Steps steps_to(const Node& node, const Eigen::Vector3d& to, double distance);
  static double greatest(const Node& node, const Steps& steps);

  std::vector<Node> nodes_{};
};

/// A part of a cut: a single light, or a cluster.
struct CutPart {
  const LightTree* tree = nullptr;
  LightTree::Seen seen{};
};

/// The coarsest cut through trees in which no cluster can give more than `share` of `light`, W/m^2,
/// the light that arrives (Walter et al. 2005); `light` 0: of what all parts give about. At most
/// `most` parts, and more only where a point lies within clusters. Parts that give nothing are left
/// out.
std::vector<CutPart> light_cut(std::span<const LightTree* const> trees, const SurfacePoint& at,
                               double share, double light, int most);

}  // namespace lightwell
