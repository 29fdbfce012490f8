#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "mesh/geometry/welded_points.h"
#include "scene/scene.h"

namespace lightwell {

/// A facet of the scene with a 2-D frame in the facet's plane. Corners are welded points. The
/// frame's axes follow as much of the boundary as possible, so a rectangle is parallel to the axes.
struct FacetPlane {
  int facet = 0;  ///< scene-wide number
  int surface = 0;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis_x = Eigen::Vector3d::UnitX();
  Eigen::Vector3d axis_y = Eigen::Vector3d::UnitY();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, towards the front
  Eigen::AlignedBox3d box{};
  double weld_tolerance = 0.0;  ///< largest displacement of a corner by welding, metres

  // Corners, one loop after another: the boundary, then the holes.
  std::vector<int> loop_begin{0};  ///< loop l is [loop_begin[l], loop_begin[l + 1])
  std::vector<int> point{};        ///< per corner, index into the WeldedPoints
  std::vector<Eigen::Vector3d> corner{};
  std::vector<Eigen::Vector2d> xy{};  ///< corners in the frame

  Eigen::Vector2d project(const Eigen::Vector3d& p) const {
    return {axis_x.dot(p - origin), axis_y.dot(p - origin)};
  }
  Eigen::Vector3d lift(const Eigen::Vector2d& q) const {
    return origin + q.x() * axis_x + q.y() * axis_y;
  }
  double height(const Eigen::Vector3d& p) const { return normal.dot(p - origin); }
  int corner_count() const { return static_cast<int>(point.size()); }
  int loop_count() const { return static_cast<int>(loop_begin.size()) - 1; }
  bool is_triangle() const { return corner_count() == 3; }

  /// Calls visit(i, j) for every boundary edge from corner i to corner j.
  template <class Visit>
  void for_each_edge(Visit&& visit) const {
    for (int l = 0; l < loop_count(); ++l) {
      for (int i = loop_begin[l]; i < loop_begin[l + 1]; ++i) {
        visit(i, i + 1 < loop_begin[l + 1] ? i + 1 : loop_begin[l]);
      }
    }
  }

  /// Area in the frame, m^2.
  double area() const;
  /// Length of the boundary and of all holes, metres.
  double boundary_length() const;
  /// True if q lies inside the polygon or within `tolerance` (metres) of the boundary.
  bool contains(const Eigen::Vector2d& q, double tolerance) const;
  /// True if the boundary winds round q, in whatever direction and however often, and no hole does:
  /// contains() without tolerance, but for loops that cross, overlap or repeat themselves.
  bool winds_round(const Eigen::Vector2d& q) const;
};

/// Distance of q from the segment a-b, in the units of the arguments.
double segment_distance(const Eigen::Vector2d& q, const Eigen::Vector2d& a,
                        const Eigen::Vector2d& b);

/// The welding radius of each vertex, metres: `tolerance`, but at most 1e-3 of the shortest edge at
/// the vertex and 0.1 of the thickness (2 area / boundary length) of each facet at the vertex. So
/// welding joins neither the two ends of an edge nor the two sides of a needle.
std::vector<double> weld_radii(const PolygonMesh& mesh, double tolerance);

/// Returns the planes of all polygon facets of the scene, in scene-wide order (round shapes have
/// none), and adds the facets' corners to `points`.
std::vector<FacetPlane> facet_planes(const Scene& scene, WeldedPoints& points);

}  // namespace lightwell
