#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "mesh/patches/element_grid.h"
#include "scene/rays/ray_caster.h"

namespace lightwell {

/// Draws points of one patch. Keeps a reference to the mesh.
class PatchSampler {
 public:
  PatchSampler(const PatchMesh& mesh, int patch);
  /// Of one of its elements alone.
  PatchSampler(const PatchMesh& mesh, int patch, int element);

  /// Whether the normal is the same everywhere.
  bool is_flat() const { return is_flat_; }

  /// Uniform over the patch's area for (u, v) uniform in [0,1)^2 (u also picks the element, in
  /// proportion to area); on a sphere the point lies on the exact sphere. Linear in u and v where
  /// the patch is a parallelogram, so that what is stratified stays so.
  /// Never in a hole of the surface: another place that (u, v) decides is taken instead.
  PatchPoint point(double u, double v) const {
    return has_holes_ ? point_beside_holes(u, v) : any_point(u, v);
  }
  /// Its position alone, for who draws very many.
  Eigen::Vector3d position(double u, double v) const {
    if (has_holes_) return point_beside_holes(u, v).position;
    return grid_ ? position_on_grid(u, v) : point_on_part(u, v).position;
  }

 private:
  // A triangle of an element; an element of a sphere whole.
  struct Part {
    int element = -1;
    double area_up_to = 0.0;  // of this and all parts before
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
  const SphereGrid* sphere_;
  bool is_flat_;
  bool has_holes_ = false;
  Eigen::Vector3d normal_ = Eigen::Vector3d::Zero();  // of a flat patch
  std::optional<ElementGrid> grid_;
  // Of the grid, a little inside.
  Eigen::Vector3d corner_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d along_row_ = Eigen::Vector3d::Zero(), across_ = Eigen::Vector3d::Zero();
  double area_ = 0.0;
  std::vector<Part> parts_;  // empty where there is a grid
};

/// A ray from a point of the mesh, about its normal with the density cos / pi for (u, v) uniform in
/// [0,1)^2.
Ray cosine_ray(const PatchMesh& mesh, const PatchPoint& from, float u, float v);

}  // namespace lightwell
