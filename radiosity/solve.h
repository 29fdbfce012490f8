#pragma once

#include "radiosity/final_gather.h"
#include "radiosity/form_factors.h"
#include "radiosity/solution.h"

namespace lightwell {

struct SolveOptions {
  MeshOptions mesh{};
  FormFactorOptions form_factors{};
  double tolerance = 1e-5;  ///< Gauss-Seidel stops when the relative residual falls below
  int max_sweeps = 200;
  GatherOptions gather{.rays = 256};
  int error_points = 512;  ///< random points that the error estimate compares
  Progress progress{};
};

/// A mesh and the light on it.
struct SolvedScene {
  PatchMesh mesh{};
  RadiositySolution solution{};
};

/// The whole first pass: mesh, form factors, Gauss-Seidel, final gather, error estimate.
/// Throws InputError if nothing in the scene emits light, Interrupted when progress says stop.
SolvedScene solve_scene(const Scene& scene, const SolveOptions& options = {});

/// The final part alone, for a mesh and its patch radiosities.
void reconstruct(const Scene& scene, const ElementCaster& caster, const DirectLight& direct_light,
                 const FormFactors& form_factors, const SolveOptions& options,
                 RadiositySolution& solution);

}  // namespace lightwell
