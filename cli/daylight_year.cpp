#include "cli/daylight_year.h"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <utility>

#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "daylight/year_files.h"
#include "viewer/report/year_study.h"
#include "viewer/report/year_walk.h"

namespace lightwell {
namespace {

// The files that the command will write into its folder.
std::vector<std::filesystem::path> files_of(const DaylightArguments& arguments,
                                            const DaylightStudy& study) {
  std::vector<std::filesystem::path> files = year_files(study);
  if (arguments.hourly) files.insert(files.end(), {"illuminance.npy", "sunlight.npy"});
  return files;
}

// The folders of the files, which are checked before the work.
class YearFolders {
 public:
  YearFolders(const DaylightArguments& arguments, std::span<const std::filesystem::path> files) {
    const std::filesystem::path folder = arguments.output;
    for (const std::filesystem::path& file : files) {
      folders_.push_back(std::make_unique<OutputFolder>((folder / file).parent_path()));
      require_writable(folder / file);
      require_different({arguments.walk, folder / file});
    }
    if (!arguments.walk.empty()) require_writable(arguments.walk);
  }

 private:
  std::vector<std::unique_ptr<OutputFolder>> folders_{};
};

void add_figures(const YearReport& made, Report& report) {
  const Json figures = year_json(made);
  for (const char* key : {"relative_error", "rooms", "ratings", "windows", "method",
                          "superposition_error", "states", "glare", "exposure_to_sunlight"}) {
    if (figures.contains(key)) report.add(key, figures[key]);
  }
}

// Writes the page of --walk, where it is asked for. An interrupt leaves the year, which is written,
// and no page: false.
bool walk_through(const DaylightArguments& arguments, const DaylightStudy& study,
                  const StudiedModel& of, const StudiedYear& year, Feedback feedback) {
  auto& [console, report] = feedback;
  const std::string& page = arguments.walk;
  if (page.empty()) return true;
  if (!study.windows.groups.empty()) {
    console.say("note: '" + page + "' shows all windows in their first states");
  }
  Stopwatch watch;
  bool is_whole = true;
  try {
    const WrittenWalk written = write_walk(page, study, of, year);
    report.add_file(page);
    report.add("walk", {{"vertices", written.vertices},
                        {"terms", written.terms},
                        {"relative_error", written.error},
                        {"bytes", std::filesystem::file_size(page)}});
  } catch (const Interrupted&) {
    is_whole = false;
  }
  console.finish_phase();
  if (!is_whole) {
    console.say("warning: interrupted; the files of the year are in '" + arguments.output +
                "', and the page '" + page + "' is not written");
  }
  report.add_phase("walk", watch.lap());
  return is_whole;
}

}  // namespace

int daylight_of_year(const DaylightArguments& arguments, const DaylightStudy& study,
                     Console& console, Report& report) {
  std::vector<SkyHour> hours = sky_hours(study.weather, study.up, study.north);
  for (const std::string& note : weather_notes(study.weather, hours)) console.say("note: " + note);
  require_light(study.weather, hours);
  const std::vector<std::filesystem::path> names = files_of(arguments, study);
  const YearFolders folders(arguments, names);

  Stopwatch watch;
  if (!arguments.walk.empty()) check_walk(study, hours);
  const StudiedModel of = model_of_year(study, console.progress());
  const auto sensors = static_cast<int>(of.sensors.probes.size());
  report.add_phase("sky", watch.lap());
  std::optional<HourlyFiles> files;
  if (arguments.hourly) files.emplace(arguments.output, sensors);
  const StudiedYear year = study_year(study, of, std::move(hours), [&](const HourBlock& block) {
    if (files) files->append(block);
  });
  console.finish_phase();
  stop_if_interrupted();
  if (is_dark(year.report)) console.say("warning: " + year.report.notes.back());
  report.add_phase("year", watch.lap());

  write_year(arguments.output, study, year);
  if (files) files->commit();
  for (const std::filesystem::path& file : names)
    report.add_file(std::filesystem::path(arguments.output) / file);
  const bool is_whole = walk_through(arguments, study, of, year, {console, report});
  report.add("patches", of.model->mesh().patch_count());
  report.add("sensors", sensors);
  report.add("hours_with_light", year.hours.size());
  add_figures(year.report, report);
  if (!console.options().json && !console.options().quiet) fmt::print("{}", year_text(year.report));
  report.print();
  return is_whole ? exit_done : exit_not_accurate;
}

}  // namespace lightwell
