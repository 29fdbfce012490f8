#pragma once

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// The patches of a mesh without emission and without their elements, which solvers do not need.
inline PatchMesh patches_alone(const PatchMesh& mesh) {
  PatchMesh patches;
  patches.area = mesh.area;
  patches.reflectance = mesh.reflectance;
  patches.transmittance = mesh.transmittance;
  patches.behind = mesh.behind;
  patches.material = mesh.material;
  return patches;
}

}  // namespace lightwell
