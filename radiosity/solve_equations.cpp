#include "radiosity/solve_equations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "radiosity/effective_options.h"
#include "radiosity/openings/portals.h"
#include "radiosity/paths/free_light.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/solvers/solve_channels.h"
#include "radiosity/solvers/solve_radiosity.h"
#include "radiosity/start_radiosity.h"
#include "scene/stopwatch.h"

namespace lightwell {
namespace {

// Narrow openings between bright and dim parts, by a solve with few rays; null: none.
std::shared_ptr<const Portals> portals_of_rows(const EquationTask& task,
                                               const FormFactorOptions& options,
                                               const FreeLight& free_light,
                                               const SolverOptions& solver) {
  const LitScene& lit = task.lit;
  if (options.method != FormFactorMethod::automatic &&
      options.method != FormFactorMethod::ray_cast) {
    return nullptr;
  }
  const std::vector<Opening> openings =
      narrow_openings(lit.caster, task.openings, narrow_for_rows, solver.run);
  if (openings.empty()) return nullptr;
  constexpr int few_rays = 32, few_of_emitters = 1024;
  constexpr double tolerance = 1e-3;
  FormFactorOptions few = options;
  few.method = FormFactorMethod::ray_cast;
  few.rays_per_patch = std::min(few_rays, options.rays_per_patch);
  few.rays_per_emitter = few_of_emitters;
  few.run.journal = nullptr;
  SolverOptions rough = solver;
  rough.tolerance = std::max(tolerance, solver.tolerance);
  rough.start = {};
  rough.arriving = free_light.irradiance;
  rough.run.journal = nullptr;
  rough.observer = {};
  const auto form_factors = compute_form_factors(lit, few);
  const BandArray radiosity =
      solve_radiosity(SolverMethod::automatic, lit.mesh(), *form_factors, rough).patch_radiosity;
  auto portals = std::make_shared<const Portals>(
      lit.caster, brightness_of_patches(lit.mesh(), lit.direct_light, radiosity), openings);
  return portals->is_empty() ? nullptr : portals;
}

// Adds notes on light that the rows of form factors lose, and on an energy balance that does not
// add up.
void note_energy(const LitScene& lit, const FormFactorReport& rows,
                 const RadiositySolution& solution, std::vector<std::string>& notes) {
  constexpr double notable = 1e-4;  // of the emitted power
  const PatchMesh& mesh = lit.mesh();
  const EnergyBalance& energy = solution.energy;
  if (!(energy.emitted > 0.0)) return;
  double lost = 0.0, most = 0.0;
  int worst = 0;
  for (int i = 0; i < static_cast<int>(rows.lost_share.size()); ++i) {
    const double power =
        mesh.area[i] * static_cast<double>(rows.lost_share[static_cast<std::size_t>(i)] *
                                           solution.patch_radiosity.row(i).sum());
    lost += power;
    if (power > most) {
      most = power;
      worst = i;
    }
  }
  if (lost > notable * energy.emitted) {
    notes.push_back(fmt::format(
        "{:.2g} % of the emitted power is lost where surfaces lie in the same place or cut each "
        "other, most of it at '{}', and counts as escaped; remove the surfaces that are doubled",
        100.0 * lost / energy.emitted, lit.scene.surfaces[mesh.surface[worst]].name));
  }
  const double surplus = (energy.absorbed + energy.escaped + energy.unshot) / energy.emitted - 1.0;
  if (std::abs(surplus) > notable) {
    notes.push_back(
        fmt::format("the energy balance is off by {:+.2g} %, since the two ends of light paths by "
                    "way of mirrors, "
                    "gloss or glass do not agree; more --rays bring them together",
                    100.0 * surplus));
  }
}

SolvedEquations solve_equations(const EquationTask& task, const SolveOptions& options) {
  const auto& [lit, kept_apart, openings] = task;
  const Scene& scene = lit.scene;
  const PatchMesh& mesh = lit.mesh();
  Stopwatch watch;
  FormFactorOptions form_factor_options = options.form_factors;
  form_factor_options.run.progress = options.run.progress;
  form_factor_options.rays_per_patch = rays_per_patch(options);
  // Gathers at vertices read the light of many patches at once.
  form_factor_options.has_rays_by_area = true;
  if (options.run.journal) form_factor_options.run.journal = options.run.journal;
  form_factor_options.run.processes = options.run.processes;
  const int bands = scene.bands.count();
  const FreeLight by_channel = cast_free_light(
      scene, lit.caster, LightPaths(scene, lit.caster, options.form_factors.max_specular_depth),
      kept_apart, options.free_rays, options.run.progress);
  const FreeLight free_light = all_channels(by_channel, bands);
  SolverOptions pilot = options.solver;
  pilot.run = options.run;
  form_factor_options.portals = portals_of_rows(task, form_factor_options, free_light, pilot);
  SolvedEquations solved;
  const auto form_factors = compute_form_factors(lit, form_factor_options, &solved.rows);
  const double form_factor_seconds = watch.lap();

  SolverOptions solver_options = options.solver;
  solver_options.run = options.run;
  solver_options.name_of = [&](int i) {
    return fmt::format("surface '{}'", scene.surfaces[mesh.surface[i]].name);
  };
  if (options.start) solver_options.start = start_radiosity(mesh, *options.start);
  solver_options.arriving = free_light.irradiance;
  RadiositySolution& solution = solved.solution;
  solution = solve_radiosity(options.solver_method, mesh, *form_factors, solver_options);
  if (!options.channels.empty()) {
    solver_options.start = start_by_channel(options.start, options.channels);
    solve_channels(scene, mesh, *form_factors, by_channel, options.channels, options.solver_method,
                   solver_options, solution);
  }
  solution.energy =
      energy_balance(scene, mesh, *form_factors, solution.patch_radiosity, free_light);
  note_energy(lit, solved.rows, solution, solved.notes);
  solution.seconds = {{"form_factors", form_factor_seconds}, {"solve", watch.lap()}};
  return solved;
}

constexpr int few_row_rays = 64;  // the fewest of form_factor_rays()

// Options of a solve that takes an eighth of the usual time.
SolveOptions with_few_rays(const SolveOptions& options) {
  SolveOptions few = options;
  FormFactorOptions& rows = few.form_factors;
  if (rows.method != FormFactorMethod::automatic) rows.method = FormFactorMethod::ray_cast;
  rows.rays_per_patch = std::min(few_row_rays, rows.rays_per_patch);
  constexpr double tolerance = 1e-3;
  few.solver.tolerance = std::max(tolerance, few.solver.tolerance);
  few.run.journal = nullptr;
  return few;
}

// The rays of each patch that take about `allowed` seconds, where few_row_rays take `spent`; a
// power of two.
int rays_in_time(double spent, double allowed, int most) {
  int rays = few_row_rays;
  double seconds = spent;
  while (2 * rays <= most && 2.0 * seconds <= allowed) {
    rays *= 2;
    seconds *= 2.0;
  }
  return rays;
}

}  // namespace

SolvedEquations solve_in_time(const EquationTask& task, const SolveOptions& options) {
  // Rows get as much time as each of the three gathers that follow: two pilots and the final one.
  constexpr double share_of_rows = 0.25;
  std::optional<SolvedEquations> rough;
  SolveOptions full = options;
  const int wanted = rays_per_patch(options);
  if (options.run.has_limit() && wanted > few_row_rays) {
    Stopwatch watch;
    rough = solve_equations(task, with_few_rays(options));
    const double allowed = share_of_rows * options.run.time_left();
    const int rays = rays_in_time(watch.lap(), allowed, wanted);
    if (rays < wanted) {
      rough->notes.push_back(
          fmt::format("the time allows rows of {} rays a patch instead of {}", rays, wanted));
      full.form_factors.rays_per_patch = rays;
    }
    if (rays <= few_row_rays) return std::move(*rough);
  }
  SolvedEquations solved;
  const bool is_finished = finishes_in_time(options.run, [&](const RunControl& in_time) {
    full.run = in_time;
    solved = solve_equations(task, full);
  });
  if (is_finished) {
    if (rough) solved.notes.insert(solved.notes.end(), rough->notes.begin(), rough->notes.end());
    return solved;
  }
  if (!rough) rough = solve_equations(task, with_few_rays(options));
  rough->notes.push_back(fmt::format(
      "the solve was ended while its form factors were computed: rows of {} rays a patch serve",
      few_row_rays));
  rough->solution.outcome = Outcome::cut_short;
  return std::move(*rough);
}

}  // namespace lightwell
