#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/grid_arguments.h"
#include "cli/interrupt.h"
#include "cli/lux_range.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "cli/steps.h"
#include "scene/errors.h"
#include "scene/io/text_file.h"
#include "viewer/report/figures.h"
#include "viewer/report/make_report.h"

namespace lightwell {
namespace {

struct LightingArguments {
  std::string scene, solution;
  std::vector<std::string> outputs, observers;
  GridArguments grids;
  std::vector<NamedNumber> watts;
  std::optional<double> maintenance_factor;
  std::string areas, activity, activities, sports, colours;
  int rays = 1024;
  std::optional<LuxRange> range;
  std::string picture;  // camera; empty: the first; no_picture: none
  Language language = Language::english;
};

constexpr const char* no_picture = "none";

Language parse_language(const std::string& code) {
  if (const auto language = language_of(code)) return *language;
  throw CLI::ValidationError(
      "--language", fmt::format("'{}' is no language of reports; write en, de, fr or es", code));
}

bool needs_picture(const LightingArguments& arguments) {
  return arguments.picture != no_picture &&
         std::ranges::any_of(arguments.outputs, [](const std::string& file) {
           return lower_extension(file) == ".html" || lower_extension(file) == ".pdf";
         });
}

ReportRequest request_of(const LightingArguments& arguments, const Scene& scene) {
  ReportRequest request{.grids = arguments.grids.in_metres(scene),
                        .observers = arguments.observers,
                        .watts = arguments.watts,
                        .maintenance_factor = arguments.maintenance_factor,
                        .areas = arguments.areas,
                        .activity = arguments.activity,
                        .activities = arguments.activities,
                        .sports = arguments.sports,
                        .colours = arguments.colours,
                        .rays = arguments.rays,
                        .has_picture = needs_picture(arguments)};
  if (arguments.picture != no_picture) request.camera = arguments.picture;
  return request;
}

int report_lighting(const LightingArguments& arguments, Console& console) {
  Report report(console.options());
  for (const std::string& file : arguments.outputs) require_report_file(file);
  CleanUpReport clean_up;
  const Scene scene = read_scene_step(arguments.scene, console, report, &clean_up);
  const ReportPlan plan = plan_report(scene, request_of(arguments, scene));
  for (const std::string& file : arguments.outputs) require_writable(file);
  if (plan.is_empty()) {
    throw InputError(
        "there is nothing to report; name surfaces with '--surface floor', planes above surfaces "
        "with '--plane floor@0.75' or as [[grids]] in the scene file, or observers with "
        "'--observer CAMERA'");
  }
  SolvedScene solved = read_solution_step(arguments.solution, scene, console, report);
  const Stopwatch watch;
  const LightingReport made =
      make_report(plan, {scene, clean_up.names.get()}, solved, console.progress());
  console.finish_phase();
  stop_if_interrupted();
  report.add_phase("measure", watch.seconds());
  const Json figures = figures_json(made);
  for (const auto& [key, value] : figures.items()) report.add(key, value);
  for (const std::filesystem::path file : arguments.outputs) {
    write_report(file, made, arguments.range, arguments.language);
    report.add_file(file);
  }
  if (!console.options().json) fmt::print("{}", figures_text(made));
  report.print();
  return exit_done;
}

// Options of what standards ask for, and of their tables.
void add_standards(CLI::App& command, LightingArguments& arguments) {
  command
      .add_option("--activity", arguments.activity,
                  "hold all working planes to EN 12464-1 for this activity: writing, corridor, ...")
      ->type_name("KEY");
  command
      .add_option(
          "--areas", arguments.areas,
          "grids and areas of EN 12464-1, EN 1838 and EN 12193, in place of the scene file's")
      ->type_name("FILE.toml");
  command
      .add_option("--activities", arguments.activities,
                  "table of activities in place of the program's")
      ->type_name("FILE.toml");
  command
      .add_option("--sports", arguments.sports,
                  "table of sports and classes in place of the program's")
      ->type_name("FILE.toml");
  command
      .add_option("--colour-samples", arguments.colours,
                  "the 99 samples of TM-30, for R_f and R_g of observers (docs/standards.md)")
      ->type_name("FILE.csv");
}

}  // namespace

Action add_report(CLI::App& command) {
  const auto arguments = std::make_shared<LightingArguments>();
  command.description(
      "Reports a lighting design: mean and least illuminance and uniformity of surfaces and "
      "working\nplanes, glare (UGR) of observers, the luminaires; as PDF, a page, JSON or CSV.");
  command.add_option("scene", arguments->scene, "the scene file")->required()->type_name("SCENE");
  command.add_option("solution", arguments->solution, "the scene's solution, .vtp")
      ->required()
      ->type_name("SOLUTION");
  command
      .add_option("-o,--output", arguments->outputs,
                  ".pdf, .html (a page to print), .json (all figures) or .csv (every point); "
                  "may be repeated")
      ->type_name("FILE")
      ->type_size(1)
      ->allow_extra_args(false)
      ->check(with_extension({".pdf", ".html", ".json", ".csv"}));
  arguments->grids.add_to(command);
  constexpr double least_factor = 1e-6;
  command
      .add_option(
          "--maintenance", arguments->maintenance_factor,
          "maintenance factor of electric light, above 0 up to 1 (default: the scene file's, or "
          "1)")
      ->type_name("FACTOR")
      ->check(number_within(least_factor, 1.0, "a factor"));
  command
      .add_option("--observer", arguments->observers,
                  "camera for whose eye UGR is computed; may be repeated")
      ->type_name("CAMERA")
      ->type_size(1)
      ->allow_extra_args(false);
  add_standards(command, *arguments);
  add_watts(command, arguments->watts);
  command
      .add_option("--rays", arguments->rays, "gather rays per point, a power of two (default 1024)")
      ->type_name("N")
      ->check(power_of_two());
  add_lux_range(command, arguments->range);
  command
      .add_option("--picture", arguments->picture,
                  "camera of the picture on the page (default: the first), or none")
      ->type_name("CAMERA");
  command
      .add_option_function<std::string>(
          "--language",
          [arguments](const std::string& code) { arguments->language = parse_language(code); },
          "of .pdf and .html: en, de, fr or es (default en)")
      ->type_name("CODE");
  command.footer(
      "Example: lightwell report office.toml office.vtp --plane floor@0.75 --maintenance 0.8 "
      "--observer desk -o office.pdf");
  return [arguments](Console& console) { return report_lighting(*arguments, console); };
}

}  // namespace lightwell
