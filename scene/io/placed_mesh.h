#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "scene/io/polygon.h"
#include "scene/scene.h"

namespace lightwell {

/// Facets, some 5 GB of them, that no scene may exceed: instances multiply quickly.
inline constexpr std::int64_t most_facets = 20'000'000;

/// Loops of simple shapes, counter-clockwise seen from outside or from +z, as formats define them.
std::vector<Loop> rectangle_loops();  ///< x and y from -1 to 1, z = 0
std::vector<Loop> cube_loops();       ///< all coordinates from -1 to 1
/// A regular polygon about the origin, z = 0, of the area of the disk of radius 1.
std::vector<Loop> disk_loops();
/// Rectangles round the z axis from z = 0 to 1, with the area of the cylinder of radius 1; no caps.
std::vector<Loop> cylinder_loops();
/// Quadrilaterals (triangles where a radius is 0) round the z axis between circles at z = 0 and
/// `height`, with the area of the cone that is cut off there; no caps. Radii >= 0, not both 0.
std::vector<Loop> cone_loops(double radius, double top_radius, double height);
/// A regular polygon about the origin, z = 0, with a hole of the same kind unless `inner` is 0, of
/// the area of the ring between those radii.
Polygon ring_polygon(double inner, double outer);
/// Quadrilaterals and triangles between circles of latitude, of the area of the sphere of radius 1.
std::vector<Loop> sphere_loops();

/// Whether a transformation keeps angles: it turns, moves, mirrors and scales evenly, to 1e-6.
bool keeps_angles(const Eigen::Affine3d& transform);

/// What a transformation does to normals, but for their length and side: its cofactors, which are
/// finite even where it flattens.
Eigen::Matrix3d normal_transform(const Eigen::Affine3d& transform);

/// Takes the normals away that a file gives at vertices.
void drop_normals(PolygonMesh& mesh);

/// Turns every facet's front to the other side.
void turn_over(PolygonMesh& mesh);

/// The loops where `transform` puts them, turned over if `flip` says so. Normals keep their side of
/// the surface even where the transformation mirrors. Polygons that it flattens are dropped.
/// `uv` and `normals`, as they are before: of each loop, or empty.
PolygonMesh placed_loops(const std::vector<Loop>& loops, const Eigen::Affine3d& transform,
                         bool flip, Repairs& repairs, const std::vector<UvLoop>& uv = {},
                         const std::vector<NormalLoop>& normals = {});

/// The same for a mesh of sound facets without holes; with `mirror_turns` false the order of the
/// corners alone says where the front is, so that a mirrored mesh is turned inside out.
PolygonMesh placed_mesh(PolygonMesh mesh, const Eigen::Affine3d& transform, bool flip,
                        bool mirror_turns, Repairs& repairs);

}  // namespace lightwell
