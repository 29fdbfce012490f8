#include <fmt/format.h>

#include <memory>
#include <stdexcept>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/lux_range.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "cli/steps.h"
#include "scene/errors.h"
#ifdef LIGHTWELL_VIEWER
#include "viewer/view.h"
#endif

namespace lightwell {
namespace {

struct Arguments {
  std::string scene, solution, camera, offscreen, overlay, false_colour;
  std::optional<LuxRange> range;
  std::optional<std::pair<int, int>> size;
  double exposure_ev = 0.0;
};

#ifdef LIGHTWELL_VIEWER
int view(const Arguments& arguments, Console& console) {
  Report report(console.options());
  const Scene scene = read_scene_step(arguments.scene, console, report);
  ViewOptions options{
      .cameras = scene.cameras, .exposure_ev = arguments.exposure_ev, .materials = scene.materials};
  options.mesh = !arguments.overlay.empty();
  options.illuminance = arguments.false_colour == "lux";
  options.interpolation_error = arguments.false_colour == "error";
  options.lux_range = arguments.range;
  options.relative_units = scene.relative_units;
  if (!arguments.camera.empty()) options.camera = choose_camera(scene, arguments.camera);
  // Off screen, the picture that 'render' would make; a window is as large as suits a screen.
  if (!arguments.offscreen.empty() && !scene.cameras.empty()) {
    const Camera& camera = options.camera ? *options.camera : scene.cameras.front();
    std::tie(options.width, options.height) = std::pair(camera.width, camera.height);
  }
  if (arguments.size) std::tie(options.width, options.height) = *arguments.size;
  if (!arguments.offscreen.empty()) require_writable(arguments.offscreen);
  const SolvedScene solved = read_solution_step(arguments.solution, scene, console, report);
  if (options.interpolation_error && solved.solution.interpolation_error.size() == 0) {
    throw InputError(fmt::format(
        "{}: it was not refined, so there is no error of interpolation to show; solve it without "
        "'--refine off'",
        arguments.solution));
  }
  if (arguments.offscreen.empty()) {
    show_window(solved, options);
    return exit_done;
  }
  const Stopwatch watch;
  write_snapshot(solved, options, arguments.offscreen);
  report.add_phase("draw", watch.seconds());
  report.add_file(arguments.offscreen);
  report.print();
  return exit_done;
}
#else
int view(const Arguments&, Console&) {
  throw std::runtime_error(
      "this lightwell was built without its viewer; build it with -DLIGHTWELL_VIEWER=ON, or use "
      "'lightwell render'");
}
#endif

}  // namespace

Action add_view(CLI::App& command) {
  const auto arguments = std::make_shared<Arguments>();
  command.description(
      "Walk through a solved scene in a window: W A S D or arrows to walk, the mouse to look\n"
      "around, 1 to 9 for the scene's cameras, H for all keys, Escape to leave.");
  add_solved_scene(command, arguments->scene, arguments->solution);
  command
      .add_option("--offscreen", arguments->offscreen, "draw into this .png instead of a window")
      ->type_name("FILE")
      ->check(with_extension({".png"}));
  command.add_option("--camera", arguments->camera, "where to start (default: the first camera)")
      ->type_name("NAME");
  add_size(command, arguments->size);
  add_exposure(command, arguments->exposure_ev);
  command
      .add_option("--overlay", arguments->overlay,
                  "mesh: begin with the outlines of the elements (key M)")
      ->type_name("WHAT")
      ->check(one_of("overlay", {"mesh"}));
  auto* const false_colour =
      command
          .add_option("--false-colour,--false-color", arguments->false_colour,
                      "begin in false colours: lux (key V), or error, what interpolation was "
                      "estimated to miss, 0.1 % to 10 %")
          ->type_name("WHAT")
          ->check(one_of("quantity", {"lux", "error"}));
  add_lux_range(command, arguments->range)->needs(false_colour);
  command.footer("Example: lightwell view cornell/cornell.toml cornell.vtp");
  return [arguments](Console& console) { return view(*arguments, console); };
}

}  // namespace lightwell
