#include "radiosity/solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>

#include "mesh/build_patches.h"
#include "radiosity/accuracy.h"
#include "radiosity/direct_light/cut_sizes.h"
#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/effective_options.h"
#include "radiosity/emitters/emitter.h"
#include "radiosity/form_factors/transport.h"
#include "radiosity/illuminate_elements.h"
#include "radiosity/importance/importance.h"
#include "radiosity/journal/journal.h"
#include "radiosity/journal/journal_phase.h"
#include "radiosity/openings/find_openings.h"
#include "radiosity/parts/find_parts.h"
#include "radiosity/refine/effort.h"
#include "radiosity/refine/refine_solution.h"
#include "radiosity/rows/memory_budget.h"
#include "radiosity/solve_equations.h"
#include "radiosity/solvers/solve_channels.h"
#include "radiosity/solvers/solve_radiosity.h"
#include "scene/errors.h"
#include "scene/name_in_messages.h"
#include "scene/stopwatch.h"

namespace lightwell {

void require_light(const Scene& scene) {
  if (gives_light(scene)) return;
  std::string message = fmt::format(
      "{}: nothing emits light, so there is nothing to solve; give a material a 'radiance', "
      "'exitance' or 'power' (in OBJ files: Ke) and use it on a surface, or add a lamp",
      name_in_messages(scene));
  // The lamp may be among what was left out.
  constexpr std::size_t most = 5;
  for (std::size_t i = 0; i < std::min(most, scene.losses.size()); ++i) {
    message += "\n  " + scene.losses[i];
  }
  throw InputError(message);
}

namespace {

void require_no_start(const SolveOptions& options) {
  if (!options.progressive || !options.start) return;
  throw InputError(
      "the solver 'progressive' starts from the emitters and cannot start from a solution; use "
      "another solver, such as the default");
}

// Patch radiosities by progressive refinement, with `seconds` of the phases.
RadiositySolution shoot(const LitScene& lit, const SolveOptions& options) {
  Stopwatch watch;
  const LightPaths paths(lit.scene, lit.caster, options.form_factors.max_specular_depth);
  const FreeLight free_light = cast_free_light(lit.scene, lit.caster, paths, lit.direct_light,
                                               options.free_rays, options.run.progress);
  ProgressiveRadiosity progressive(lit.scene, lit.mesh(),
                                   cast_shots(lit.caster, paths, options.progressive->most_rays),
                                   *options.progressive, options.channels, free_light);
  JournalPhase phase(options.run, "shots", [&](Fingerprint& print) {
    print.add(lit.mesh());
    print.add(free_light.irradiance);
    print.add(options.form_factors.max_specular_depth);
    const auto& [tolerance, max_shots, rays, most_rays, overshooting] = *options.progressive;
    print.add(tolerance);
    print.add(max_shots);
    print.add(rays);
    print.add(most_rays);
    print.add(overshooting);
    print.add(options.channels.of_surface);
  });
  RadiositySolution solution;
  const bool is_finished = finishes_in_time(options.run, [&](const RunControl& in_time) {
    solution = shoot_to_the_end(progressive, in_time.progress, &phase);
  });
  if (!is_finished) {
    solution = progressive.solution();
    solution.outcome = Outcome::cut_short;
  }
  solution.seconds.push_back({"solve", watch.lap()});
  return solution;
}

// The openings of the scene; none if the time is up before they are found.
std::vector<Opening> openings_in_time(const Scene& scene, const RunControl& run) {
  std::vector<Opening> openings;
  finishes_in_time(run,
                   [&](const RunControl& in_time) { openings = find_openings(scene, in_time); });
  return openings;
}

// Options of shooting: the given ones, or the defaults if no method was chosen and form factors do
// not fit into memory or onto disk, which a note of the mesh explains. Empty: form factors are
// kept.
std::optional<ProgressiveOptions> without_rows(const DirectLight& direct_light,
                                               const SolveOptions& options, PatchMesh& mesh) {
  if (options.progressive || options.start || options.solver_method != SolverMethod::automatic ||
      options.form_factors.method != FormFactorMethod::automatic) {
    return options.progressive;
  }
  const auto memory = options.form_factors.memory;
  const StorageReport storage = memory ? memory->report() : MemoryBudget().report();
  FormFactorOptions rows = options.form_factors;
  rows.rays_per_patch = rays_per_patch(options);
  rows.run.journal = options.run.journal;
  const ProgressiveOptions shooting{.tolerance = options.solver.tolerance,
                                    .overshooting = Overshooting::ambient};
  const auto emitters = static_cast<std::int64_t>(direct_light.emitters().size());
  const TransportChoice choice =
      choose_transport({.patches = mesh.patch_count(),
                        .rows = most_row_bytes(mesh.patch_count(), rows),
                        .work = bytes_beside_rows(mesh, emitters, rows),
                        .shooting = bytes_to_shoot(mesh, shooting.most_rays),
                        .resident = resident_memory().now,
                        .limit = storage.limit,
                        .disk = room_on_disk(storage.folder)});
  // All processes shoot if one has no room for rows.
  const bool has_room = choice.transport != Transport::shooting;
  if (options.run.least(has_room ? 1 : 0) == 1) return std::nullopt;
  mesh.notes.push_back(has_room ? "one of the processes has no room for form factors; so patches "
                                  "shoot their light without them (--solver progressive)"
                                : choice.reason);
  return shooting;
}

void require_unit(const Scene& scene, const SolveOptions& options) {
  if (!options.accuracy || options.accuracy->share > 0.0 || !scene.relative_units) return;
  throw InputError(
      "the unit of the scene's light is unknown, so no accuracy in lux is possible; ask for a "
      "share "
      "of the mean irradiance, such as 1%");
}

// The shadow options of the first attempt at the accuracy.
ShadowOptions first_shadows(const SolveOptions& options) {
  const ShadowOptions& asked = options.gather.shadows;
  if (!options.accuracy || !(options.accuracy->share > 0.0)) return asked;
  return first_effort(options.accuracy->share, true).shadows(asked.many_lights);
}

// Direct light with columns of each channel; empty without channels.
std::optional<DirectLight> light_by_channel(const Scene& scene, const PatchMesh& mesh,
                                            const DirectLight& all_light,
                                            const EmitterChannels& channels) {
  if (channels.empty()) return std::nullopt;
  return std::make_optional<DirectLight>(scene, mesh, channels, &all_light);
}

void add_importance(const Scene& scene, const ElementCaster& caster, const SolveOptions& options,
                    SolvedScene& solved) {
  const LightPaths paths(scene, caster, options.form_factors.max_specular_depth);
  const BandArray reflected = solved.solution.patch_radiosity - solved.mesh.emission;
  const Eigen::ArrayXf brightness = reflected.max(0.0f).rowwise().sum();
  solved.solution.parts.importance =
      find_importance(caster, paths, solved.solution.parts, options.view_rays,
                      {brightness.data(), static_cast<std::size_t>(brightness.size())});
}

// Fills in the parts of a solution that do not depend on the light.
void describe(const Scene& scene, RadiositySolution& solution) {
  solution.bands = scene.bands;
  solution.metres_per_unit = scene.metres_per_unit;
  solution.unit_name = scene.unit_name;
  solution.relative_units = scene.relative_units;
  solution.provenance.scene_file = scene.file.string();
  solution.provenance.scene_hash = scene_hash(scene);
}

}  // namespace

SolvedScene gather_to_elements(const Scene& scene, SolvedScene patches, const SolveOptions& options,
                               SolveReport* report) {
  SolvedScene solved = std::move(patches);
  describe(scene, solved.solution);
  if (solved.solution.parts.count() == 0) {
    const ElementCaster caster(solved.mesh);
    const LightPaths paths(scene, caster, options.form_factors.max_specular_depth);
    solved.solution.parts = find_parts(scene, caster, paths, options.run.progress);
  }
  const DirectLight direct_light(scene, solved.mesh);
  if (!options.view_rays.empty()) {
    add_importance(scene, ElementCaster(solved.mesh), options, solved);
  }
  const auto by_channel = light_by_channel(scene, solved.mesh, direct_light, options.channels);
  const std::vector<Opening> openings = openings_in_time(scene, options.run);
  illuminate_elements(scene, {direct_light, by_channel ? *by_channel : direct_light, openings},
                      options, solved, report);
  return solved;
}

int rays_per_patch(const SolveOptions& options) {
  const int most = options.form_factors.rays_per_patch;
  return options.accuracy ? form_factor_rays(options.accuracy->share, most) : most;
}

int auto_patch_count(const SolveOptions& options) {
  const int most = options.mesh.auto_patch_count;
  return options.accuracy ? patch_count_for(options.accuracy->share, most) : most;
}

bool starts_coarse(const SolveOptions& options) {
  return options.refine.tolerance > 0.0 && !options.mesh.discontinuity &&
         !(options.mesh.max_element_size > 0.0);
}

EnergyBalance energy_balance(const Scene& scene, const PatchMesh& mesh,
                             const FormFactors& form_factors, const BandArray& B,
                             const FreeLight& free_light) {
  return total(band_energy(scene, mesh, form_factors, B, free_light), free_energy(free_light));
}

SolvedScene solve_scene(const Scene& scene, const SolveOptions& options, SolveReport* report) {
  require_light(scene);
  require_no_start(options);
  require_unit(scene, options);
  const std::uint64_t hash = scene_hash(scene);
  if (options.run.journal && options.run.journal->of().scene_hash != hash) {
    throw std::invalid_argument("the journal belongs to another scene");
  }
  SolvedScene solved;
  std::vector<PhaseSeconds> seconds;
  Stopwatch watch;
  MeshOptions mesh_options = options.mesh;
  mesh_options.to_be_refined = starts_coarse(options);
  mesh_options.auto_patch_count = auto_patch_count(options);
  solved.mesh = build_patches(scene, mesh_options, options.run.progress);
  require_room(solved.mesh, options.refine);
  std::optional<ElementCaster> caster(std::in_place, solved.mesh);
  const DirectLight direct_light(scene, solved.mesh);
  const auto by_channel = light_by_channel(scene, solved.mesh, direct_light, options.channels);
  const DirectLight& kept_apart = by_channel ? *by_channel : direct_light;
  seconds.push_back({"mesh", watch.lap()});
  SceneParts parts = find_parts(scene, *caster,
                                LightPaths(scene, *caster, options.form_factors.max_specular_depth),
                                options.run.progress);
  seconds.push_back({"parts", watch.lap()});
  const std::vector<Opening> openings = openings_in_time(scene, options.run);
  seconds.push_back({"openings", watch.lap()});

  // The memory of the gathers is reserved before rows of form factors take it.
  if (options.form_factors.memory) options.form_factors.memory->plan(bytes_to_gather(solved.mesh));
  SolveOptions exchange = options;
  exchange.progressive = without_rows(direct_light, options, solved.mesh);
  if (exchange.progressive) {
    solved.solution = shoot({scene, *caster, kept_apart}, exchange);
  } else {
    SolvedEquations equations =
        solve_in_time({{scene, *caster, direct_light}, kept_apart, openings}, exchange);
    solved.solution = std::move(equations.solution);
    std::ranges::move(equations.notes, std::back_inserter(solved.mesh.notes));
    if (report) report->form_factors = std::move(equations.rows);
  }
  RadiositySolution& solution = solved.solution;
  for (const PhaseSeconds& phase : solution.seconds) seconds.push_back(phase);
  watch.lap();
  describe(scene, solution);

  solution.seconds = std::move(seconds);
  solution.parts = std::move(parts);
  if (!options.view_rays.empty()) add_importance(scene, *caster, options, solved);

  if (report) report->cuts = cut_sizes(*caster, kept_apart, first_shadows(options));
  caster.reset();
  illuminate_elements(scene, {direct_light, kept_apart, openings}, options, solved, report);
  return solved;
}

}  // namespace lightwell
