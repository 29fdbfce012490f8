#include "viewer/export.h"

#include <fmt/format.h>

#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/lux_range.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "cli/steps.h"
#include "radiosity/solution_file.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

struct Arguments {
  std::string solution, scene;
  std::vector<std::string> outputs;
  double exposure_ev = 0.0;
  std::optional<LuxRange> range;
};

SolvedScene read_alone(const std::string& file, Console& console, Report& report) {
  const Stopwatch watch;
  SolvedScene solved = read_solution(file);
  report.add_solution(solved, false);
  report.add("light", light_name(solved.solution.relative_units));
  report.add_phase("read_solution", watch.seconds());
  console.say(
      "note: a solution alone names no surfaces, cameras, mirrors or glass; '--scene SCENE' does.");
  return solved;
}

void require_all_writable(const std::vector<std::string>& files) {
  for (const std::filesystem::path file : files) {
    require_writable(file);
    if (lower_extension(file) == ".obj") {
      require_writable(std::filesystem::path(file).replace_extension(".mtl"));
    }
  }
}

void write_file(const std::filesystem::path& file, const BakedModel& model,
                const Arguments& arguments, Report& report) {
  const std::string kind = lower_extension(file);
  const Stopwatch watch;
  if (kind == ".glb") {
    write_gltf(file, model);
  } else if (kind == ".ply") {
    write_ply(file, model);
  } else if (kind == ".obj") {
    write_obj(file, model);
    report.add_file(std::filesystem::path(file).replace_extension(".mtl"));
  } else {
    write_walkthrough(file, model, arguments.range);
  }
  report.add_file(file);
  report.add_phase("write_" + kind.substr(1), watch.seconds());
}

int export_model(const Arguments& arguments, Console& console) {
  Report report(console.options());
  require_all_writable(arguments.outputs);
  Scene scene;
  if (!arguments.scene.empty()) scene = read_scene_step(arguments.scene, console, report);
  const SolvedScene solved = arguments.scene.empty()
                                 ? read_alone(arguments.solution, console, report)
                                 : read_solution_step(arguments.solution, scene, console, report);
  const Stopwatch watch;
  const BakedModel model = bake_model(solved, scene, arguments.exposure_ev);
  report.add("exported", {{"vertices", model.vertex_count()},
                          {"faces", model.face_count()},
                          {"parts", model.parts.size()}});
  report.add_phase("bake", watch.seconds());
  stop_if_interrupted();
  for (const std::string& file : arguments.outputs) {
    write_file(file, model, arguments, report);
    stop_if_interrupted();
  }
  report.print();
  return exit_done;
}

}  // namespace

Action add_export(CLI::App& command) {
  const auto arguments = std::make_shared<Arguments>();
  command.description(
      "Writes a solution as a model with its light in the colours of its vertices, or as a page\n"
      "to walk through in a web browser.");
  command.add_option("solution", arguments->solution, "solution file (.vtp)")
      ->required()
      ->type_name("SOLUTION");
  command
      .add_option("-o,--output", arguments->outputs,
                  ".html (page), .glb (glTF), .ply or .obj; may be repeated")
      ->required()
      ->type_name("FILE")
      ->type_size(1)
      ->allow_extra_args(false)
      ->check(with_extension({".glb", ".ply", ".obj", ".html"}));
  command
      .add_option("--scene", arguments->scene,
                  "the scene it was made from: names, cameras, mirrors and glass")
      ->type_name("SCENE");
  add_exposure(command, arguments->exposure_ev);
  add_lux_range(command, arguments->range);
  command.footer(
      "Example: lightwell export cornell.vtp --scene cornell/cornell.toml -o cornell.html");
  return [arguments](Console& console) { return export_model(*arguments, console); };
}

}  // namespace lightwell
