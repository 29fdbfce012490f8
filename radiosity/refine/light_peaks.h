#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/elements/refine_elements.h"
#include "mesh/geometry/box_tree.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/many_lights/light_tree.h"

namespace lightwell {

/// A place of a cell where a light peaks.
struct LightPeak {
  Eigen::Vector4d weights = Eigen::Vector4d::Zero();  ///< of the cell's corners; three in triangles
  double light =
      0.0;  ///< irradiance of the light there without occluders, W/m^2, mean of the bands
  double share = 0.0;  ///< of the cell, for the mean square of the peak
};

/// Lights near a surface, which peak between the vertices of large cells: a lamp at a distance d
/// from a plane gives (1 + r^2 / d^2)^(-3/2) of its greatest irradiance at a distance r from the
/// foot of its perpendicular.
class LightPeaks {
 public:
  /// Keeps a reference to `direct_light`.
  explicit LightPeaks(const DirectLight& direct_light);

  /// The strongest peaks of a cell that its corners, middles of edges and centre may all miss, in
  /// order of falling light: those of lights nearer than half of the cell's longest side. `normal`
  /// and `facet` are those of the side.
  std::vector<LightPeak> of_cell(const RefinedElements& elements, int cell, int side,
                                 const Eigen::Vector3d& normal, int facet) const;

 private:
  double clearance_of(int light) const;
  double unoccluded(int light, const SurfacePoint& at) const;

  const DirectLight& direct_light_;
  std::vector<LightBound> bounds_;
  BoxTree tree_;
};

}  // namespace lightwell
