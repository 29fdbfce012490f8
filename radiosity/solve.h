#pragma once

#include <optional>

#include "mesh/build_patches.h"
#include "radiosity/form_factors/form_factors.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/journal/run_control.h"
#include "radiosity/many_lights/light_choice.h"
#include "radiosity/paths/free_light.h"
#include "radiosity/refine/refine_options.h"
#include "radiosity/solution/emitter_channels.h"
#include "radiosity/solution/solution.h"
#include "radiosity/solvers/progressive.h"
#include "radiosity/solvers/solve_radiosity.h"

namespace lightwell {

/// The error of irradiance to reach, compared with RadiositySolution::error_estimate (RMS). Exactly
/// one of the two is above 0.
struct Accuracy {
  double share = 0.0;  ///< share of the mean irradiance
  double lux = 0.0;    ///< lx
};

/// Options of the first pass, from the scene to a solution.
struct SolveOptions {
  MeshOptions mesh{};
  FormFactorOptions form_factors{};
  SolverMethod solver_method = SolverMethod::automatic;
  SolverOptions solver{};  ///< solve_scene sets `run` and `name_of` itself
  /// Progressive refinement: patches shoot, and a row of form factors is computed for each shot and
  /// not kept. Of the options of form factors and solver only `form_factors.max_specular_depth`
  /// then counts. Empty: all form factors are kept, and a solver reads them.
  std::optional<ProgressiveOptions> progressive{};
  /// Effort of the final gather. `rays` 0 stands for 1024, or fewer where refinement ended at a
  /// limit with an error that hides their noise.
  GatherOptions gather{.rays = 0, .shadows = {.min_rays = 32, .max_rays = 256, .sky_rays = 1024}};
  RefineOptions refine{};
  /// The error to reach. Chooses the rays of `gather` and, if `refine` has a tolerance, that
  /// tolerance, and raises both until the error estimate is below. If `refine` has no limit of
  /// elements, the limit is a million or four times the elements at the start, whichever is more.
  /// An accuracy that is out of reach gives Outcome::accuracy_missed.
  std::optional<Accuracy> accuracy{};
  /// Rays of a light that is alone in its channel, cast if the scene has mirrors or glass; other
  /// lights cast that times the root of their share of the channel's power.
  int caustic_rays = 1 << 19;
  int free_rays = 1 << 20;  ///< of all lamps together to the patches, see cast_free_light
  /// Channels of emitters whose light is kept apart, so that relight() can dim each.
  EmitterChannels channels{};
  /// A solution with the same patches, whose radiosities the solver begins with; reflectances and
  /// emission may differ. Must outlive the solve. Not with `progressive`.
  const SolvedScene* start = nullptr;
  /// Rays from where somebody looks, such as those of a camera. Errors matter where they end, and
  /// less the less light comes from elsewhere to there; the error estimate is of what they see.
  /// Empty: errors matter everywhere.
  std::vector<Ray> view_rays{};
  int error_points = 512;  ///< sample points of the error estimate
  /// The journal must belong to this scene. (`form_factors` has a journal of its own: that of
  /// another solve, whose form factors serve where only reflectances or emission have changed.)
  RunControl run{};
};

/// Figures of the first pass that are not part of the solution.
struct SolveReport {
  FormFactorReport form_factors{};
  RefineReport refinement{};
  CutSizes cuts{};        ///< lights that points ask, where there are many
  double accuracy = 0.0;  ///< the requested share of the mean irradiance; 0: none was requested
  int gather_rays = 0;    ///< rays of the last final gather
  /// Error that the last finished stage was to reach in limited time, relative to the mean
  /// irradiance; 0 without a limit.
  double stage = 0.0;
};

/// True if elements start at twice the given length, since refinement splits them. False if nothing
/// is refined, if a longest element size is given, or with discontinuity meshing, whose
/// lines need the given length.
bool starts_coarse(const SolveOptions& options);

/// Throws InputError, with what was left out of the scene, if nothing in the scene emits light.
void require_light(const Scene& scene);

/// The whole first pass:
///
/// 1. mesh,
/// 2. form factors and solver, or shooting,
/// 3. refinement of the elements,
/// 4. final gather to their vertices,
/// 5. error estimate.
///
/// Throws InputError if nothing in the scene emits light, if light never ends, if the start has
/// other patches or is given to the progressive solver, if an accuracy in lux is requested of a
/// scene without units, if the mesh has more elements than allowed, or if light is not finite.
/// Throws Interrupted when progress says stop, and std::invalid_argument if the journal is of
/// another scene.
///
/// If `options.run` limits the time, steps 2 to 4 take as many rays and elements as there is time
/// for. Once the time is up, the result is the best there is; the outcome is Outcome::cut_short if
/// a step could not be finished. Step 1 takes the time that it takes.
SolvedScene solve_scene(const Scene& scene, const SolveOptions& options = {},
                        SolveReport* report = nullptr);

/// Steps 3 to 5 of solve_scene, for patch radiosities that were computed elsewhere. `patches` has a
/// mesh of the scene and a solution with patch_radiosity, energy, residual, outcome, history and
/// seconds; the result has the refined mesh and the rest of the solution. `options.channels` must
/// be empty. Throws InputError if light is not finite, Interrupted when progress says stop.
SolvedScene gather_to_elements(const Scene& scene, SolvedScene patches,
                               const SolveOptions& options = {}, SolveReport* report = nullptr);

/// Energy balance of patch radiosities B (patches x bands, W/m^2) and of the light of free sources.
/// The unshot part is the residual M + rho (E0 + F B) - B. The share of mirrors follows from the
/// scene's materials.
EnergyBalance energy_balance(const Scene& scene, const PatchMesh& mesh,
                             const FormFactors& form_factors, const BandArray& B,
                             const FreeLight& free_light = {});

}  // namespace lightwell
