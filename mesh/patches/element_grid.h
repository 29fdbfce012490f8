#pragma once

#include <optional>
#include <vector>

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// A flat patch whose elements are equal parallelograms side by side. Cell (i, j) lies between
/// origin + i step + j rise and origin + (i + 1) step + (j + 1) rise, metres.
struct ElementGrid {
  int columns = 0, rows = 0;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d step = Eigen::Vector3d::Zero(), rise = Eigen::Vector3d::Zero();
  std::vector<int> element{};  ///< of cell (i, j) at j * columns + i
};

/// Returns the grid of a patch; empty where the patch is no such grid, to one part in 1e9 of an
/// element.
std::optional<ElementGrid> element_grid(const PatchMesh& mesh, int patch);

}  // namespace lightwell
