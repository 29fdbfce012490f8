#pragma once

#include <Eigen/Geometry>

#include "mesh/build_patches.h"
#include "radiosity/direct_light/direct_light.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::test {

/// Two rooms of 4 x 5 x 2.7 m that share the wall x = 4, with a doorway of 0.9 x 2 m in it, and a
/// leaf that leaves a slit of `width` metres open beside its latch, at y from 2.9 - width to 2.9.
/// All is turned by `turn`. The rooms' walls are one-sided; wall and leaf have no thickness.
struct RoomsWithSlit {
  explicit RoomsWithSlit(double slit,
                         const Eigen::Quaterniond& about = Eigen::Quaterniond::Identity(),
                         float rho = 0.5f)
      : width(slit), turn(about), scene(make(rho)) {}

  Eigen::Vector3d at(double x, double y, double z) const { return turn * Eigen::Vector3d(x, y, z); }
  /// Counter-clockwise seen from the room beyond x = 4.
  std::vector<Eigen::Vector3d> slit() const {
    return {at(4, 2.9 - width, 0), at(4, 2.9, 0), at(4, 2.9, 2), at(4, 2.9 - width, 2)};
  }
  /// Radiosity at vertices: 1 in the room x < 4, and 0 in the other, on the wall between them and
  /// on the leaf.
  BandArray bright_room(const PatchMesh& mesh) const {
    BandArray B = BandArray::Zero(mesh.vertex_count(), 3);
    for (int e = 0; e < mesh.element_count(); ++e) {
      if (!is_bright(mesh, e)) continue;
      for (int c = 0; c < mesh.corner_count(e); ++c) B.row(mesh.corners[e][c]) = 1.0f;
    }
    return B;
  }
  bool is_bright(const PatchMesh& mesh, int element) const {
    return (turn.conjugate() * element_center(mesh, element).position).x() < 4.0 - 1e-6;
  }

  double width;
  Eigen::Quaterniond turn;
  Scene scene;

 private:
  Scene make(float rho) const {
    Scene made;
    const int wall = add_material(made, diffuse(made.bands, rho));
    Material both = diffuse(made.bands, rho);
    both.one_sided = false;
    const int leaf = add_material(made, both);
    const auto polygon = [&](const char* name, int material, std::vector<Eigen::Vector3d> points) {
      for (Eigen::Vector3d& p : points) p = turn * p;
      add_polygon(made, name, material, points);
    };
    for (const double x : {0.0, 4.0}) {
      const double y = 5.0, z = 2.7;
      polygon("floor", wall, {{x, 0, 0}, {x + 4, 0, 0}, {x + 4, y, 0}, {x, y, 0}});
      polygon("ceiling", wall, {{x, 0, z}, {x, y, z}, {x + 4, y, z}, {x + 4, 0, z}});
      polygon("left", wall, {{x, 0, 0}, {x, 0, z}, {x + 4, 0, z}, {x + 4, 0, 0}});
      polygon("right", wall, {{x, y, 0}, {x + 4, y, 0}, {x + 4, y, z}, {x, y, z}});
    }
    polygon("near", wall, {{0, 0, 0}, {0, 5, 0}, {0, 5, 2.7}, {0, 0, 2.7}});
    polygon("far", wall, {{8, 0, 0}, {8, 0, 2.7}, {8, 5, 2.7}, {8, 5, 0}});
    polygon("beside", leaf, {{4, 0, 0}, {4, 2, 0}, {4, 2, 2.7}, {4, 0, 2.7}});
    polygon("beyond", leaf, {{4, 2.9, 0}, {4, 5, 0}, {4, 5, 2.7}, {4, 2.9, 2.7}});
    polygon("above", leaf, {{4, 2, 2}, {4, 2.9, 2}, {4, 2.9, 2.7}, {4, 2, 2.7}});
    polygon("leaf", leaf, {{4, 2, 0}, {4, 2.9 - width, 0}, {4, 2.9 - width, 2}, {4, 2, 2}});
    return made;
  }
};

}  // namespace lightwell::test
