#include "cli/daylight_year.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "daylight/glare_of_year.h"
#include "daylight/honeybee_metrics.h"
#include "daylight/operated_year.h"
#include "daylight/year_basis.h"
#include "daylight/year_files.h"
#include "raytrace/readings/probe_surface.h"
#include "viewer/export/write_whole.h"

namespace lightwell {
namespace {

// Files of every hour and sensor, where they are asked for.
class HourlyFiles {
 public:
  HourlyFiles(const OutputFolder& folder, int sensors)
      : sensors_(sensors),
        total_(folder / "illuminance.npy", sensors),
        sunlight_(folder / "sunlight.npy", sensors) {}

  void append(const HourBlock& block) {
    total_.append(block.total.topRows(sensors_));
    sunlight_.append(block.sunlight.topRows(sensors_));
  }
  void commit() {
    total_.commit();
    sunlight_.commit();
  }

 private:
  int sensors_;
  NumpyRows total_, sunlight_;
};

// The files that the command will write.
std::vector<std::string> files_of(const DaylightArguments& arguments) {
  std::vector<std::string> files = {"sensors.csv", "hours.csv", "year.html", "year.json"};
  if (arguments.hourly) files.insert(files.end(), {"illuminance.npy", "sunlight.npy"});
  if (!arguments.observers.empty()) files.emplace_back("glare.csv");
  return files;
}

// The measures of all rooms.
void set_metrics(const SensorMetrics& sensors, const Eigen::ArrayXf& daylight_factor,
                 RoomMetrics YearRoom::*which, std::vector<YearRoom>& rooms) {
  for (YearRoom& room : rooms) {
    room.*which = room_metrics(sensors, daylight_factor, room.first, room.count);
  }
}

// Measures of a year and of its rooms, hour by hour.
class YearCount {
 public:
  YearCount(std::span<const SkyHour> hours, int sensors, HourlyFiles* files, YearReport& made)
      : made_(made),
        files_(files),
        metrics_(sensors, hours, static_cast<int>(made.weather.hours.size()), made.occupancy),
        least_(metrics_),
        most_(metrics_) {
    for (YearRoom& room : made_.rooms) room.mean_of_hours.assign(made_.weather.hours.size(), 0.0f);
  }

  // Adds a block of hours, with the bound of each hour's light.
  void add(const HourBlock& block, const std::vector<double>& errors) {
    std::vector<float> less, more;
    for (const double error : errors) {
      less.push_back(static_cast<float>(1.0 - std::min(1.0, error)));
      more.push_back(static_cast<float>(1.0 + error));
    }
    metrics_.add(block);
    least_.add(block, less);
    most_.add(block, more);
    for (YearRoom& room : made_.rooms) {
      for (std::size_t h = 0; h < block.hours.size(); ++h) {
        room.mean_of_hours[static_cast<std::size_t>(block.hours[h].number)] =
            block.total.col(static_cast<Eigen::Index>(h)).segment(room.first, room.count).mean();
      }
    }
    if (files_) files_->append(block);
  }

  // Fills in the measures. `open_sun_hours`, if not null, are those of windows without blinds,
  // which ASE asks for.
  void finish(const Eigen::ArrayXd* open_sun_hours) {
    const auto with_sun = [&](const AnnualMetrics& metrics) {
      SensorMetrics sensors = metrics.sensors();
      if (open_sun_hours) sensors.sun_hours = *open_sun_hours;
      return sensors;
    };
    made_.sensors = with_sun(metrics_);
    set_metrics(made_.sensors, made_.daylight_factor, &YearRoom::metrics, made_.rooms);
    set_metrics(with_sun(least_), made_.daylight_factor, &YearRoom::least, made_.rooms);
    set_metrics(with_sun(most_), made_.daylight_factor, &YearRoom::most, made_.rooms);
  }

 private:
  YearReport& made_;
  HourlyFiles* files_;
  AnnualMetrics metrics_, least_, most_;
};

int occupied_hours_of(const YearReport& made) {
  return static_cast<int>(made.weather.hours.size()) / hours_a_day *
         (made.occupancy.to - made.occupancy.from);
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

// The year with windows that change: its measures, and those of each computation.
class OperatedCount {
 public:
  OperatedCount(std::span<const SkyHour> hours, int sensors, const YearReport& made)
      : hours_(hours), sensors_(sensors), made_(made) {}

  void add(const ComputedYear& year, const HourBlock& block) { count_of(year.number).add(block); }

  Eigen::ArrayXd open_sun_hours() { return count_of(0).sensors().sun_hours; }

  std::vector<YearInStates> years(const OperatedYear& year, const OperatedWindows& windows) {
    std::vector<YearInStates> all;
    for (std::size_t number = 0; number < year.plan.computations.size(); ++number) {
      YearInStates in_states{.states = states_text(windows, year.plan.computations[number]),
                             .error = year.errors[number]};
      const SensorMetrics sensors = count_of(number).sensors();
      for (const YearRoom& room : made_.rooms) {
        in_states.rooms.push_back(
            room_metrics(sensors, year.daylight_factor, room.first, room.count));
      }
      all.push_back(std::move(in_states));
    }
    return all;
  }

 private:
  // The measures of a computation. A year without light adds no hours to them.
  AnnualMetrics& count_of(std::size_t number) {
    const auto year_hours = static_cast<int>(made_.weather.hours.size());
    return counts_.try_emplace(number, sensors_, hours_, year_hours, made_.occupancy).first->second;
  }

  std::span<const SkyHour> hours_;
  int sensors_;
  const YearReport& made_;
  std::map<std::size_t, AnnualMetrics> counts_{};
};

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
  for (const char* key : {"relative_error", "rooms", "windows", "method", "superposition_error",
                          "states", "glare", "exposure_to_sunlight"}) {
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
  write_whole(folder / "year.html", {year_page(made)});
  write_json(folder / "year.json", year_json(made));
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
  // Before form factors, which take long where the page is too large.
  if (!arguments.walk.empty()) {
    constexpr int fewest_bands = 1;  // of a grey scene; find_year_basis() knows them
    check_year_basis(build_patches(inputs.scene, options.mesh), fewest_bands, hours);
  }
  DaylightModel model(inputs.scene, inputs.up, inputs.north, options);
  DaylightSensors sensors = daylight_sensors(arguments, inputs, model.caster());
  model.set_sensors(probe_points(model.caster(), sensors.all()));
  report.add_phase("sky", watch.lap());
  made.conventions = conventions_of_year(arguments, inputs, model.sky());
  const std::vector<SensorRange> ranges = sensors.ranges();
  made.rooms = std::move(sensors.rooms);
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

  write_files({.folder = folder, .inputs = inputs, .hours = hours, .probes = sensors.probes}, made,
              year);
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
