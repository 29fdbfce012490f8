#include "radiosity/solve.h"

#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "cli/several_processes.h"
#include "cli/steps.h"
#include "cli/time_limit.h"
#include "radiosity/solution/solution_file.h"
#include "scene/io/read_scene.h"

namespace lightwell {
namespace {

struct SolveCommandArguments {
  std::string scene, output;
  SolveArguments solve;
  CheckpointArguments checkpoint;
  double seconds = 0.0;  // 0: any time
};

int solve(const SolveCommandArguments& arguments, Console& console) {
  const TimeLimit time(arguments.seconds);
  Report report(console.options());
  const Scene scene = read_scene_step(arguments.scene, console, report);
  const EarlyEnd on_interrupt(console);
  console.show_time_left(time.seconds_left());
  const Provenance of = provenance(scene, arguments.solve);
  agree_on(of, time, console);
  const CheckpointArguments kept = of_first(arguments.checkpoint, console);
  if (console.is_first()) require_writable(arguments.output);
  const auto done = finished_solution(kept, of, arguments.output, console);
  if (answer_of_first(done.has_value(), console)) {
    if (!done) return exit_done;  // another process than the first
    report.add_solution(*done, false);
    report.print();
    return exit_code(done->solution);
  }
  Checkpoint checkpoint(kept, of, {arguments.output}, console);
  const SolvedScene solved =
      solve_step(scene, {arguments.solve, arguments.output, time}, checkpoint, {console, report});
  if (!console.is_first()) return exit_done;
  write_solution_step(arguments.output, solved, console, report);
  checkpoint.finish(report, solved.solution.outcome != Outcome::cut_short);
  report.print();
  return exit_code(solved.solution);
}

}  // namespace

Action add_solve(CLI::App& command) {
  const auto arguments = std::make_shared<SolveCommandArguments>();
  command.description("Meshes a scene, solves for the light on its surfaces, saves the solution.");
  add_scene(command, arguments->scene);
  command.add_option("-o,--output", arguments->output, "the solution, .vtp (opens in ParaView)")
      ->required()
      ->type_name("FILE")
      ->check(with_extension({".vtp"}));
  arguments->solve.add_to(command);
  command
      .add_option("--start-from", arguments->solve.start_from,
                  "a solution of the same geometry whose light the solver starts from")
      ->type_name("SOLUTION");
  arguments->checkpoint.add_to(command, CheckpointArguments::HelpOn::all);
  arguments->checkpoint.add_reuse_to(command, CheckpointArguments::HelpOn::all);
  add_time_limit(command, arguments->seconds, "How the light is solved");
  command.footer(
      "Example: lightwell solve cornell/cornell.toml -o cornell.vtp --max-patch-size 25");
  return [arguments](Console& console) { return solve(*arguments, console); };
}

}  // namespace lightwell
