#include <fmt/format.h>

#include <memory>

#include "cli/arguments.h"
#include "cli/checkpoint.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "cli/steps.h"
#include "mesh/patches/patch_textures.h"
#include "raytrace/camera_ray.h"

namespace lightwell {
namespace fs = std::filesystem;
namespace {

struct RunArguments {
  std::string scene, output;
  SolveArguments solve;
  CheckpointArguments checkpoint;
  RenderArguments render;
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
  Feedback feedback;
};

// The solution in its file if --resume was given and the file is finished; otherwise solves the
// scene and writes the file.
SolvedScene solved_scene(const Job& job) {
  const auto& [arguments, scene, outputs, feedback] = job;
  Console& console = feedback.console;
  Report& report = feedback.report;
  const Provenance of = provenance(scene, arguments.solve);
  if (auto done = finished_solution(arguments.checkpoint, of, outputs.solution, console)) {
    attach_textures(scene, done->mesh);
    report.add_solution(*done, false);
    return std::move(*done);
  }
  Checkpoint checkpoint(arguments.checkpoint, of, {outputs.solution}, console);
  SolvedScene solved = solve_step(scene, {arguments.solve, outputs.solution}, checkpoint, feedback);
  write_solution_step(outputs.solution, solved, console, report);
  checkpoint.finish(report);
  return solved;
}

void render_pictures(const Job& job, const SolvedScene& solved) {
  const auto& [arguments, scene, outputs, feedback] = job;
  Console& console = feedback.console;
  CheckpointArguments kept = arguments.checkpoint;
  kept.reuse.clear();
  if (kept.keep) kept.file.clear();                    // the file holds the solve
  kept.resume = kept.resume && fs::exists(kept.file);  // none exists before the first tiles
  std::vector<fs::path> files = {outputs.solution};
  for (const auto& each : outputs.pictures) files.insert(files.end(), each.begin(), each.end());
  Checkpoint checkpoint(kept, picture_provenance(scene, solved.solution, arguments.render), files,
                        console);
  RenderableScene renderable(scene, solved);
  try {
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
      render_step(renderable, {scene.cameras[i], arguments.render, outputs.pictures[i]}, checkpoint,
                  feedback);
    }
  } catch (const InterruptedWith&) {
    throw;
  } catch (const Interrupted&) {
    if (arguments.checkpoint.file.empty()) throw;
    throw InterruptedWith(
        fmt::format("interrupted; the solution is in '{}'. To resume with the pictures:\n  {}",
                    outputs.solution.string(), command_to_resume(console.options())));
  }
  checkpoint.finish(feedback.report, "picture_checkpoint");
}

// With an accuracy, errors matter where the cameras look, unless --look-from says otherwise.
RunArguments looking_from_cameras(RunArguments arguments, const Scene& scene) {
  std::vector<std::string>& names = arguments.solve.look_from.names;
  if (!arguments.solve.solve.accuracy || !names.empty()) return arguments;
  for (const Camera& camera : scene.cameras) names.push_back(camera.name);
  return arguments;
}

int run(const RunArguments& given, Console& console) {
  Report report(console.options());
  const Scene scene = read_scene_step(given.scene, console, report);
  const RunArguments arguments = looking_from_cameras(given, scene);
  choose_camera(scene, "");  // throws before the work if the scene has no camera
  const OutputFolder folder(arguments.output.empty() ? default_folder(arguments.scene)
                                                     : fs::path(arguments.output));
  const fs::path report_file = folder / "report.json";
  Outputs outputs{.solution = folder / "solution.vtp"};
  for (const Camera& camera : scene.cameras) {
    outputs.pictures.push_back({folder / (camera.name + ".exr"), folder / (camera.name + ".png")});
    arguments.render.film.check(scene, outputs.pictures.back());
    static_cast<void>(CameraRays(arguments.render.sized(camera)));  // throws for a bad camera
    for (const fs::path& picture : outputs.pictures.back()) require_writable(picture);
  }
  require_writable(outputs.solution);
  require_writable(report_file);

  const Job job{arguments, scene, outputs, {console, report}};
  const SolvedScene solved = solved_scene(job);
  render_pictures(job, solved);
  report.add_file(report_file);
  report.write(report_file);
  report.print();
  return exit_code(solved.solution);
}

}  // namespace

Action add_run(CLI::App& command) {
  const auto arguments = std::make_shared<RunArguments>();
  command.description(
      "Solves a scene and renders its cameras: solution.vtp, .exr and .png files, report.json.");
  command
      .add_option("scene", arguments->scene,
                  "scene file: .toml, .obj, .ply, .stl, .gltf, .glb, .xml, .rad, .rif, .vs3")
      ->required()
      ->type_name("SCENE");
  command.add_option("-o,--output", arguments->output, "folder for the results (SCENE-output)")
      ->type_name("DIR");
  arguments->solve.add_to(command);
  arguments->checkpoint.add_to(command, CheckpointArguments::HelpOn::first);
  arguments->checkpoint.pictures_follow = true;
  arguments->checkpoint.add_reuse_to(command, CheckpointArguments::HelpOn::first);
  arguments->render.add_to(command);
  // Hidden, as rarely needed beside --quality; 'render --help' shows them.
  for (const char* name : {"--depth", "--photons", "--samples"}) {
    command.get_option(name)->group("");
  }
  arguments->render.film.add_to(command, "How pictures are made", FilmArguments::HelpOn::hidden);
  command.footer("Example: lightwell run cornell/cornell.toml -o cornell-results --size 1024x1024");
  return [arguments](Console& console) { return run(*arguments, console); };
}

}  // namespace lightwell
