#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mesh/geometry/box_tree.h"
#include "scene/round_shape.h"
#include "scene/scene.h"

namespace lightwell {

/// Finds the nearest point of the surfaces that stand in the way of light: all polygons and round
/// shapes but clear ones and those that move.
class NearestSurface {
 public:
  explicit NearestSurface(const Scene& scene);

  /// The point nearest to `from` among those nearer than `within` metres; empty if there is none.
  std::optional<Eigen::Vector3d> find(const Eigen::Vector3d& from, double within) const;

 private:
  using PlanarLoop = std::vector<Eigen::Vector2d>;
  // A polygon in coordinates of its plane, or a round shape, whose loops are empty.
  struct Shape {
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                    normal = Eigen::Vector3d::UnitZ();
    std::optional<RoundShape> round{};
    std::vector<PlanarLoop> loops{};
    BoxTree::Box box{};
  };
  static Shape polygon(const PolygonMesh& mesh, const Facet& facet);
  static Eigen::Vector3d nearest_of(const Shape& shape, const Eigen::Vector3d& from);

  std::vector<Shape> shapes_{};
  std::optional<BoxTree> tree_{};  // empty: there are no shapes
};

}  // namespace lightwell
