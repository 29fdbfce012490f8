#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Elements of spheres, split into smaller faces on the exact sphere. A drawn sphere is then as
/// round as the one that rays hit. The light of a point is interpolated from the vertices of its
/// element.
struct FineSpheres {
  struct Point {
    Eigen::Vector3d position, normal;  ///< m; unit, pointing out of the drawn side
    std::array<int, 4> vertex{};       ///< mesh vertices of the element; -1: none
    Eigen::Array4f weight{};           ///< of each vertex's light, bilinear in angle; sum 1
  };
  struct Face {
    int element = 0;              ///< mesh element that contains the face
    std::array<int, 4> corner{};  ///< indices into points, counter-clockwise; [3] -1: a triangle
  };
  std::vector<Point> points{};
  std::vector<Face> faces{};
  std::vector<std::array<int, 2>> outlines{};  ///< pairs of points along element edges
  std::vector<char> has_faces{};               ///< by element; empty: no spheres
};

/// Splits every element of the mesh's sphere grids.
FineSpheres fine_spheres(const PatchMesh& mesh);

}  // namespace lightwell
