#include "cli/daylight_year.h"

#include <fmt/format.h>

#include <memory>

#include "cli/commands.h"
#include "cli/daylight_count.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "daylight/glare_of_year.h"
#include "daylight/honeybee_metrics.h"
#include "daylight/operated_year.h"
#include "daylight/year_basis.h"
#include "daylight/year_files.h"
#include "raytrace/readings/probe_surface.h"
#include "viewer/export/write_whole.h"
#include "viewer/report/year_ratings.h"
#include "viewer/report/year_rooms.h"

namespace lightwell {
namespace {

// True where ratings or lamps are asked for, whose figures have a file of their own.
bool has_rooms_file(const DaylightArguments& arguments) {
  return !arguments.ratings.empty() || !arguments.rooms.empty();
}

// The files that the command will write.
std::vector<std::string> files_of(const DaylightArguments& arguments) {
  std::vector<std::string> files = {"sensors.csv", "hours.csv", "year.html", "year.json"};
  if (arguments.hourly) files.insert(files.end(), {"illuminance.npy", "sunlight.npy"});
  if (!arguments.observers.empty()) files.emplace_back("glare.csv");
  if (has_rooms_file(arguments)) files.emplace_back("rooms.csv");
  return files;
}

// Hours of each group of windows in its states.
std::vector<YearWindows> hours_in_states(const OperatedWindows& windows,
                                         const Eigen::ArrayXXi& states,
                                         std::span<const SkyHour> hours,
                                         const Occupancy& occupancy) {
  std::vector<YearWindows> all;
  for (std::size_t g = 0; g < windows.groups.size(); ++g) {
    const WindowGroup& group = windows.groups[g];
    YearWindows of_group{.name = group.name, .operation = operation_text(group)};
    for (const WindowState& state : group.states) of_group.states.push_back({.name = state.name});
    for (std::size_t h = 0; h < hours.size(); ++h) {
      const int state = states(static_cast<Eigen::Index>(g), static_cast<Eigen::Index>(h));
      YearWindows::State& in_state = of_group.states[static_cast<std::size_t>(state)];
      ++in_state.hours;
      if (occupancy.holds(hours[h].number)) ++in_state.occupied_hours;
    }
    all.push_back(std::move(of_group));
  }
  return all;
}

// Counts the year that is put together from the computations, with the bound of each hour.
void count_operated(const OperatedYear& year, std::span<const SkyHour> hours, YearCount& count,
                    GlareCount& glare) {
  std::ptrdiff_t first = 0;
  year.visit(hours, [&](const HourBlock& block) {
    const auto begin = year.hour_errors.begin() + first;
    first += static_cast<std::ptrdiff_t>(block.hours.size());
    count.add(block, {begin, year.hour_errors.begin() + first});
    glare.add_light(block);
  });
}

void require_writable_files(const DaylightArguments& arguments, const OutputFolder& folder) {
  for (const std::string& file : files_of(arguments)) {
    require_writable(folder / file);
    require_different({arguments.walk, folder / file});
  }
  if (!arguments.walk.empty()) require_writable(arguments.walk);
}

// Writes the page of --walk. An interrupt leaves the year, which is written, and no page: false.
bool finish_walk(const DaylightArguments& arguments, const DaylightInputs& inputs,
                 const WalkedYear& year, Feedback feedback) {
  try {
    write_walk(arguments, inputs, year, feedback.console, feedback.report);
  } catch (const Interrupted&) {
    feedback.console.finish_phase();
    feedback.console.say("warning: interrupted; the files of the year are in '" + arguments.output +
                         "', and the page '" + arguments.walk + "' is not written");
    return false;
  }
  return true;
}

void add_figures(const YearReport& made, Report& report) {
  const Json figures = year_json(made);
  for (const char* key : {"relative_error", "rooms", "ratings", "windows", "method",
                          "superposition_error", "states", "glare", "exposure_to_sunlight"}) {
    if (figures.contains(key)) report.add(key, figures[key]);
  }
}

// Goes through the year and fills in all measures. `files` may be null.
OperatedYear go_through_year(const DaylightInputs& inputs, const DaylightModel& model,
                             const OperationTask& task, HourlyFiles* files, YearReport& made) {
  const int sensors = model.sensor_count() - static_cast<int>(inputs.eyes.size());
  const bool is_operated = !inputs.windows.groups.empty();
  YearCount count(task.hours, sensors, files, made);
  OperatedCount operated(task.hours, sensors, made);
  GlareCount glare(inputs.eyes, sensors, task.hours, task.ground_reflectance);
  std::size_t computations = 0;
  const auto visit = [&](const ComputedYear& computed, const HourBlock& block) {
    if (computed.number == computations) {
      ++computations;
      if (!inputs.eyes.empty()) glare.add_computation(computed.model);
    }
    if (is_operated) return operated.add(computed, block);
    made.error = computed.error;
    count.add(block, std::vector<double>(block.hours.size(), computed.error));
    glare.add_light(block);
  };
  const OperatedYear year = operate_year(inputs.scene, model, inputs.windows, task, visit);
  made.daylight_factor = year.daylight_factor;
  if (is_operated) {
    made.error = year.error();
    count_operated(year, task.hours, count, glare);
    const Eigen::ArrayXd open_sun_hours = operated.open_sun_hours();
    count.finish(&open_sun_hours);
    made.windows = hours_in_states(inputs.windows, year.states, task.hours, made.occupancy);
    made.states = operated.years(year, inputs.windows);
    made.is_superposed = year.plan.is_superposed;
    made.superposition = year.superposition;
  } else {
    count.finish(nullptr);
  }
  for (const SkyHour& hour : task.hours) made.hour_numbers.push_back(hour.number);
  made.glare = glare.finish(year.plan, year.states, made.occupancy, occupied_hours_of(made));
  return year;
}

// Notes on the weather, said on the console too.
std::vector<std::string> weather_notes(const Weather& weather, const std::vector<SkyHour>& hours,
                                       Console& console) {
  std::vector<std::string> notes = weather.notes;
  const std::string dark = note_on_dark_hours(weather, hours);
  if (!dark.empty()) notes.push_back(dark);
  for (const std::string& note : notes) console.say("note: " + note);
  return notes;
}

std::vector<std::string> conventions_of_year(const DaylightArguments& arguments,
                                             const DaylightInputs& inputs, const SkyPatches& sky) {
  std::vector<std::string> sentences = {
      "An hour has the mean irradiances of the weather file; the sun stands where it is in the "
      "middle of the hour, standard time, without refraction (Michalsky 1988).",
      fmt::format("Dates are those of {}, since a typical year is put together from several.",
                  inputs.weather.is_leap_year ? "the leap year 2016" : "2017")};
  const std::vector<std::string> more = daylight_conventions(arguments, inputs, sky);
  sentences.insert(sentences.end(), more.begin(), more.end());
  return sentences;
}

void note_darkness(YearReport& made, Console& console) {
  if ((made.daylight_factor > 0.0f).any()) return;
  made.notes.emplace_back(
      "No daylight reaches any sensor: the scene has no opening, or its windows are opaque.");
  console.say("warning: " + made.notes.back());
}

// Sources of the files of a year.
struct WrittenYear {
  const OutputFolder& folder;
  const DaylightInputs& inputs;
  std::span<const SkyHour> hours{};
  std::span<const Probe> probes{};
  bool has_rooms = false;  // a file of them
};

constexpr const char* metrics_folder = "metrics";

// The sensor grids of a Honeybee model among the rooms.
std::vector<MetricGrid> metric_grids(const DaylightInputs& inputs, const YearReport& made) {
  std::vector<MetricGrid> grids;
  std::size_t next = 0;
  for (const YearRoom& room : made.rooms) {
    while (next < inputs.grids.size() && inputs.grids[next].positions.empty()) ++next;
    if (room.grid || next == inputs.grids.size() || room.name != inputs.grids[next].name) continue;
    grids.push_back({.name = room.name,
                     .group = inputs.grids[next].group,
                     .first = room.first,
                     .count = room.count});
    ++next;
  }
  return grids;
}

// The folders of the files of metric_grids(), which are checked before the work.
class MetricFolders {
 public:
  MetricFolders(const std::filesystem::path& folder, std::span<const SensorGrid> grids) {
    std::vector<MetricGrid> planned;
    for (const SensorGrid& grid : grids) {
      if (!grid.positions.empty()) planned.push_back({.name = grid.name, .group = grid.group});
    }
    if (planned.empty()) return;
    for (const std::filesystem::path& file : honeybee_metric_files(planned)) {
      folders_.push_back(std::make_unique<OutputFolder>((folder / file).parent_path()));
      require_writable(folder / file);
    }
  }

