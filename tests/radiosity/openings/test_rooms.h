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

/// Two rooms of 4 x 3 x 2.6 m with a wall of `depth` metres between them, at x from 0 to `depth`.
/// Below a part of the wall that is 0.9 m wide, as below a door, a gap of `gap` metres is open. The
/// floor of the room x < 0 is black, all else reflects `rho`.
struct RoomsBesideDoor {
  static constexpr double depth = 0.04, from = 1.0, to = 1.9;  // m; y of the gap's ends

  explicit RoomsBesideDoor(double height, float rho = 0.5f) : gap(height), scene(make(rho)) {}

  /// Mouth of the gap towards the room beyond, counter-clockwise seen from there.
  std::vector<Eigen::Vector3d> mouth() const {
    return {{depth, from, 0}, {depth, to, 0}, {depth, to, gap}, {depth, from, gap}};
  }
  /// Radiosity at vertices: 1 in the room x < 0, else 0.
  static BandArray bright_room(const PatchMesh& mesh) {
    BandArray B = BandArray::Zero(mesh.vertex_count(), 3);
    for (int e = 0; e < mesh.element_count(); ++e) {
      const Eigen::Vector3d n = element_center(mesh, e).normal;
      const double x = element_center(mesh, e).position.x();
      if (x > 1e-6 || (x > -1e-6 && n.x() > 0.0)) continue;
      for (int c = 0; c < mesh.corner_count(e); ++c) B.row(mesh.corners[e][c]) = 1.0f;
    }
    return B;
  }

  double gap;
  Scene scene;

 private:
  Scene make(float rho) const {
    constexpr double size = 4.0, y = 3.0, z = 2.6;
    Scene made;
    const int wall = add_material(made, diffuse(made.bands, rho));
    const int black = add_material(made, diffuse(made.bands, 0.0f));
    const auto polygon = [&](const char* name, const std::vector<Eigen::Vector3d>& points) {
      add_polygon(made, name, wall, points);
    };
    const double d = depth, x = depth + size, a = from, b = to, h = gap;
    polygon(
        "floor",
        {{0, a, 0}, {d, a, 0}, {d, 0, 0}, {x, 0, 0}, {x, y, 0}, {d, y, 0}, {d, b, 0}, {0, b, 0}});
    add_polygon(made, "lit floor", black, {{-size, 0, 0}, {0, 0, 0}, {0, y, 0}, {-size, y, 0}});
    for (const auto& [low, high] : {std::pair(-size, 0.0), {d, x}}) {
      polygon("ceiling", {{low, 0, z}, {low, y, z}, {high, y, z}, {high, 0, z}});
      polygon("right", {{low, 0, 0}, {low, 0, z}, {high, 0, z}, {high, 0, 0}});
      polygon("left", {{low, y, 0}, {high, y, 0}, {high, y, z}, {low, y, z}});
    }
    polygon("near", {{-size, 0, 0}, {-size, y, 0}, {-size, y, z}, {-size, 0, z}});
    polygon("far", {{x, 0, 0}, {x, 0, z}, {x, y, z}, {x, y, 0}});
    polygon(
        "lit side",
        {{0, 0, 0}, {0, 0, z}, {0, y, z}, {0, y, 0}, {0, b, 0}, {0, b, h}, {0, a, h}, {0, a, 0}});
    polygon(
        "dark side",
        {{d, 0, 0}, {d, a, 0}, {d, a, h}, {d, b, h}, {d, b, 0}, {d, y, 0}, {d, y, z}, {d, 0, z}});
    polygon("underside", {{0, a, h}, {0, b, h}, {d, b, h}, {d, a, h}});
    polygon("jamb", {{0, a, 0}, {0, a, h}, {d, a, h}, {d, a, 0}});
    polygon("other jamb", {{0, b, 0}, {d, b, 0}, {d, b, h}, {0, b, h}});
    return made;
  }
};

}  // namespace lightwell::test
