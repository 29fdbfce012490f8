#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/daylight_year.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "viewer/report/year_study.h"

namespace lightwell {

int daylight_of_instant(const DaylightArguments& arguments, const DaylightStudy& study,
                        Console& console, Report& report) {
  for (const std::string& note : study.weather.notes) console.say("note: " + note);
  const SkyHour sky = sky_of_instant(study, *arguments.at, arguments.at_text);
  const OutputFolder folder(arguments.output);
  for (const std::filesystem::path& file : instant_files()) require_writable(folder / file);

  Stopwatch watch;
  const StudiedModel of = model_of_instants(study, console.progress());
  const InstantReport made = study_instant(study, of, sky, arguments.at_text);
  console.finish_phase();
  stop_if_interrupted();
  report.add_phase("instant", watch.lap());

  write_instant_files(arguments.output, of.sensors.probes, made);
  for (const std::filesystem::path& file : instant_files()) report.add_file(folder / file);
  report.add("patches", of.model->mesh().patch_count());
  report.add("sensors", of.sensors.probes.size());
  const Json figures = instant_json(made);
  for (const auto& [key, value] : figures.items()) report.add(key, value);
  if (!console.options().json && !console.options().quiet) fmt::print("{}", instant_text(made));
  report.print();
  return exit_done;
}

}  // namespace lightwell
