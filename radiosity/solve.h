#pragma once

#include <optional>

#include "mesh/build_patches.h"
#include "radiosity/accuracy.h"
#include "radiosity/form_factors/form_factors.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/journal/run_control.h"
#include "radiosity/paths/free_light.h"
#include "radiosity/refine/refine_solution.h"
#include "radiosity/solution/emitter_channels.h"
#include "radiosity/solution/solution.h"
#include "radiosity/solvers/progressive.h"
#include "radiosity/solvers/solve_radiosity.h"

namespace lightwell {

struct SolveOptions {
  MeshOptions mesh{};
  FormFactorOptions form_factors{};
  SolverMethod solver_method = SolverMethod::automatic;
  SolverOptions solver{};  ///< but for `progress`, `journal` and `name_of`
  /// Patches shoot, with rows found on the fly and forgotten, instead of all form factors and a
  /// solver: of the options above only `form_factors.max_specular_depth` then counts.
  std::optional<ProgressiveOptions> progressive{};
  GatherOptions gather{.rays = 1024};
  RefineOptions refine{};
  /// Chooses the rays of `gather` and, where elements are split, the tolerance of `refine`, and
  /// tries again with more until the error estimate is below; a million elements, or four times
  /// those of the start, if `refine` names no limit. Where it gives up, the outcome of the
  /// solution says so.
  std::optional<Accuracy> accuracy{};
  int caustic_rays = 1 << 19;  ///< per emitter, only cast where there are mirrors or glass
  int free_rays = 1 << 20;     ///< from all lamps together to the patches, see cast_free_light
  /// Whose light is kept apart, so that relight() can dim it; not with `progressive`.
  EmitterChannels channels{};
  /// A solution to start from, of the same patches: other reflectances or emission. Must outlive
  /// the solving; not with `progressive`.
  const SolvedScene* start = nullptr;
  int error_points = 512;  ///< random points that the error estimate looks at
  /// The journal must be of this scene. (The journal of another solve, whose form factors serve
  /// where only reflectances or emission have changed, belongs into `form_factors`.)
  RunControl run{};
};

/// What the first pass found out besides the solution.
struct SolveReport {
  FormFactorReport form_factors{};
  RefineReport refinement{};
  double accuracy = 0.0;  ///< what was asked for, of the mean irradiance; 0: nothing was
  int gather_rays = 0;    ///< in force
};

/// Whether elements start twice as long as asked for, and are split where that matters: unless
/// nothing is refined, and unless a longest size is given or lines of discontinuity are drawn,
/// which need the size asked for.
bool starts_coarse(const SolveOptions& options);

/// The whole first pass: mesh, form factors, solver, refinement of the elements, final gather to
/// their vertices, and an error estimate by independent gathers at random points (relative RMS
/// difference from the interpolation; it holds the noise of both, so it errs on the high side).
/// Throws InputError if nothing in the scene emits light or light never ends, if the start has
/// other patches, and where the progressive solver cannot do what is asked; Interrupted when
/// progress says stop; std::invalid_argument if the journal is of another scene.
SolvedScene solve_scene(const Scene& scene, const SolveOptions& options = {},
                        SolveReport* report = nullptr);

/// The second half of solve_scene, for light that was found otherwise: `patches` has a mesh of the
/// scene with patch_radiosity, energy, residual, outcome, history and seconds of its own; elements
/// are refined as `options` say, light is gathered to vertices, and the rest of the solution filled
/// in. `channels` must be empty. Throws Interrupted when progress says stop.
SolvedScene gather_to_elements(const Scene& scene, SolvedScene patches,
                               const SolveOptions& options = {}, SolveReport* report = nullptr);

/// Where the light of patch radiosities B and of free sources went; `residual` =
/// M + rho (E0 + F B) - B. Mirrors' share is taken from the scene's materials.
EnergyBalance energy_balance(const Scene& scene, const PatchMesh& mesh,
                             const FormFactors& form_factors, const BandArray& B,
                             const FreeLight& free_light = {});

}  // namespace lightwell
