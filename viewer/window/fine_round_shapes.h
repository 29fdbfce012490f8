#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Elements of round shapes, split into smaller faces on the exact shape. A drawn shape is then as
/// round as the one that rays hit. The light of a point is interpolated from the vertices of its
/// element.
struct FineRoundShapes {
  struct Point {
    Eigen::Vector3d position, normal;  ///< m; unit, pointing out of the drawn side
    std::array<int, 4> vertex{};       ///< mesh vertices of the element; -1: none
    Eigen::Array4f weight{};           ///< of each vertex's light, bilinear; sum 1
  };
  struct Face {
    int element = 0;              ///< mesh element that contains the face
    std::array<int, 4> corner{};  ///< indices into points, counter-clockwise; [3] -1: a triangle
  };
  std::vector<Point> points{};
  std::vector<Face> faces{};
  std::vector<std::array<int, 2>> outlines{};  ///< pairs of points along element edges
  std::vector<char> has_faces{};               ///< by element; empty: no round shapes
};

/// Splits every element of the mesh's grids of round shapes.
FineRoundShapes fine_round_shapes(const PatchMesh& mesh);

}  // namespace lightwell
