#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Elements of spheres split finer, on the exact sphere, so that spheres are drawn as round as rays
/// find them; their light stays what the elements' vertices have.
struct FineSpheres {
  struct Point {
    Eigen::Vector3d position, normal;  ///< m; unit, away from the side that is drawn
    std::array<int, 4> vertex{};       ///< of the mesh, whose light, weighted, is the point's
    Eigen::Array4f weight{};           ///< add up to 1, bilinear in angle
  };
  struct Face {
    int element = 0;              ///< that it is a part of
    std::array<int, 4> corner{};  ///< points, counter-clockwise; [3] is -1 for a triangle
  };
  std::vector<Point> points{};
  std::vector<Face> faces{};
  std::vector<std::array<int, 2>> outlines{};  ///< points, along the edges of the elements
  std::vector<char> has_faces{};               ///< by element; empty: there are no spheres
};

FineSpheres fine_spheres(const PatchMesh& mesh);

}  // namespace lightwell
