#pragma once

#include <Eigen/Geometry>
#include <string>
#include <utility>
#include <vector>

#include "../test_scenes.h"

namespace lightwell::test {

/// A room in the house of house_with_doors(): a box with a name.
struct RoomBox {
  std::string name{};
  Eigen::Vector3d low{}, high{};
};

/// A doorway through the walls that two rooms turn to each other, across x: the inside of one ends
/// at `x`, that of the other begins at `x` + `thickness`.
struct Doorway {
  double x = 0.0, thickness = 0.1;
  double y = 0.0, width = 0.9, z = 0.0, height = 2.0;
};

/// A rectangle at `x` over [y0, y1] x [z0, z1] that faces +x or -x, without the doorways in it, as
/// rectangles. Doorways stand on z0 and do not overlap.
inline void add_wall(Scene& scene, const std::string& name, int material, double x, bool faces_up,
                     std::pair<double, double> y, std::pair<double, double> z,
                     const std::vector<Doorway>& doors) {
  const auto add = [&](double y0, double y1, double z0, double z1) {
    if (y1 - y0 < 1e-9 || z1 - z0 < 1e-9) return;
    std::vector<Eigen::Vector3d> points = {{x, y0, z0}, {x, y1, z0}, {x, y1, z1}, {x, y0, z1}};
    if (!faces_up) points = {points.rbegin(), points.rend()};
    add_polygon(scene, name, material, points);
  };
  double from = y.first;
  for (const Doorway& door : doors) {  // in rising order of y
    add(from, door.y, z.first, z.second);
    add(door.y, door.y + door.width, z.first, door.z);
    add(door.y, door.y + door.width, door.z + door.height, z.second);
    from = door.y + door.width;
  }
  add(from, y.second, z.first, z.second);
}

/// The sides of a doorway, which face into it.
inline void add_reveal(Scene& scene, int material, const Doorway& door) {
  const double x0 = door.x, x1 = door.x + door.thickness, y0 = door.y, y1 = door.y + door.width,
               z0 = door.z, z1 = door.z + door.height;
  add_polygon(scene, "reveal", material, {{x0, y0, z0}, {x0, y0, z1}, {x1, y0, z1}, {x1, y0, z0}});
  add_polygon(scene, "reveal", material, {{x0, y1, z0}, {x1, y1, z0}, {x1, y1, z1}, {x0, y1, z1}});
  add_polygon(scene, "reveal", material, {{x0, y0, z0}, {x1, y0, z0}, {x1, y1, z0}, {x0, y1, z0}});
  add_polygon(scene, "reveal", material, {{x0, y0, z1}, {x0, y1, z1}, {x1, y1, z1}, {x1, y0, z1}});
}

/// Rooms side by side and the doorways between them; all surfaces are seen from inside. Surfaces
/// have the names of their rooms.
inline Scene rooms_with_doors(const std::vector<RoomBox>& rooms, const std::vector<Doorway>& doors,
                              float rho = 0.6f) {
  Scene scene;
  const int wall = add_material(scene, diffuse(scene.bands, rho));
  for (const RoomBox& room : rooms) {
    const Eigen::Vector3d &a = room.low, &b = room.high;
    const auto add = [&](const std::vector<Eigen::Vector3d>& points) {
      add_polygon(scene, room.name, wall, points);
    };
    add({{a.x(), a.y(), a.z()},
         {b.x(), a.y(), a.z()},
         {b.x(), b.y(), a.z()},
         {a.x(), b.y(), a.z()}});
    add({{a.x(), a.y(), b.z()},
         {a.x(), b.y(), b.z()},
         {b.x(), b.y(), b.z()},
         {b.x(), a.y(), b.z()}});
    add({{a.x(), a.y(), a.z()},
         {a.x(), a.y(), b.z()},
         {b.x(), a.y(), b.z()},
         {b.x(), a.y(), a.z()}});
    add({{a.x(), b.y(), a.z()},
         {b.x(), b.y(), a.z()},
         {b.x(), b.y(), b.z()},
         {a.x(), b.y(), b.z()}});
    for (const bool at_low : {true, false}) {
      const double x = at_low ? a.x() : b.x();
      std::vector<Doorway> here;
      for (const Doorway& door : doors) {
        const bool touches = std::abs((at_low ? door.x + door.thickness : door.x) - x) < 1e-9;
        if (touches && door.y >= a.y() && door.y + door.width <= b.y()) here.push_back(door);
      }
      add_wall(scene, room.name, wall, x, at_low, {a.y(), b.y()}, {a.z(), b.z()}, here);
    }
  }
  for (const Doorway& door : doors) add_reveal(scene, wall, door);
  return scene;
}

/// Two rooms of 4 m x 5 m x 3 m, "bright" with a lamp of 0.4 m x 0.4 m below its ceiling and "dim"
/// without one, and a doorway of 2 m height between them. The rooms are closed but for that.
inline Scene bright_and_dim(double door_width, float rho = 0.6f) {
  Scene scene =
      rooms_with_doors({{"bright", {0, 0, 0}, {4, 5, 3}}, {"dim", {4.1, 0, 0}, {8.1, 5, 3}}},
                       {{.x = 4.0, .y = 2.5 - 0.5 * door_width, .width = door_width}}, rho);
  Material lamp = diffuse(scene.bands, 0.0f, 100.0f);
  const int m = add_material(scene, lamp);
  add_polygon(scene, "lamp", m,
              {{1.8, 2.3, 2.9}, {1.8, 2.7, 2.9}, {2.2, 2.7, 2.9}, {2.2, 2.3, 2.9}});
  return scene;
}

/// Three rooms in a row, whose doors of 0.9 m do not lie opposite each other, with a lamp in the
/// first.
inline Scene three_rooms() {
  Scene scene =
      rooms_with_doors({{"first", {0, 0, 0}, {4, 5, 3}},
                        {"second", {4.1, 0, 0}, {8.1, 5, 3}},
                        {"third", {8.2, 0, 0}, {12.2, 5, 3}}},
                       {{.x = 4.0, .y = 0.4, .width = 0.9}, {.x = 8.1, .y = 3.7, .width = 0.9}});
  const int lamp = add_material(scene, diffuse(scene.bands, 0.0f, 100.0f));
  add_polygon(scene, "lamp", lamp,
              {{1.8, 2.3, 2.9}, {1.8, 2.7, 2.9}, {2.2, 2.7, 2.9}, {2.2, 2.3, 2.9}});
  return scene;
}

/// Turns and moves all polygons of a scene.
inline void turn(Scene& scene, double angle, const Eigen::Vector3d& axis) {
  const Eigen::Isometry3d motion =
      Eigen::Translation3d(1.3, -0.4, 7.1) * Eigen::AngleAxisd(angle, axis.normalized());
  for (Surface& surface : scene.surfaces) {
    auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
    if (!mesh) continue;
    for (Eigen::Vector3d& vertex : mesh->vertices) vertex = motion * vertex;
  }
}

}  // namespace lightwell::test
