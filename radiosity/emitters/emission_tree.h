#pragma once

#include <Eigen/Core>
#include <vector>

#include "radiosity/closed_forms/polygon_form_factor.h"
#include "scene/picture_cells.h"
#include "scene/scene.h"
#include "scene/surface_point.h"

namespace lightwell {

/// A facet that shines by a picture, cut into rectangles of the picture's coordinates: a tree in
/// which each rectangle is parted where its picture changes most. Direct light at a point is the
/// sum of closed forms of rectangles, large ones from afar and small ones from near.
class EmissionTree {
 public:
  /// `loops`: boundary and holes of the facet, counter-clockwise about `normal`. `most_across`:
  /// cells of the picture in each direction. Empty if the loops cross each other.
  EmissionTree(const EmissionTexture& texture, const UvMap& uv, const PictureCells& cells,
               const std::vector<Loop>& loops, const Eigen::Vector3d& normal);

  bool is_empty() const { return nodes_.empty(); }
  /// Mean exitance, W/m^2, before relight() scales it.
  const Eigen::Array3f& mean() const { return nodes_.front().mean; }
  /// Exitance of the picture at a point of the facet.
  Eigen::Array3f at(const Eigen::Vector3d& point) const {
    return texture_.factor.head<3>() * texture_.image.at(uv_.at(point));
  }
  /// The exitance that closed forms take for a point of the facet. Valid as long as the tree.
  const Eigen::Array3f& taken_at(const Eigen::Vector3d& point) const;
  int leaf_count() const;

  /// A rectangle that sends light to a point, and the running share of the light.
  struct Part {
    int node = 0;
    double up_to = 0.0;
  };
  /// The facet as a point sees it, without occluders.
  struct View {
    Eigen::Array3d light = Eigen::Array3d::Zero();  ///< sum of M F, W/m^2
    std::vector<Part> parts{};                      ///< by their light; empty without any
  };
  /// `form_factor`: that of the whole facet, above 0.
  View view(const SurfacePoint& at, double form_factor) const;

  /// A sample point of a part of a view.
  struct Sample {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    double area_per_share = 0.0;               ///< 1 over the density in area, m^2
    const Eigen::Array3f* exitance = nullptr;  ///< as taken_at()
  };
  /// `u` and `v` lie in [0,1). Precondition: the view has parts.
  Sample sample(const View& view, double u, double v) const;

 private:
  struct Node {
    int first = 0, end = 0;   // columns of cells
    int top = 0, bottom = 0;  // rows
    int child = -1;           // of two; -1: a leaf
    int first_polygon = 0, end_polygon = 0;
    Eigen::Array3f mean = Eigen::Array3f::Zero();
    float spread = 0.0f;  // root mean square deviation from the mean, bands added
    double area = 0.0, radius = 0.0;
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
  };
  class Builder;
  double form_factor(const Node& node, const SurfacePoint& at) const;

  EmissionTexture texture_{};
  UvMap uv_{};
  Eigen::Matrix<double, 2, 4> place_ = Eigen::Matrix<double, 2, 4>::Zero();
  std::vector<Node> nodes_{};
  std::vector<Loop> polygons_{};
};

}  // namespace lightwell
