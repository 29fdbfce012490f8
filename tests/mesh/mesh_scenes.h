#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "scene/scene.h"

namespace lightwell::test {

using Loop = std::vector<Eigen::Vector3d>;

/// A diffuse material with the reflectance `rho` in every band of an RGB scene.
Material diffuse(const std::string& name, float rho);

/// A scene with RGB bands and no surfaces. Material 0 reflects 0.5 on both sides, material 1 on its
/// front only.
Scene empty_scene();

PolygonMesh polygon(const Loop& boundary, const std::vector<Loop>& holes = {});
void add_polygon(Scene& scene, const std::string& name, const Loop& boundary,
                 const std::vector<Loop>& holes = {}, int material = 0);
void add_sphere(Scene& scene, const std::string& name, const Sphere& sphere, int material = 0);

/// Adds six outward rectangles, the sides of an axis-parallel box, as one surface or six.
void add_box(Scene& scene, const std::string& name, const Eigen::Vector3d& low,
             const Eigen::Vector3d& high, bool one_surface = true, int material = 0);

/// The measured Cornell box (metres): rectangles as published, blocks without bottoms standing on
/// the floor, a ceiling with a hole that the light fills, and the warped left wall as two triangles
/// of one surface.
Scene cornell_box();

/// A height field of 2 n^2 triangles over the unit square.
Scene terrain(int n);

/// Uniform numbers that are the same on every machine.
class Numbers {
 public:
  explicit Numbers(std::uint32_t seed) : state_(seed * 2654435761u + 12345u) {}
  int below(int n);
  double between(double low, double high);

 private:
  std::uint32_t state_;
};

/// Adds a black material that emits 1 W/m^2 in every band from its front, and returns its index.
int add_lamp(Scene& scene);

/// A floor (facet 0), a lamp above that faces down (facet 1) and one to four boxes. With even seeds
/// the boxes stand on a lattice and touch in every way; with odd seeds they cross. Every fifth
/// scene is rotated.
Scene boxes_under_a_lamp(std::uint32_t seed);

/// A ball of radius 1 about the origin, facing outwards: one surface of n (n - 2) triangles, n
/// even, of a material of empty_scene().
Scene triangle_ball(int n, int material);

/// Checks every promise of PatchMesh's comments that the mesh alone can show.
void expect_consistent(const PatchMesh& mesh);

/// Sum of the areas of the elements of a facet on one side.
double side_area(const PatchMesh& mesh, int facet, bool back);

/// Number of places where a vertex lies inside an element's edge, to 1e-9 of the longest edge;
/// across facets only along lines where one ends or is cut. 0 means that the mesh conforms.
int hanging_vertices(const PatchMesh& mesh);

/// Smallest angle of all elements, degrees.
double smallest_angle(const PatchMesh& mesh);

}  // namespace lightwell::test
