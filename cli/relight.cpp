#include "radiosity/solution/relight.h"

#include <fmt/format.h>

#include <memory>

#include "cli/arguments.h"
#include "cli/channels.h"
#include "cli/commands.h"
#include "cli/outputs.h"
#include "cli/relight_cues.h"
#include "cli/report.h"
#include "cli/steps.h"
#include "radiosity/solution/solution_file.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

struct RelightArguments {
  std::string solution, output, cues, scene, camera;
  std::vector<NamedSetting> settings;
  bool pictures = false;
  int frames = 0;  // of a film; 0: none
  RenderArguments render;
};

int relight_solution(const RelightArguments& arguments, Console& console) {
  Report report(console.options());
  if (!arguments.cues.empty()) {
    relight_by_cues({.solution = arguments.solution,
                     .cues = arguments.cues,
                     .folder = arguments.output,
                     .settings = arguments.settings,
                     .scene = arguments.scene,
                     .camera = arguments.camera,
                     .render = arguments.render,
                     .frames = arguments.frames},
                    {console, report});
    report.print();
    return exit_done;
  }
  require_writable(arguments.output);
  const Stopwatch reading;
  note_input(arguments.solution);
  SolvedScene solved = read_solution(arguments.solution);
  report.add_phase("read_solution", reading.seconds());
  const std::vector<Spectrum> scales =
      channel_scales(solved.solution, arguments.settings, arguments.solution);
  const Stopwatch watch;
  relight(solved, scales);
  report.add_phase("relight", watch.seconds());
  report.add_solution(solved, false);
  write_solution_step(arguments.output, solved, console, report);
  report.print();
  return exit_done;
}

void check(const CLI::App& command, const RelightArguments& arguments) {
  if (arguments.settings.empty() && arguments.cues.empty()) {
    throw CLI::ValidationError("relight", "needs --channel or --cues: what is to change, and how");
  }
  if (!arguments.cues.empty()) return;
  if (command.count("--pictures") > 0) {
    throw CLI::ValidationError("--pictures", "are of cues; add '--cues FILE', or use 'render'");
  }
  if (lower_extension(arguments.output) != ".vtp") {
    throw CLI::ValidationError(
        "--output", fmt::format("'{}' must end in .vtp; a folder is for --cues", arguments.output));
  }
}

// Options of the pictures of cues, of which --help shows the usual ones.
void add_pictures(CLI::App& command, RelightArguments& arguments) {
  const std::string group = "Pictures of cues";
  auto* const pictures = command
                             .add_flag("--pictures", arguments.pictures,
                                       "also a picture of each cue, .exr and .png, all .png with "
                                       "the same exposure")
                             ->group(group);
  auto* const scene =
      command.add_option("--scene", arguments.scene, "the solution's scene, for --pictures")
          ->type_name("SCENE")
          ->needs(pictures)
          ->group(group);
  pictures->needs(scene);
  command
      .add_option("--frames", arguments.frames,
                  "also a film of the fades of all cues: this many pictures, frame-0000.png ...")
      ->type_name("N")
      ->check(whole_number(1, 10000))
      ->needs(pictures)
      ->group(group);
  command.add_option("--camera", arguments.camera, "which camera (default: the first)")
      ->type_name("NAME")
      ->needs(pictures)
      ->group(group);
  const std::size_t before = command.get_options().size();
  arguments.render.add_to(command);
  arguments.render.film.add_to(command, group, FilmArguments::HelpOn::hidden);
  const std::vector<CLI::Option*> options = command.get_options();
  for (std::size_t i = before; i < options.size(); ++i) options[i]->needs(pictures)->group("");
  for (const char* const usual : {"--size", "--exposure", "--quality", "--pass"}) {
    command.get_option(usual)->group(group);
  }
}

}  // namespace

Action add_relight(CLI::App& command) {
  const auto arguments = std::make_shared<RelightArguments>();
  command.description(
      "Dims and recolours the channels of a solution, without solving, once or by the cues of a\n"
      "file. Settings are relative to the scene as solved; channels that are not named keep\n"
      "their settings.");
  command.add_option("solution", arguments->solution, "a solution made with --channels, .vtp")
      ->required()
      ->type_name("SOLUTION");
  add_channel_settings(command, arguments->settings);
  add_cues(command, arguments->cues,
           "lighting cues, .toml: named states of the channels, with their fades; --channel sets "
           "what is before the first");
  command
      .add_option("-o,--output", arguments->output,
                  "the relit solution, .vtp; with --cues a folder, for CUE.vtp of each")
      ->required()
      ->type_name("FILE");
  add_pictures(command, *arguments);
  command.callback([arguments, &command] { check(command, *arguments); });
  command.footer(
      "Example: lightwell relight room.vtp --channel desk=0.3 --channel 'row*=1,#ffd9b0' \\\n"
      "           --channel window=off -o evening.vtp\n"
      "         lightwell relight room.vtp --cues cues.toml -o cues --pictures --scene room.toml");
  return [arguments](Console& console) { return relight_solution(*arguments, console); };
}

}  // namespace lightwell
