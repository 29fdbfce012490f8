#include <fmt/format.h>

#include <memory>

#include "cli/arguments.h"
#include "cli/checkpoint.h"
#include "cli/commands.h"
#include "cli/grid_arguments.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "cli/steps.h"
#include "cli/time_limit.h"
#include "design/design_lighting.h"
#include "design/move_luminaires.h"
#include "design/moved_scene.h"
#include "design/plan_files.h"
#include "scene/errors.h"
#include "scene/io/text_file.h"
#include "viewer/export/write_whole.h"

namespace lightwell {
namespace fs = std::filesystem;
namespace {

struct DesignArguments {
  std::string scene, solution, limits, output;
  std::vector<NamedNumber> watts;
  int rays = 1024;
  SolveArguments solve;
};

/// Files of a design in its folder.
struct DesignFiles {
  fs::path levels, figures, page, solution;
  fs::path places, scene;  // empty: luminaires are not moved
};

DesignFiles files_of(const fs::path& folder, const DesignTask& task) {
  DesignFiles files{.levels = folder / "levels.csv",
                    .figures = folder / "design.json",
                    .page = folder / "design.html",
                    .solution = folder / "solution.vtp"};
  if (!task.places.moved.empty()) {
    files.places = folder / "places.csv";
    files.scene = folder / "moved.toml";
  }
  for (const fs::path& file :
       {files.levels, files.figures, files.page, files.solution, files.places, files.scene}) {
    if (!file.empty()) require_writable(file);
  }
  return files;
}

// Solves the scene with a channel for each luminaire or group.
SolvedScene solved_in_channels(const DesignArguments& arguments, const DesignTask& task,
                               const Scene& scene, const fs::path& output,
                               const Feedback& feedback) {
  SolveArguments solve = arguments.solve;
  solve.channels.fixed = dimming_channels(scene, task.request.limits.groups);
  Checkpoint none({}, provenance(scene, solve), {output}, feedback.console);
  SolvedScene solved = solve_step(scene, {solve, output, TimeLimit(0.0)}, none, feedback);
  solved.solution.provenance.options += " (a channel for each luminaire or group, by 'design')";
  return solved;
}

// Reads the given solution, whose channels the design dims.
SolvedScene given_solution(const DesignArguments& arguments, const DesignTask& task,
                           const Scene& scene, const Feedback& feedback) {
  const LightingLimits& limits = task.request.limits;
  SolvedScene solved =
      read_solution_step(arguments.solution, scene, feedback.console, feedback.report);
  if (solved.solution.channels.empty()) {
    throw InputError(fmt::format(
        "{}: the solution keeps no light apart, so nothing can be dimmed; solve with --channels "
        "per-luminaire, or leave the solution out",
        arguments.solution));
  }
  if (!limits.groups.empty()) {
    throw InputError(fmt::format(
        "{} cannot be formed, since a given solution has its channels; leave the solution or the "
        "groups out",
        limits.groups.front().origin));
  }
  if (!limits.moves.empty()) {
    throw InputError(fmt::format(
        "{} cannot be followed, since a given solution has the luminaires in its places; leave the "
        "solution or the [[move]] tables out",
        limits.moves.front().origin));
  }
  return solved;
}

// The design of a scene, whose luminaires are moved if the task has places for them.
MovedDesign designed(const DesignArguments& arguments, const DesignTask& task,
                     const ReportedScene& of, const fs::path& output, const Feedback& feedback) {
  Console& console = feedback.console;
  const Stopwatch all;
  double solving = 0.0;
  const auto solve = [&](const Scene& scene) {
    const Stopwatch watch;
    SolvedScene solved = arguments.solution.empty()
                             ? solved_in_channels(arguments, task, scene, output, feedback)
                             : given_solution(arguments, task, scene, feedback);
    stop_if_interrupted();
    solving += watch.seconds();
    return solved;
  };
  MovedDesign made;
  if (!task.places.moved.empty()) {
    made = move_luminaires(task, of, solve, console.progress());
  } else {
    made = {.scene = of.scene, .solved = solve(of.scene)};
    made.plan = design_lighting(task, of, made.solved, console.progress());
  }
  console.finish_phase();
  stop_if_interrupted();
  feedback.report.add_phase("design", all.seconds() - solving);
  return made;
}

// Writes where luminaires were moved to: a table, and a copy of a scene in the native format.
void write_places(const DesignFiles& files, MovedDesign& made, const Feedback& feedback) {
  if (files.places.empty()) return;
  write_whole(files.places, {places_csv(made.plan, made.scene.metres_per_unit)});
  feedback.report.add_file(files.places);
  const auto text = moved_scene_text(made.scene, files.scene.parent_path());
  if (!text) {
    made.plan.notes.emplace_back(
        "only scenes in the native format are written anew with luminaires in other places; the "
        "solution is that of the places in places.csv");
    return;
  }
  write_whole(files.scene, {*text});
  feedback.report.add_file(files.scene);
  made.solved.solution.provenance.scene_file = files.scene.string();
}

int design(const DesignArguments& arguments, Console& console) {
  Report report(console.options());
  CleanUpReport clean_up;
  note_input(arguments.limits);
  LightingLimits limits = read_limits(arguments.limits);
  const Scene scene = read_scene_step(arguments.scene, console, report, &clean_up);
  const DesignTask task = plan_design(
      scene, {.limits = std::move(limits), .watts = arguments.watts, .rays = arguments.rays});
  if (arguments.solution.empty()) {
    static_cast<void>(
        dimming_channels(scene, task.request.limits.groups));  // throws before the work
  }
  const OutputFolder folder(arguments.output);
  const DesignFiles files = files_of(folder / "", task);
  MovedDesign made =
      designed(arguments, task, {scene, clean_up.names.get()}, files.solution, {console, report});
  write_places(files, made, {console, report});
  const auto& [moved, solved, plan] = made;
  for (const std::string& note : plan.notes) console.say("note: " + note);
  report.add_solution(solved, false);
  write_solution_step(files.solution, solved, console, report);
  write_whole(files.levels, {levels_csv(plan, scene.metres_per_unit)});
  report.add_file(files.levels);
  write_whole(files.page, {plan_page(plan, moved)});
  report.add_file(files.page);
  const Json figures = plan_json(plan, scene.metres_per_unit);
  for (const auto& [key, value] : figures.items()) report.add(key, value);
  report.add_file(files.figures);
  report.write(files.figures);
  if (!console.options().json && !console.options().quiet)
    fmt::print("{}", plan_text(plan, scene.metres_per_unit));
  report.print();
  return plan.meets_all() ? exit_code(solved.solution) : exit_not_accurate;
}

// Options of the solve that --help of 'solve' explains.
void hide_rare_options(CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group() != "Options") {
      command.get_option(option->get_name())->group("");
    }
  }
  for (const char* const usual : {"--accuracy", "--max-patch-size", "--memory"}) {
    command.get_option(usual)->group("How the light is solved");
  }
}

}  // namespace

