#include "raytrace/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "cli/arguments.h"
#include "cli/checkpoint.h"
#include "cli/commands.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "cli/several_processes.h"
#include "cli/steps.h"
#include "cli/time_limit.h"
#include "radiosity/solve.h"
#include "raytrace/cameras/camera_ray.h"
#include "raytrace/virtual_lights/sketch.h"

namespace lightwell {
namespace {

struct RenderCommandArguments {
  std::string scene, solution, camera;
  std::vector<std::string> outputs;
  RenderArguments render;
  CheckpointArguments checkpoint;
  double seconds = 0.0;  // 0: any time
};

// The light of a scene without a solution: at the vertices of a coarse mesh.
SolvedScene sketch_step(const Scene& scene, const RenderArguments& arguments, Console& console,
                        Report& report) {
  require_light(scene);
  constexpr int few_lights = 1024;
  const int lights = std::min(few_lights, arguments.virtual_lights);
  const Stopwatch watch;
  SolvedScene sketched = sketch_scene(scene, {.virtual_lights = lights,
                                              .max_specular_depth = arguments.depth,
                                              .progress = console.progress()});
  sketched.solution.provenance.options = fmt::format("{} virtual lights", lights);
  console.finish_phase();
  report.add_phase("sketch", watch.seconds());
  return sketched;
}

SolvedScene solved_scene(const RenderCommandArguments& arguments, const Scene& scene,
                         Console& console, Report& report) {
  return arguments.render.needs_solution()
             ? read_solution_step(arguments.solution, scene, console, report)
             : sketch_step(scene, arguments.render, console, report);
}

int render_scene(const RenderCommandArguments& arguments, Console& console) {
  const TimeLimit time(arguments.seconds);
  Report report(console.options());
  const Scene scene = read_scene_step(arguments.scene, console, report);
  const Camera& camera = choose_camera(scene, arguments.camera);
  const std::vector<std::filesystem::path> files(arguments.outputs.begin(),
                                                 arguments.outputs.end());
  arguments.render.film.check(scene, files);
  static_cast<void>(
      CameraRays(arguments.render.projection.view(camera, scene)));  // throws for a bad camera
  if (console.is_first()) {
    for (const std::filesystem::path& file : files) require_writable(file);
  }
  const SolvedScene solved = solved_scene(arguments, scene, console, report);
  const Provenance of = picture_provenance(scene, solved.solution, arguments.render);
  agree_on(of, time, console);
  const EarlyEnd on_interrupt(console);
  console.show_time_left(time.seconds_left());
  report.add("camera", camera.name);
  Checkpoint checkpoint(of_first(arguments.checkpoint, console), of, files, console);
  RenderableScene renderable(scene, solved);
  PictureTask task{camera, arguments.render, files};
  if (!console.processes()) task.seconds_left = time.seconds_left();
  const bool is_as_asked = render_step(renderable, task, checkpoint, {console, report});
  if (!console.is_first()) return exit_done;
  checkpoint.finish(report, is_as_asked);
  report.print();
  return is_as_asked ? exit_done : exit_not_accurate;
}

}  // namespace

Action add_render(CLI::App& command) {
  const auto arguments = std::make_shared<RenderCommandArguments>();
  command.description(
      "Renders a picture of a solved scene: diffuse light from the solution,\n"
      "mirrors and glass by ray tracing. --pass virtual-lights needs no solution.");
  command.add_option("scene", arguments->scene, "the scene file the solution was made from")
      ->required()
      ->type_name("SCENE");
  command
      .add_option("solution", arguments->solution,
                  "the solution, .vtp; not read for --pass virtual-lights")
      ->type_name("SOLUTION");
  command
      .add_option("-o,--output", arguments->outputs,
                  "the picture, .exr, .png or RADIANCE's .hdr; may be repeated")
      ->required()
      ->type_name("FILE")
      ->type_size(1)
      ->allow_extra_args(false)
      ->check(with_extension({".exr", ".png", ".hdr"}));
  command.add_option("--camera", arguments->camera, "which camera (default: the first)")
      ->type_name("NAME");
  arguments->render.add_to(command);
  const std::string group = "How pictures are made";
  arguments->render.film.add_to(command, group, FilmArguments::HelpOn::shown);
  arguments->render.film.add_false_colour_to(command, group);
  arguments->checkpoint.add_to(command, CheckpointArguments::HelpOn::first, group);
  add_time_limit(command, arguments->seconds, group);
  command.final_callback([arguments] {
    if (!arguments->solution.empty() || !arguments->render.needs_solution()) return;
    throw CLI::ValidationError(
        "solution",
        fmt::format("--pass {} shows the light of a solution; name one, as 'lightwell solve' "
                    "writes it, or ask for --pass virtual-lights",
                    arguments->render.pass));
  });
  command.footer(
      "Example: lightwell render cornell/cornell.toml cornell.vtp --size 256x256 -o small.png");
  return [arguments](Console& console) { return render_scene(*arguments, console); };
}

}  // namespace lightwell
