#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "viewer/export/baked_model.h"

namespace lightwell {

/// Connected faces of one part of a BakedModel, mapped to the plane. The faces share vertices or
/// meet in blunt creases, so that light is continuous in a chart. Curved surfaces are cut where
/// normals differ by more than 25 degrees, and projected on their mean plane. A sphere is mapped by
/// longitude and latitude.
struct LightmapChart {
  std::vector<int> faces{};  ///< of the model, ascending
  /// Corners of each face, indices into `vertices`, in the face's order; [3] is -1 for a triangle.
  std::vector<std::array<int, 4>> corners{};
  std::vector<int> vertices{};  ///< of the model; twice along a sphere's seam
  /// Position of each vertex in the plane, m. Faces are counter-clockwise seen from the lit side.
  std::vector<Eigen::Vector2d> place{};
  Eigen::Vector2d size = Eigen::Vector2d::Zero();  ///< m; `place` is within [0, size]
  /// Projection of a chart that is no sphere: p is at ((p - origin).x_axis, (p - origin).y_axis).
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d x_axis = Eigen::Vector3d::UnitX(), y_axis = Eigen::Vector3d::UnitY();
  int sphere = -1;       ///< index into PatchMesh::round_grids; -1: no sphere
  bool is_dark = false;  ///< no light at any vertex
  /// Chart around the footprint of another body: a covered dark chart lies in its host's gap, so
  /// that no dark texels show at the foot of the body. -1: none.
  int host = -1;
};

/// Cuts a model into charts, in the order of its parts. A chart is cut in two where two of its
/// border edges, for example along a thin wall's foot, are nearer to each other than `gap`, metres
/// (see narrow_gaps): no texel lies on both sides.
std::vector<LightmapChart> cut_charts(const BakedModel& model, const PatchMesh& mesh, double gap);

}  // namespace lightwell
