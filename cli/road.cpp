#include <fmt/format.h>

#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "scene/errors.h"
#include "viewer/report/make_report.h"
#include "viewer/report/road_report.h"

namespace lightwell {
namespace {

struct RoadArguments {
  std::string road;
  std::vector<std::string> outputs;
  bool finds_spacing = false;
};

int light_road(const RoadArguments& arguments, Console& console) {
  Report report(console.options());
  note_input(arguments.road);
  for (const std::string& file : arguments.outputs) require_report_file(file);
  RoadReport made{.road = read_road(arguments.road), .version = LIGHTWELL_VERSION};
  for (const std::string& note : luminaire_notes(*made.road.luminaires.file)) {
    console.say("note: " + note);
  }
  for (const std::string& file : arguments.outputs) require_writable(file);
  const Stopwatch watch;
  if (arguments.finds_spacing) {
    made.spacings = spacings_that_meet(made.road, console.progress());
    made.has_search = true;
    if (!made.spacings.empty()) made.road.luminaires.spacing = made.spacings.back().greatest;
  }
  made.figures = road_figures(made.road);
  console.finish_phase();
  stop_if_interrupted();
  report.add_phase("road", watch.seconds());
  const Json figures = road_json(made);
  for (const auto& [key, value] : figures.items()) report.add(key, value);
  for (const std::filesystem::path file : arguments.outputs) {
    write_road_report(file, made);
    report.add_file(file);
  }
  if (!console.options().json) fmt::print("{}", road_text(made));
  report.print();
  const bool is_found = !made.has_search || !made.spacings.empty();
  return is_found ? exit_done : exit_not_accurate;
}

}  // namespace

Action add_road(CLI::App& command) {
  const auto arguments = std::make_shared<RoadArguments>();
  command.description(
      "Computes the light of a straight road by EN 13201-3 and holds it to classes of EN 13201-2:\n"
      "luminance, uniformities, threshold increment, edge ratio, illuminance of footways.\n"
      "Exit code 4: with --max-spacing, no spacing meets the classes.");
  command.add_option("road", arguments->road, "road, luminaires and classes, .toml (docs/road.md)")
      ->required()
      ->type_name("ROAD")
      ->check(with_extension({".toml"}));
  command
      .add_option("-o,--output", arguments->outputs,
                  ".pdf, .html (a page to print) or .json (all figures); may be repeated")
      ->type_name("FILE")
      ->type_size(1)
      ->allow_extra_args(false)
      ->check(with_extension({".pdf", ".html", ".json"}));
  command.add_flag("--max-spacing", arguments->finds_spacing,
                   "find the greatest spacing that meets all classes, in steps of 0.1 m, and\n"
                   "report the road with that spacing");
  command.footer("Example: lightwell road examples/road/street.toml --max-spacing -o street.html");
  return [arguments](Console& console) { return light_road(*arguments, console); };
}

}  // namespace lightwell
