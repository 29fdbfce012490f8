#pragma once

#include <optional>

#include "radiosity/solve.h"

namespace lightwell {

/// What a first, cheap gather finds at vertices. It sharpens what patches hold as one value each
/// (the dark foot of a block): the second gather reads it.
struct Draft {
  std::optional<PatchMesh> refined{};    ///< whose vertices are meant, if not the caster's
  BandArray direct{}, indirect{};        ///< W/m^2, vertices x bands
  BandArray caustic{};                   ///< the same; empty if the scene has no mirrors or glass
  Eigen::ArrayXf interpolation_error{};  ///< see RadiositySolution; empty without refinement
  RefineReport refinement{};
};

/// Refines the elements, if options.refine says so, and gathers at their vertices. `solution` has
/// patch radiosities; `direct_light` keeps apart its channels, if there are any, and what is
/// gathered has columns for each. Elements are split as all light together asks for.
Draft make_draft(const Scene& scene, const ElementCaster& caster, const DirectLight& direct_light,
                 const SolveOptions& options, const RadiositySolution& solution);

/// The final gather; `caster` is of the mesh whose vertices the draft is for. The direct light of
/// a refined mesh has been gathered for good. With channels it is theirs that is filled in; their
/// sum is left to relight().
void reconstruct(const Scene& scene, const ElementCaster& caster, const DirectLight& direct_light,
                 const SolveOptions& options, Draft draft, RadiositySolution& solution);

}  // namespace lightwell
