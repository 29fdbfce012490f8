#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "viewer/export/baked_model.h"

namespace lightwell {

/// A stretch of one side of a surface, laid flat: faces of a BakedModel that hang together by
/// vertices or meet in a blunt crease, so that light does not jump in it. What is curved is cut
/// where it turns away by more than 25 degrees and projected on its mean plane; a sphere is laid
/// out by longitude and latitude.
struct LightmapChart {
  std::vector<int> faces{};                   ///< of the model, ascending
  std::vector<std::array<int, 4>> corners{};  ///< of each face: its own vertices, in its own order
  std::vector<int> vertices{};                ///< of the model; a sphere's seam has them twice
  std::vector<Eigen::Vector2d> place{};  ///< of each vertex, m, counter-clockwise from the lit side
  Eigen::Vector2d size = Eigen::Vector2d::Zero();  ///< m; places are from 0 to it
  /// Of a flat one: p is at ((p - origin).x_axis, (p - origin).y_axis).
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d x_axis = Eigen::Vector3d::UnitX(), y_axis = Eigen::Vector3d::UnitY();
  int sphere = -1;       ///< index into PatchMesh::sphere_grids; -1: it is none
  bool is_dark = false;  ///< no light at any vertex
  /// Of what something else stands on: the chart around it, into whose gap it is laid, so that
  /// nothing dark shows at the foot. -1: none.
  int host = -1;
};

/// Cuts a model into charts, in the order of its parts. Where two edges of a chart, or the sides of
/// a thin wall that stands on it, would be nearer to each other than `gap`, metres, the chart is
/// cut in two: no texel lies on both sides.
std::vector<LightmapChart> cut_charts(const BakedModel& model, const PatchMesh& mesh, double gap);

}  // namespace lightwell
