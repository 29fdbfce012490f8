#include "raytrace/render.h"

#include <memory>

#include "cli/arguments.h"
#include "cli/checkpoint.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "cli/steps.h"
#include "cli/time_limit.h"
#include "raytrace/cameras/camera_ray.h"

namespace lightwell {
namespace {

struct RenderCommandArguments {
  std::string scene, solution, camera;
  std::vector<std::string> outputs;
  RenderArguments render;
  CheckpointArguments checkpoint;
  double seconds = 0.0;  // 0: any time
};

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
  for (const std::filesystem::path& file : files) require_writable(file);
  const SolvedScene solved = read_solution_step(arguments.solution, scene, console, report);
  const InterruptEndsEarly on_interrupt;
  console.show_time_left(time.seconds_left());
  report.add("camera", camera.name);
  Checkpoint checkpoint(arguments.checkpoint,
                        picture_provenance(scene, solved.solution, arguments.render), files,
                        console);
  RenderableScene renderable(scene, solved);
  const bool is_as_asked =
      render_step(renderable, {camera, arguments.render, files, time.seconds_left()}, checkpoint,
                  {console, report});
  checkpoint.finish(report, is_as_asked);
  report.print();
  return is_as_asked ? exit_done : exit_not_accurate;
}

}  // namespace

Action add_render(CLI::App& command) {
  const auto arguments = std::make_shared<RenderCommandArguments>();
  command.description(
      "Renders a picture of a solved scene: diffuse light from the solution,\n"
      "mirrors and glass by ray tracing.");
  add_solved_scene(command, arguments->scene, arguments->solution);
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
  command.footer(
      "Example: lightwell render cornell/cornell.toml cornell.vtp --size 256x256 -o small.png");
  return [arguments](Console& console) { return render_scene(*arguments, console); };
}

}  // namespace lightwell
