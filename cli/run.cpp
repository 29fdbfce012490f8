#include <fmt/format.h>

#include <memory>
#include <optional>

#include "cli/arguments.h"
#include "cli/checkpoint.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "cli/several_processes.h"
#include "cli/steps.h"
#include "cli/time_limit.h"
#include "mesh/patches/patch_textures.h"
#include "radiosity/solution/solution_file.h"
#include "raytrace/cameras/camera_ray.h"

namespace lightwell {
namespace fs = std::filesystem;
namespace {

struct RunArguments {
  std::string scene, output;
  SolveArguments solve;
  CheckpointArguments checkpoint;
  RenderArguments render;
  double seconds = 0.0;  // 0: any time
};

fs::path default_folder(const fs::path& scene) {
  return scene.stem().string() + "-output";  // in the working folder
}

struct Outputs {
  fs::path solution{};
  std::vector<std::vector<fs::path>> pictures{};  // of each camera
};

struct Job {
  const RunArguments& arguments;
  const Scene& scene;
  const Outputs& outputs;
  const TimeLimit& time;
  Feedback feedback;
};

// The solution in its file if --resume was given and the file is finished; otherwise solves the
// scene and writes the file.
SolvedScene solved_scene(const Job& job) {
  const auto& [arguments, scene, outputs, time, feedback] = job;
  Console& console = feedback.console;
  Report& report = feedback.report;
  const Provenance of = provenance(scene, arguments.solve);
  agree_on(of, time, console);
  const CheckpointArguments kept = of_first(arguments.checkpoint, console);
  auto done = finished_solution(kept, of, outputs.solution, console);
  if (answer_of_first(done.has_value(), console)) {
    // The file is there for all processes that share the folder.
    if (!done) done = read_solution(outputs.solution);
    attach_textures(scene, done->mesh);
    report.add_solution(*done, false);
    return std::move(*done);
  }
  Checkpoint checkpoint(kept, of, {outputs.solution}, console);
  // The rest is for pictures. Every picture and number reads the light, so light gets more.
  constexpr double share_of_solve = 0.6;
  SolvedScene solved = solve_step(scene, {arguments.solve, outputs.solution, time, share_of_solve},
                                  checkpoint, feedback);
  if (!console.is_first()) return solved;
  write_solution_step(outputs.solution, solved, console, report);
  checkpoint.finish(report, solved.solution.outcome != Outcome::cut_short);
  return solved;
}

// Renders the pictures; returns whether all of them are as asked for.
bool render_pictures(const Job& job, const SolvedScene& solved) {
  const auto& [arguments, scene, outputs, time, feedback] = job;
  Console& console = feedback.console;
  CheckpointArguments kept = of_first(arguments.checkpoint, console);
  kept.reuse.clear();
  const bool holds_the_solve = kept.keep || solved.solution.outcome == Outcome::cut_short;
  if (holds_the_solve) kept.file.clear();
  kept.resume = kept.resume && fs::exists(kept.file);  // none exists before the first tiles
  std::vector<fs::path> files = {outputs.solution};
  for (const auto& each : outputs.pictures) files.insert(files.end(), each.begin(), each.end());
  Checkpoint checkpoint(kept, picture_provenance(scene, solved.solution, arguments.render), files,
                        console);
  RenderableScene renderable(scene, solved);
  const std::size_t count = scene.cameras.size();
  bool are_as_asked = true;
  try {
    for (std::size_t i = 0; i < count; ++i) {
      RunControl all;
      if (!console.processes()) all.seconds_left = time.seconds_left();
      const RunControl own = all.with_share(1.0 / static_cast<double>(count - i));
      const PictureTask task{scene.cameras[i], arguments.render, outputs.pictures[i],
                             own.seconds_left};
      are_as_asked = render_step(renderable, task, checkpoint, feedback) && are_as_asked;
    }
  } catch (const InterruptedWith&) {
    throw;
  } catch (const Interrupted&) {
    if (kept.file.empty()) throw;
    throw InterruptedWith(
        fmt::format("interrupted; the solution is in '{}'. To resume with the pictures:\n  {}",
                    outputs.solution.string(), command_to_resume(console)));
  }
  checkpoint.finish(feedback.report, are_as_asked, "picture_checkpoint");
  return are_as_asked;
}

// With an accuracy or a limited time, errors matter where the cameras look, unless --look-from says
// otherwise.
RunArguments looking_from_cameras(RunArguments arguments, const Scene& scene) {
  std::vector<std::string>& names = arguments.solve.look_from.names;
  const bool is_by_error = arguments.solve.solve.accuracy || arguments.seconds > 0.0;
  if (!is_by_error || !names.empty()) return arguments;
  for (const Camera& camera : scene.cameras) names.push_back(camera.name);
  return arguments;
}

void require_all_writable(const Outputs& outputs, const fs::path& report_file) {
  for (const auto& files : outputs.pictures) {
    for (const fs::path& picture : files) require_writable(picture);
  }
  require_writable(outputs.solution);
  require_writable(report_file);
}

int run(const RunArguments& given, Console& console) {
  const TimeLimit time(given.seconds);
  Report report(console.options());
  Scene scene = read_scene_step(given.scene, console, report);
  // At once, so that --look-from spends effort on what the pictures show.
  for (Camera& camera : scene.cameras) camera = given.render.projection.view(camera, scene);
  const EarlyEnd on_interrupt(console);
  console.show_time_left(time.seconds_left());
  const RunArguments arguments = looking_from_cameras(given, scene);
  choose_camera(scene, "");  // throws before the work if the scene has no camera
  const fs::path folder =
      arguments.output.empty() ? default_folder(arguments.scene) : fs::path(arguments.output);
  std::optional<OutputFolder> made;
  if (console.is_first()) made.emplace(folder);
  const fs::path report_file = folder / "report.json";
  Outputs outputs{.solution = folder / "solution.vtp"};
  for (const Camera& camera : scene.cameras) {
    outputs.pictures.push_back({folder / (camera.name + ".exr"), folder / (camera.name + ".png")});
    arguments.render.film.check(scene, outputs.pictures.back());
    static_cast<void>(
        CameraRays(arguments.render.projection.view(camera, scene)));  // throws for a bad camera
  }
  if (console.is_first()) require_all_writable(outputs, report_file);

  const Job job{arguments, scene, outputs, time, {console, report}};
  const SolvedScene solved = solved_scene(job);
  const bool are_as_asked = render_pictures(job, solved);
  if (!console.is_first()) return exit_done;
  report.add_file(report_file);
  report.write(report_file);
  report.print();
  return are_as_asked ? exit_code(solved.solution) : exit_not_accurate;
}

}  // namespace

Action add_run(CLI::App& command) {
  const auto arguments = std::make_shared<RunArguments>();
  command.description(
      "Solves a scene and renders its cameras: solution.vtp, .exr and .png files, report.json.");
  add_scene(command, arguments->scene);
  command.add_option("-o,--output", arguments->output, "folder for the results (SCENE-output)")
      ->type_name("DIR");
  arguments->solve.add_to(command);
  arguments->checkpoint.add_to(command, CheckpointArguments::HelpOn::first);
  arguments->checkpoint.pictures_follow = true;
  arguments->checkpoint.add_reuse_to(command, CheckpointArguments::HelpOn::first);
  arguments->render.add_to(command);
  // Hidden, as rarely needed; 'render --help' and 'solve --help' show them.
  for (const char* name : {"--depth", "--photons", "--samples", "--max-sweeps", "--projection",
                           "--near", "--shift", "--virtual-lights", "--many-lights"}) {
    command.get_option(name)->group("");
  }
  arguments->render.film.add_to(command, "How pictures are made", FilmArguments::HelpOn::hidden);
  add_time_limit(command, arguments->seconds, "How the light is solved");
  command.footer("Example: lightwell run cornell/cornell.toml -o cornell-results --size 1024x1024");
  return [arguments](Console& console) { return run(*arguments, console); };
}

}  // namespace lightwell
