#include "radiosity/solve.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "mesh/patch_sampler.h"
#include "radiosity/interpolation_error.h"
#include "radiosity/journal.h"
#include "radiosity/journal_phase.h"
#include "radiosity/reconstruct.h"
#include "radiosity/relight.h"
#include "radiosity/solve_channels.h"
#include "radiosity/solve_radiosity.h"
#include "radiosity/start_radiosity.h"
#include "scene/errors.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr std::uint64_t error_point_key = 20;  // purposes of random keys

class Stopwatch {
 public:
  // Seconds since the last call.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void require_light(const Scene& scene) {
  for (const Surface& surface : scene.surfaces) {
    if (scene.materials[surface.material].is_emitter()) return;
  }
  throw InputError(fmt::format(
      "{}: nothing emits light, so there is nothing to solve; give a material a 'radiance', "
      "'exitance' or 'power' (in OBJ files: Ke) and use it on a surface",
      scene.file.empty() ? "the scene" : scene.file.string()));
}

void require_equations(const SolveOptions& options) {
  if (!options.progressive || (options.channels.empty() && !options.start)) return;
  throw InputError(
      fmt::format("the solver 'progressive' {}; use another, such as the default",
                  options.start ? "starts from the emitters and cannot go on from another solution"
                                : "shoots all light together and cannot keep channels apart"));
}

// Uniform over the area that reflects: independent gathers against the interpolation.
double estimate_error(const Scene& scene, const ElementCaster& caster,
                      const DirectLight& direct_light, const SolveOptions& options,
                      const RadiositySolution& solution) {
  const PatchMesh& mesh = caster.mesh();
  std::vector<double> area_to(mesh.patch_count());
  double total = 0.0;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    // Nobody sees what another surface lies on; looking from above would find that surface.
    const bool is_seen = caster.hidden_elements(p) == 0;
    if (is_seen && (mesh.reflectance.row(p) > 0.0f).any()) total += mesh.area[p];
    area_to[p] = total;
  }
  if (!(total > 0.0) || options.error_points < 1) return 0.0;

  std::vector<GatherPoint> points(options.error_points);
  BandArray caustic = BandArray::Zero(options.error_points, scene.bands.count());
  BandArray interpolated(options.error_points, scene.bands.count());
  const BandArray irradiance = solution.irradiance();
  const SobolPoints sobol(options.error_points);
  for (int i = 0; i < options.error_points; ++i) {
    const Eigen::Array4f u = sobol.point(i, error_point_key);
    const auto at = std::upper_bound(area_to.begin(), area_to.end() - 1, u[0] * total);
    const int p = static_cast<int>(at - area_to.begin());
    const PatchPoint point = PatchSampler(mesh, p).point(u[1], u[2]);
    points[i] = {point.position, point.normal, mesh.facet[point.element]};
    // The element's own interpolation: look at the point from just above it.
    const double above = 1e-3 * std::sqrt(mesh.element_area[point.element]);
    const Ray ray{.origin = point.position + above * point.normal, .direction = -point.normal};
    ElementHit hit;
    caster.closest_hits({&ray, 1}, {&hit, 1});
    if (hit.element < 0)
      hit = {.facet = mesh.facet[point.element], .element = point.element, .weights = {1, 0, 0, 0}};
    interpolated.row(i) = interpolate(mesh, irradiance, hit).transpose();
    if (solution.caustic_irradiance.size() > 0) {
      caustic.row(i) = interpolate(mesh, solution.caustic_irradiance, hit).transpose();
    }
  }
  GatherOptions gather_options = options.gather;
  gather_options.rays = 2 * options.gather.rays;
  gather_options.replica = options.gather.replica + 1;
  gather_options.progress = options.progress;
  gather_options.journal = options.journal;
  const GatheredIrradiance independent = gather_irradiance(
      scene, caster, direct_light, gatherable_radiosity(mesh, direct_light, irradiance), points,
      gather_options);
  const BandArray truth = independent.direct + independent.indirect + caustic;
  const double mean = truth.cast<double>().mean();
  if (!(mean > 0.0)) return 0.0;
  const Eigen::ArrayXd reference = truth.cast<double>().rowwise().mean().unaryExpr(
      [mean](double own) { return error_reference(mean, own); });
  const Eigen::ArrayXd squares = (interpolated - truth).cast<double>().square().rowwise().mean();
  return std::sqrt((squares / reference.square()).mean());
}

