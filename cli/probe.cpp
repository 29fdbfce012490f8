#include "raytrace/readings/probe.h"

#include <fmt/format.h>

#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "cli/steps.h"
#include "mesh/elements/element_caster.h"
#include "radiosity/solve_words.h"
#include "raytrace/readings/sure_gather.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

struct ProbeArguments {
  std::string scene, solution, points, output;
  bool interpolate = false;
  int rays = 1024;
  double accuracy = 0.0;  // 0: not asked for
};

// Tells of probes without a bound, and of those that did not reach the accuracy.
void say_bounds(const ProbeBounds& bounds, double accuracy, Console& console, Report& report) {
  const auto unknown = bounds.lux_within.isNaN().count();
  if (unknown > 0) {
    console.say(
        fmt::format("note: lux_within is left empty at {} of {} points: no light was found there.",
                    unknown, bounds.lux_within.size()));
  }
  report.add("points_without_bound", unknown);
  if (!(accuracy > 0.0)) return;
  report.add("points_short_of_accuracy", bounds.missed);
  if (bounds.missed == 0) return;
  console.say(fmt::format(
      "warning: {} of {} points are less accurate than {:g} %, since their rays reached the limit "
      "of {} sets of {}; lux_within has the bound that they reached.",
      bounds.missed, bounds.lux_within.size(), 100.0 * accuracy, sure_sets, most_sure_rays));
}

// Tells of points just behind a surface, whose light is that of its back.
void note_points_behind(const ElementCaster& caster, std::span<const Probe> probes,
                        double metres_per_unit, Console& console, Report& report) {
  const std::vector<int> behind = probes_behind_surfaces(caster, probes);
  report.add("points_behind_surfaces", behind.size());
  if (behind.empty()) return;
  const Eigen::Vector3d at =
      probes[static_cast<std::size_t>(behind.front())].position / metres_per_unit;
  console.say(fmt::format(
      "note: {} of {} points lie a little behind a surface that faces their way, and have the "
      "light "
      "of its back; move them forward if they are meant for its front (the first: point {} at "
      "({:g}, {:g}, {:g})).",
      behind.size(), probes.size(), behind.front() + 1, at.x(), at.y(), at.z()));
}

// Refuses an accuracy that is no share from 0.1 % to 100 %.
double probe_accuracy(const std::string& text) {
  constexpr double least = 1e-3;
  const auto share = parse_share(text);
  if (!share || *share < least) {
    throw CLI::ValidationError(
        "--accuracy",
        fmt::format("'{}' is no accuracy of points; write a share of each point's illuminance from "
                    "0.1% to 100%, such as 0.5%",
                    text));
  }
  return *share;
}

// Solves as far as probes need: coarse gathers, no refinement, no error estimate.
SolvedScene solve_for_probes(const Scene& scene, Console& console, Report& report) {
  SolveOptions options = options_for_probes();
  options.run.progress = console.progress();
  SolvedScene solved = solve_scene(scene, options);
  console.finish_phase();
  stop_if_interrupted();
  note_mesh(scene, solved.mesh, console, report);
  solved.solution.provenance.version = LIGHTWELL_VERSION;
  solved.solution.provenance.options = "coarse solve for probes";
  report.add_solution(solved, true);
  report.remove("parts");
  report.remove("error_estimate");  // the solve made no estimate
  return solved;
}

int probe(const ProbeArguments& arguments, Console& console) {
  if (arguments.interpolate && arguments.solution.empty()) {
    throw InputError(
        "--interpolate reads the mesh of a solution made by 'lightwell solve'; name one after the "
        "scene");
  }
  Report report(console.options());
  const Scene scene = read_scene_step(arguments.scene, console, report);
  if (scene.relative_units) {
    console.say("note: the scene names no unit of light; irradiance and lux are relative.");
  }
  note_input(arguments.points);
  const std::vector<Probe> probes = read_probes(arguments.points, scene.metres_per_unit);
  require_writable(arguments.output);
  const SolvedScene solved = arguments.solution.empty()
                                 ? solve_for_probes(scene, console, report)
                                 : read_solution_step(arguments.solution, scene, console, report);

  const Stopwatch watch;
  const ElementCaster caster(solved.mesh);
  BandArray irradiance;
  Eigen::ArrayXd lux_within;
  bool is_short = false;
  if (arguments.interpolate) {
    irradiance = interpolate_irradiance(caster, solved.solution, probes);
    lux_within = interpolation_bound(caster, solved.solution, probes);
  } else {
    note_points_behind(caster, probes, scene.metres_per_unit, console, report);
    const DirectLight direct_light(scene, caster);
    ProbeBounds bounds{.accuracy = arguments.accuracy};
    irradiance = probe_irradiance(scene, caster, direct_light, solved.solution, probes,
                                  {.rays = arguments.rays, .run = {.progress = console.progress()}},
                                  &bounds);
    console.finish_phase();
    say_bounds(bounds, arguments.accuracy, console, report);
    lux_within = std::move(bounds.lux_within);
    is_short = bounds.missed > 0;
  }
  console.finish_phase();
  stop_if_interrupted();
  write_probes(arguments.output, probes, irradiance, scene.bands, scene.metres_per_unit,
               lux_within);
  report.add_file(arguments.output);
  report.add("points", probes.size());
  report.add("method", arguments.interpolate ? "interpolate" : "gather");
  report.add_phase("probe", watch.seconds());
  report.print();
  return is_short ? exit_not_accurate : exit_done;
}

}  // namespace

Action add_probe(CLI::App& command) {
  const auto arguments = std::make_shared<ProbeArguments>();
  command.description("Irradiance (W/m2 per band) and illuminance (lx) at points of a scene.");
  command.add_option("scene", arguments->scene, "scene file, as for 'solve'")
      ->required()
      ->type_name("SCENE");
  command
      .add_option("solution", arguments->solution,
                  "the scene's solution, .vtp (default: a coarse solve for these points)")
      ->type_name("SOLUTION");
  command
      .add_option("--points", arguments->points,
                  "CSV with columns x,y,z,nx,ny,nz in the scene file's unit")
      ->required()
      ->type_name("FILE");
  command.add_option("-o,--output", arguments->output, "CSV: the points with E_<band>..., lux")
      ->required()
      ->type_name("FILE");
  auto* const interpolate = command.add_flag(
      "--interpolate", arguments->interpolate,
      "interpolate in the solution's mesh instead of gathering; points must lie on surfaces");
  command
      .add_option("--rays", arguments->rays, "gather rays per point, a power of two (default 1024)")
      ->type_name("N")
      ->check(power_of_two())
      ->excludes(interpolate);
  command
      .add_option_function<std::string>(
          "--accuracy",
          [arguments](const std::string& text) { arguments->accuracy = probe_accuracy(text); },
          "gather with more rays until the bound of each point's noise (lux_within) is below this "
          "share of its lux, from 0.1%")
      ->type_name("SHARE")
      ->excludes(interpolate);
  command.footer("Example: lightwell probe office.toml --points desk.csv -o desk-lux.csv");
  return [arguments](Console& console) { return probe(*arguments, console); };
}

}  // namespace lightwell
