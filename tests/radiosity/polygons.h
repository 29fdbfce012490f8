#pragma once

#include <vector>

#include "mesh/build_patches.h"
#include "mesh/patches/patch_mesh.h"
#include "radiosity/visibility/shaft.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::test {

using Corners = std::vector<Eigen::Vector3d>;

/// Polygons, each a surface of its own; patch i is polygon i where none touches another.
struct Polygons {
  explicit Polygons(const std::vector<Corners>& polygons) {
    const int grey = add_material(scene, diffuse(scene.bands, 0.5f));
    for (const Corners& p : polygons) add_polygon(scene, "polygon", grey, p);
    mesh = build_patches(scene, {.max_patch_size = 1e9, .elements_per_patch_edge = 1});
  }
  ShaftEnd end(const Shafts& shafts, int patch) const {
    return shafts.end(patch_outline(mesh, patch), mesh.facet_of(patch));
  }
  Scene scene;
  PatchMesh mesh;
};

}  // namespace lightwell::test