// Of patches; `seconds` of the result say what took how long.
RadiositySolution shoot(const Scene& scene, const ElementCaster& caster,
                        const SolveOptions& options) {
  Stopwatch watch;
  const LightPaths paths(scene, caster, options.form_factors.max_specular_depth);
  ProgressiveRadiosity progressive(scene, caster.mesh(),
                                   cast_shots(caster, paths, options.progressive->most_rays),
                                   *options.progressive);
  JournalPhase phase(options.journal, "shots", [&](Fingerprint& print) {
    print.add(caster.mesh());
    print.add(options.form_factors.max_specular_depth);
    const ProgressiveOptions& shooting = *options.progressive;
    print.add(shooting.tolerance);
    print.add(shooting.max_shots);
    print.add(shooting.rays);
    print.add(shooting.most_rays);
    print.add(shooting.overshooting);
  });
  RadiositySolution solution = shoot_to_the_end(progressive, options.progress, &phase);
  solution.seconds.push_back({"solve", watch.lap()});
  return solution;
}

RadiositySolution solve_equations(const Scene& scene, const ElementCaster& caster,
                                  const DirectLight& direct_light, const SolveOptions& options,
                                  SolveReport* report) {
  const PatchMesh& mesh = caster.mesh();
  Stopwatch watch;
  FormFactorOptions form_factor_options = options.form_factors;
  form_factor_options.progress = options.progress;
  form_factor_options.journal = options.journal;
  const auto form_factors = compute_form_factors(scene, caster, direct_light, form_factor_options,
                                                 report ? &report->form_factors : nullptr);
  const double form_factor_seconds = watch.lap();

  SolverOptions solver_options = options.solver;
  solver_options.progress = options.progress;
  solver_options.journal = options.journal;
  solver_options.name_of = [&](int i) {
    return fmt::format("surface '{}'", scene.surfaces[mesh.surface[i]].name);
  };
  if (options.start) solver_options.start = start_radiosity(mesh, *options.start);
  RadiositySolution solution =
      solve_radiosity(options.solver_method, mesh, *form_factors, solver_options);
  if (!options.channels.empty()) {
    solver_options.start = start_by_channel(options.start, options.channels);
    solve_channels(scene, mesh, *form_factors, options.channels, options.solver_method,
                   solver_options, solution);
  }
  solution.energy = energy_balance(scene, mesh, *form_factors, solution.patch_radiosity);
  solution.seconds = {{"form_factors", form_factor_seconds}, {"solve", watch.lap()}};
  return solution;
}

}  // namespace

bool starts_coarse(const SolveOptions& options) {
  return options.refine.tolerance > 0.0 && !options.mesh.discontinuity;
}

EnergyBalance energy_balance(const Scene& scene, const PatchMesh& mesh,
                             const FormFactors& form_factors, const BandArray& B) {
  return total(band_energy(scene, mesh, form_factors, B));
}

SolvedScene solve_scene(const Scene& scene, const SolveOptions& options, SolveReport* report) {
  require_light(scene);
  require_equations(options);
  const std::uint64_t hash = scene_hash(scene);
  if (options.journal && options.journal->of().scene_hash != hash) {
    throw std::invalid_argument("the journal is of another scene");
  }
  SolvedScene solved;
  std::vector<PhaseSeconds> seconds;
  Stopwatch watch;
  MeshOptions mesh_options = options.mesh;
  mesh_options.progress = options.progress;
  mesh_options.to_be_refined = starts_coarse(options);
  solved.mesh = build_patches(scene, mesh_options);
  require_room(solved.mesh, options.refine);
  std::optional<ElementCaster> caster(std::in_place, solved.mesh);
  const DirectLight direct_light(scene, solved.mesh);
  seconds.push_back({"mesh", watch.lap()});

  solved.solution = options.progressive
                        ? shoot(scene, *caster, options)
                        : solve_equations(scene, *caster, direct_light, options, report);
  RadiositySolution& solution = solved.solution;
  for (const PhaseSeconds& phase : solution.seconds) seconds.push_back(phase);
  watch.lap();
  solution.bands = scene.bands;
  solution.metres_per_unit = scene.metres_per_unit;
  solution.unit_name = scene.unit_name;
  solution.relative_units = scene.relative_units;

  std::optional<DirectLight> by_channel;
  if (!options.channels.empty()) by_channel.emplace(scene, solved.mesh, options.channels);
  const DirectLight& kept_apart = by_channel ? *by_channel : direct_light;
  Draft draft = make_draft(scene, *caster, kept_apart, options, solution);
  if (draft.refined) {
    caster.reset();
    solved.mesh = std::move(*draft.refined);
    caster.emplace(solved.mesh);
    seconds.push_back({"refine", watch.lap()});
    solution.provenance.refinement = sentence(draft.refinement);
    if (report) report->refinement = draft.refinement;
  }
  reconstruct(scene, *caster, kept_apart, options, std::move(draft), solution);
  relight(solved, scales_in_force(solution));
  seconds.push_back({"gather", watch.lap()});
  solution.error_estimate = estimate_error(scene, *caster, direct_light, options, solution);
  seconds.push_back({"error_estimate", watch.lap()});
  solution.seconds = std::move(seconds);
  solution.provenance.scene_file = scene.file.string();
  solution.provenance.scene_hash = hash;
  return solved;
}

}  // namespace lightwell