 private:
  std::vector<std::unique_ptr<OutputFolder>> folders_{};
};

void write_files(const WrittenYear& written, const YearReport& made, const OperatedYear& year) {
  const OutputFolder& folder = written.folder;
  const DaylightInputs& inputs = written.inputs;
  write_sensors(folder / "sensors.csv", written.probes, made.sensors, made.daylight_factor,
                inputs.scene.metres_per_unit);
  write_hours(folder / "hours.csv", {.hours = written.hours,
                                     .is_leap_year = inputs.weather.is_leap_year,
                                     .windows = inputs.windows,
                                     .states = year.states});
  if (!made.glare.empty()) write_glare(folder / "glare.csv", written.hours, made.glare);
  if (const auto grids = metric_grids(inputs, made); !grids.empty()) {
    write_honeybee_metrics(folder / metrics_folder, grids, made.sensors);
  }
  if (written.has_rooms) write_whole(folder / "rooms.csv", {rooms_csv(made)});
  write_whole(folder / "year.html", {year_page(made)});
  write_json(folder / "year.json", year_json(made));
}

// Refuses tables of rooms that do not fit the sensors, before form factors, which take long.
void check_rooms(const DaylightArguments& arguments, const DaylightInputs& inputs,
                 const DaylightOptions& options) {
  if (inputs.rooms.empty()) return;
  const PatchMesh mesh = build_patches(inputs.scene, options.mesh);
  std::vector<YearRoom> rooms = daylight_sensors(arguments, inputs, ElementCaster(mesh)).rooms;
  use_rooms(inputs.rooms, rooms);
  if (!inputs.ratings.empty()) require_occupied_rooms(rooms);
}

}  // namespace

int daylight_of_year(const DaylightArguments& arguments, const DaylightInputs& inputs,
                     Console& console, Report& report) {
  const Weather& weather = inputs.weather;
  const std::vector<SkyHour> hours = sky_hours(weather, inputs.up, inputs.north);
  YearReport made = daylight_report(arguments, inputs, weather_notes(weather, hours, console));
  const OutputFolder folder(arguments.output);
  require_writable_files(arguments, folder);
  const MetricFolders metric_folders(folder / metrics_folder, inputs.grids);

  Stopwatch watch;
  const DaylightOptions options = daylight_options(arguments, inputs.scene, console);
  // A page that is too large is refused before form factors, which take long.
  if (!arguments.walk.empty()) {
    constexpr int fewest_bands = 1;  // of a grey scene; find_year_basis() knows them
    check_year_basis(build_patches(inputs.scene, options.mesh), fewest_bands, hours);
  }
  check_rooms(arguments, inputs, options);
  DaylightModel model(inputs.scene, inputs.up, inputs.north, options);
  DaylightSensors sensors = daylight_sensors(arguments, inputs, model.caster());
  model.set_sensors(probe_points(model.caster(), sensors.all()));
  report.add_phase("sky", watch.lap());
  made.conventions = conventions_of_year(arguments, inputs, model.sky());
  const std::vector<SensorRange> ranges = sensors.ranges();
  made.rooms = std::move(sensors.rooms);
  use_rooms(inputs.rooms, made.rooms);
  std::optional<HourlyFiles> files;
  if (arguments.hourly) files.emplace(folder, static_cast<int>(sensors.probes.size()));
  const OperatedYear year = go_through_year(inputs, model,
                                            {.hours = hours,
                                             .is_leap_year = weather.is_leap_year,
                                             .ground_reflectance = arguments.ground,
                                             .rooms = ranges},
                                            files ? &*files : nullptr, made);
  note_darkness(made, console);
  if (!inputs.sun_points.empty()) {
    made.exposure =
        YearExposure{.day = arguments.sun_day,
                     .points = inputs.sun_points,
                     .hours = sun_exposure(model, weather, inputs.sun_points, arguments.sun_day)};
  }
  console.finish_phase();
  stop_if_interrupted();
  report.add_phase("year", watch.lap());

  write_files({.folder = folder,
               .inputs = inputs,
               .hours = hours,
               .probes = sensors.probes,
               .has_rooms = has_rooms_file(arguments)},
              made, year);
  if (files) files->commit();
  for (const std::string& file : files_of(arguments)) report.add_file(folder / file);
  if (const auto grids = metric_grids(inputs, made); !grids.empty()) {
    for (const std::filesystem::path& file : honeybee_metric_files(grids)) {
      report.add_file(folder / metrics_folder / file);
    }
  }
  bool is_whole = true;
  if (!arguments.walk.empty()) {
    const auto count = made.rooms.front().count;
    is_whole =
        finish_walk(arguments, inputs,
                    {.model = model,
                     .hours = hours,
                     .sensors = std::span(sensors.probes).first(static_cast<std::size_t>(count)),
                     .daylight_factor = made.daylight_factor.head(count)},
                    {console, report});
    report.add_phase("walk", watch.lap());
  }
  report.add("patches", model.mesh().patch_count());
  report.add("sensors", sensors.probes.size());
  report.add("hours_with_light", hours.size());
  add_figures(made, report);
  if (!console.options().json && !console.options().quiet) fmt::print("{}", year_text(made));
  report.print();
  return is_whole ? exit_done : exit_not_accurate;
}

}  // namespace lightwell
