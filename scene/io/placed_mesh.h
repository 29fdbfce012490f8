#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "scene/io/corner_maps.h"
#include "scene/io/polygon.h"
#include "scene/io/polygon_repair.h"
#include "scene/scene.h"

namespace lightwell {

/// Loops of simple shapes as the file formats define them, counter-clockwise seen from outside or
/// from +z.
std::vector<Loop> rectangle_loops();  ///< x and y from -1 to 1, z = 0
std::vector<Loop> cube_loops();       ///< all coordinates from -1 to 1
/// Corners around of round shapes that are read as polygons.
inline constexpr int round_sides = 32;
/// Regular polygon about the origin, z = 0, with the area of the disk of radius 1.
std::vector<Loop> disk_loops();
/// Quadrilaterals (triangles where a radius is 0) round the z axis between circles at z = 0 and z =
/// `height`, with the area of the truncated cone; no caps. Radii >= 0, not both 0.
std::vector<Loop> cone_loops(double radius, double top_radius, double height);
/// Normals of such a cone at the corners of its `loops`, for placed_loops().
std::vector<NormalLoop> cone_normals(const std::vector<Loop>& loops, double radius,
                                     double top_radius, double height);
/// Regular polygon about the origin, z = 0, with the area of the ring between the radii; its hole
/// is a regular polygon too (no hole if `inner` is 0).
Polygon ring_polygon(double inner, double outer);
/// Quadrilaterals and triangles between circles of latitude, with the area of the sphere of radius
/// 1.
std::vector<Loop> sphere_loops();

/// True if a transformation keeps angles to 1e-6: a rotation, translation, mirroring, uniform
/// scaling, or a product of these.
bool keeps_angles(const Eigen::Affine3d& transform);

/// Transformation of normals, up to length and sign: the cofactor matrix, which is finite even for
/// a transformation that flattens.
Eigen::Matrix3d normal_transform(const Eigen::Affine3d& transform);

/// Removes the vertex normals of the file from a mesh.
void drop_normals(PolygonMesh& mesh);

/// Exchanges front and back of every facet.
void turn_over(PolygonMesh& mesh);

/// True if every edge of the facets' boundaries occurs exactly once in each direction.
bool is_closed(const PolygonMesh& mesh);

/// Loops transformed by `transform`, with front and back exchanged if `flip`. Fronts stay on their
/// side of the surface even where the transformation mirrors. Polygons without area after the
/// transformation are dropped. `uv` and `normals` are given before the transformation, one entry
/// for each loop, or empty.
PolygonMesh placed_loops(const std::vector<Loop>& loops, const Eigen::Affine3d& transform,
                         bool flip, Repairs& repairs, const std::vector<UvLoop>& uv = {},
                         const std::vector<NormalLoop>& normals = {});

/// placed_loops() for a mesh of valid facets without holes. With `mirror_turns` false, the order of
/// the corners alone defines the front, so that mirroring turns the mesh inside out.
PolygonMesh placed_mesh(PolygonMesh mesh, const Eigen::Affine3d& transform, bool flip,
                        bool mirror_turns, Repairs& repairs);

}  // namespace lightwell
