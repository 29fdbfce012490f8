#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <span>
#include <vector>

#include "radiosity/emitters/emitter.h"
#include "radiosity/emitters/free_source.h"
#include "radiosity/many_lights/drawn_half.h"
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
  /// The greatest irradiance that the light can give, W/m^2, mean of the bands.
  double most = std::numeric_limits<double>::infinity();
};

/// The bounds of emitters that are on, numbered from 0.
std::vector<LightBound> bounds_of(std::span<const Emitter> emitters);
/// The bounds of lamps among free sources that are on; the first source has the number `first`.
std::vector<LightBound> bounds_of(std::span<const FreeSource> sources, int first);

/// A node of LightTree: a light, or a cluster of lights.
struct LightNode {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero(), half = middle;  ///< of the box, m
  double radius = 0.0;                                              ///< of the ball about it, m
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();                  ///< of the cone of all axes
  double half_angle = 0.0, cosine = 1.0, sine = 0.0;                ///< of that cone
  IntensityByAngle intensity{};                                     ///< W/sr, sum over lights
  double most = 0.0;  ///< the greatest irradiance of all, W/m^2
  int parent = -1;    ///< -1: this is the root
  int child = -1;     ///< the first of two; -1: one light
  int light = 0;      ///< the number of the one light

  Eigen::AlignedBox3d box() const { return {middle - half, middle + half}; }
};

/// Bound of the intensity that the lights of a node send to a point, W/sr, mean of the bands.
double greatest_intensity(const LightNode& node, const Eigen::Vector3d& point);

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

  /// Draws a light of a node for u in [0,1): the two halves of a cluster have chances in proportion
  /// to `weight` of each, a function of a LightNode that is not negative (Conty Estevez & Kulla
  /// 2018, "Importance sampling of many lights with adaptive tree splitting").
  template <class Weight>
  Draw draw_by(int node, double u, const Weight& weight) const;
  /// The chance by which draw_by() draws a light from the root; 0 for a light that is not here.
  template <class Weight>
  double chance_by(int light, const Weight& weight) const;
  const LightNode& node(int number) const { return nodes_[static_cast<std::size_t>(number)]; }

 private:
  void fill(int node, std::span<LightBound> lights);
  Seen seen(int node, const SurfacePoint& at) const;

  std::vector<LightNode> nodes_{};
  std::vector<int> leaf_of_{};  // node of each light; -1: none
};

template <class Weight>
LightTree::Draw LightTree::draw_by(int node, double u, const Weight& weight) const {
  Draw draw;
  while (is_cluster(node)) {
    const int child = this->node(node).child;
    const DrawnHalf drawn = draw_half(weight(this->node(child)), weight(this->node(child + 1)), u);
    if (drawn.half < 0) return {.light = -1};
    draw.chance *= drawn.chance;
    u = drawn.u;
    node = child + drawn.half;
  }
  draw.light = light(node);
  return draw;
}

template <class Weight>
double LightTree::chance_by(int light, const Weight& weight) const {
  const auto number = static_cast<std::size_t>(light);
  if (light < 0 || number >= leaf_of_.size() || leaf_of_[number] < 0) return 0.0;
  double chance = 1.0;
  int child = leaf_of_[number];
  while (node(child).parent >= 0) {
    const int parent = node(child).parent, first = node(parent).child;
    const double of_first = weight(node(first)), of_second = weight(node(first + 1));
    if (!(of_first + of_second > 0.0)) return 0.0;
    const double share = of_first / (of_first + of_second);
    chance *= child == first ? share : 1.0 - share;
    child = parent;
  }
  return chance;
}

/// A part of a cut: a single light, or a cluster.
struct CutPart {
  const LightTree* tree = nullptr;
  LightTree::Seen seen{};
};

/// The coarsest cut of all: the roots of trees that give a point light.
std::vector<CutPart> roots(const std::vector<const LightTree*>& trees, const SurfacePoint& at);

/// How fine a cut is to be.
struct CutGoal {
  double share = 0.01;  ///< of the light, that a cluster may give at most
  double light = 0.0;   ///< that arrives, W/m^2; 0: what all parts give about
  int most = 0;         ///< parts; more only where a point lies within clusters
};

/// The coarsest cut below the parts of a cut that meets a goal (Walter et al. 2005). Parts that
/// give nothing are left out.
std::vector<CutPart> light_cut(std::vector<CutPart> parts, const SurfacePoint& at,
                               const CutGoal& goal);

}  // namespace lightwell