Action add_design(CLI::App& command) {
  const auto arguments = std::make_shared<DesignArguments>();
  command.description(
      "Finds the levels of luminaires that meet lighting limits with the least electric power:\n"
      "levels.csv, design.html, design.json, and the light at these levels. Lamps of [[move]] "
      "tables\n"
      "are moved to where they take less: places.csv, moved.toml. Other options of 'lightwell "
      "solve'\n"
      "work as there. Exit code 4: not all limits are met.");
  arguments->solve.add_to(command);
  command.remove_option(command.get_option("--channels"));
  hide_rare_options(command);
  add_scene(command, arguments->scene);
  command
      .add_option("solution", arguments->solution,
                  "its solution with channels, .vtp (default: the scene is solved)")
      ->type_name("SOLUTION");
  command
      .add_option("--limits", arguments->limits,
                  "limits of grids and observers, lamps to move, .toml (docs/design.md)")
      ->required()
      ->type_name("FILE")
      ->check(with_extension({".toml"}));
  command.add_option("-o,--output", arguments->output, "folder for the results")
      ->required()
      ->type_name("DIR");
  add_watts(command, arguments->watts);
  command
      .add_option("--grid-rays", arguments->rays,
                  "gather rays per point of a grid, a power of two (default 1024)")
      ->type_name("N")
      ->check(power_of_two());
  command.footer(
      "Example: lightwell design office.toml --limits limits.toml -o design --accuracy 2%");
  return [arguments](Console& console) { return design(*arguments, console); };
}

}  // namespace lightwell
