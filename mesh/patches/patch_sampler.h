#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "mesh/patches/element_grid.h"
#include "scene/rays/ray_caster.h"

namespace lightwell {

/// Draws points of one patch, uniformly over its area. Keeps a reference to the mesh.
class PatchSampler {
 public:
  PatchSampler(const PatchMesh& mesh, int patch);
  /// A sampler of one element of the patch alone.
  PatchSampler(const PatchMesh& mesh, int patch, int element);

  /// True if the normal is the same everywhere.
  bool is_flat() const { return is_flat_; }

  /// A point uniform over the patch's area for (u, v) uniform in [0,1)^2; u also picks the element,
  /// in proportion to area. On a round shape the point lies on the exact shape. The point is linear
  /// in u and v where the patch is a parallelogram, so that stratified samples stay stratified. A
  /// point in a hole of the surface is replaced by others that (u, v) determine, at most 64 times.
  PatchPoint point(double u, double v) const {
    return has_holes_ ? point_beside_holes(u, v) : any_point(u, v);
  }
  /// The position of point(u, v) alone, metres, for callers that draw very many.
  Eigen::Vector3d position(double u, double v) const {
    if (has_holes_) return point_beside_holes(u, v).position;
    return grid_ ? position_on_grid(u, v) : point_on_part(u, v).position;
  }

 private:
  // A triangle of an element; an element of a round shape whole.
  struct Part {
    int element = -1;
    double area_up_to = 0.0;  // of this part and all parts before, m^2
    Eigen::Vector3d corner = Eigen::Vector3d::Zero();
    Eigen::Vector3d first_edge = Eigen::Vector3d::Zero(), second_edge = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  };
  void add_parts(int first_element, int end_element);
  PatchPoint any_point(double u, double v) const {
    return grid_ ? point_on_grid(u, v) : point_on_part(u, v);
  }
  PatchPoint point_beside_holes(double u, double v) const;
  PatchPoint point_on_part(double u, double v) const;
  Eigen::Vector3d position_on_grid(double u, double v) const {
    return corner_ + u * along_row_ + v * across_;
  }
  PatchPoint point_on_grid(double u, double v) const {
    const int column = std::min(static_cast<int>(u * grid_->columns), grid_->columns - 1);
    const int row = std::min(static_cast<int>(v * grid_->rows), grid_->rows - 1);
    return {.element = grid_->element[static_cast<std::size_t>(row * grid_->columns + column)],
            .position = position_on_grid(u, v),
            .normal = normal_};
  }

  const PatchMesh& mesh_;
  int patch_;
  const RoundGrid* round_;
  bool is_flat_;
  bool has_holes_ = false;
  Eigen::Vector3d normal_ = Eigen::Vector3d::Zero();  // of a flat patch
  std::optional<ElementGrid> grid_;
  // The grid's corner and edges, shrunk a little.
  Eigen::Vector3d corner_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d along_row_ = Eigen::Vector3d::Zero(), across_ = Eigen::Vector3d::Zero();
  double area_ = 0.0;
  std::vector<Part> parts_;  // empty where there is a grid
};

/// A ray from a point of the mesh with a direction about its normal of density cos / pi, for (u, v)
/// uniform in [0,1)^2.
Ray cosine_ray(const PatchMesh& mesh, const PatchPoint& from, float u, float v);

}  // namespace lightwell
