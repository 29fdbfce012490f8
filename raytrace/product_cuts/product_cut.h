#pragma once

#include <vector>

#include "radiosity/many_lights/light_tree.h"
#include "raytrace/product_cuts/gather_tree.h"

namespace lightwell {

/// Irradiance that lights of a node give points of a cluster, without occluders.
struct PairLight {
  double bound = 0.0;  ///< of each point's, W/m^2, mean of the bands; may be infinite
  double about = 0.0;  ///< that of a point in the middle from a light in the middle, W/m^2
};
PairLight pair_light(const LightNode& lights, const GatherNode& points);

/// A node of the product graph (Walter et al. 2006): each light of a node at each point of another.
struct LightPair {
  const LightTree* tree = nullptr;
  int light = 0;   ///< node of the tree of lights
  int gather = 0;  ///< node of the tree of points
  /// Radiance of the pair: points' strength times PairLight, W/(m^2 sr), mean of the bands.
  double bound = 0.0, about = 0.0;
};

/// How fine a product cut is to be.
struct ProductGoal {
  double share = 0.01;  ///< of the radiance, that a pair may give at most
  double light = 0.0;   ///< the radiance that arrives, W/(m^2 sr), sum over all points
  int most = 0;         ///< pairs; more only where points lie within clusters of lights
};

/// The coarsest cut of the product graph that meets a goal: every light and every point are in one
/// pair together, but for pairs that give nothing. `share` of the goal counts of a hundredth of the
/// light without occluders, if that is more than ProductGoal::light.
std::vector<LightPair> product_cut(const std::vector<const LightTree*>& trees,
                                   const GatherTree& points, const ProductGoal& goal);

}  // namespace lightwell
