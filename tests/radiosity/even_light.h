#pragma once

#include "mesh/patches/patch_mesh.h"
#include "radiosity/solution/solution.h"
#include "scene/scene.h"

namespace lightwell::test {

/// A solution whose irradiance is 1 at each vertex, without error.
inline RadiositySolution even_light(const Scene& scene, const PatchMesh& mesh) {
  RadiositySolution solution{.bands = scene.bands};
  solution.direct_irradiance = BandArray::Ones(mesh.vertex_count(), scene.bands.count());
  solution.indirect_irradiance = 0.0f * solution.direct_irradiance;
  solution.interpolation_error = Eigen::ArrayXf::Zero(mesh.element_count());
  solution.gather_noise = Eigen::ArrayXf::Zero(mesh.element_count());
  return solution;
}

}  // namespace lightwell::test
