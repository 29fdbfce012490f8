#include "radiosity/solution/relight.h"

#include <memory>

#include "cli/arguments.h"
#include "cli/channels.h"
#include "cli/commands.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "cli/steps.h"
#include "radiosity/solution/solution_file.h"

namespace lightwell {
namespace {

struct RelightArguments {
  std::string solution, output;
  ChannelSettings settings;
};

int relight_solution(const RelightArguments& arguments, Console& console) {
  Report report(console.options());
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

}  // namespace

Action add_relight(CLI::App& command) {
  const auto arguments = std::make_shared<RelightArguments>();
  command.description(
      "Dims and recolours the channels of a solution, without solving. Settings are relative\n"
      "to the scene as solved; channels that are not named keep their settings.");
  command.add_option("solution", arguments->solution, "a solution made with --channels, .vtp")
      ->required()
      ->type_name("SOLUTION");
  add_channel_settings(command, arguments->settings);
  command.get_option("--channel")->required();
  command.add_option("-o,--output", arguments->output, "the relit solution, .vtp")
      ->required()
      ->type_name("FILE")
      ->check(with_extension({".vtp"}));
  command.footer(
      "Example: lightwell relight room.vtp --channel desk=0.3 --channel ceiling=1,#ffd9b0 \\\n"
      "           --channel window=off -o evening.vtp");
  return [arguments](Console& console) { return relight_solution(*arguments, console); };
}

}  // namespace lightwell
