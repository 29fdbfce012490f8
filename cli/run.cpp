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

// What `output` holds already, if it was asked to go on with that; else solved and written now.
SolvedScene solved_scene(const Scene& scene, const RunArguments& arguments, const fs::path& output,
                         Console& console, Report& report) {
  const Provenance of = provenance(scene, arguments.solve);
  if (auto done = finished_solution(arguments.checkpoint, of, output, console, true)) {
    attach_textures(scene, done->mesh);
    report.add_solution(*done, false);
    return std::move(*done);
  }
  Checkpoint checkpoint(arguments.checkpoint, of, {output}, console);
  SolvedScene solved = solve_step(scene, arguments.solve, output, checkpoint, console, report);
  write_solution_step(output, solved, console, report);
  checkpoint.finish(report);
  return solved;
}

struct Outputs {
  fs::path solution{};
  std::vector<std::vector<fs::path>> pictures{};  // of each camera
};

void render_pictures(const Scene& scene, const SolvedScene& solved, const RunArguments& arguments,
                     const Outputs& outputs, Console& console, Report& report) {
  CheckpointArguments kept = arguments.checkpoint;
  kept.reuse.clear();
  if (kept.keep) kept.file.clear();                    // there is the solve in it
  kept.resume = kept.resume && fs::exists(kept.file);  // pictures need not have been begun
  std::vector<fs::path> files = {outputs.solution};
  for (const auto& each : outputs.pictures) files.insert(files.end(), each.begin(), each.end());
  Checkpoint checkpoint(kept, picture_provenance(scene, solved.solution, arguments.render), files,
                        console);
  SceneRenderer renderer(scene, solved.mesh, solved.solution);
  try {
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
      render_step(scene, solved, renderer, scene.cameras[i], arguments.render, outputs.pictures[i],
                  checkpoint, console, report);
    }
  } catch (const InterruptedWith&) {
    throw;
  } catch (const Interrupted&) {
    if (arguments.checkpoint.file.empty()) throw;
    throw InterruptedWith(
        fmt::format("interrupted; the light is solved, in '{}'. To go on with the pictures:\n  {}",
                    outputs.solution.string(), command_to_resume(console.options())));
  }
  checkpoint.finish(report, "picture_checkpoint");
}

int run(const RunArguments& arguments, Console& console) {
  Report report(console.options());
  const Scene scene = read_scene_step(arguments.scene, console, report);
  choose_camera(scene, "");  // to refuse before the work, not after it
  const OutputFolder folder(arguments.output.empty() ? default_folder(arguments.scene)
                                                     : fs::path(arguments.output));
  const fs::path solution_file = folder / "solution.vtp", report_file = folder / "report.json";
  std::vector<std::vector<fs::path>> pictures;
  for (const Camera& camera : scene.cameras) {
    pictures.push_back({folder / (camera.name + ".exr"), folder / (camera.name + ".png")});
    arguments.render.film.check(scene, pictures.back());
    static_cast<void>(CameraRays(arguments.render.sized(camera)));  // throws if it cannot be
    for (const fs::path& picture : pictures.back()) require_writable(picture);
  }
  require_writable(solution_file);
  require_writable(report_file);

  const SolvedScene solved = solved_scene(scene, arguments, solution_file, console, report);
  render_pictures(scene, solved, arguments, {solution_file, pictures}, console, report);
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
  arguments->checkpoint.add_reuse_to(command, CheckpointArguments::HelpOn::first);
  arguments->render.add_to(command);
  command.get_option("--depth")->group("");  // rarely asked for: 'render --help' shows it
  arguments->render.film.add_to(command, "How pictures are made", FilmArguments::HelpOn::hidden);
  command.footer("Example: lightwell run cornell/cornell.toml -o cornell-results --size 1024x1024");
  return [arguments](Console& console) { return run(*arguments, console); };
}

}  // namespace lightwell
