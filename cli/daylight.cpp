#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <span>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/grid_arguments.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "cli/steps.h"
#include "daylight/year_error.h"
#include "daylight/year_files.h"
#include "mesh/cleaning/joined_surfaces.h"
#include "raytrace/readings/probe.h"
#include "raytrace/readings/probe_surface.h"
#include "scene/errors.h"
#include "scene/io/weather/weather_file.h"
#include "viewer/export/start_view.h"
#include "viewer/export/write_whole.h"
#include "viewer/report/year_report.h"

namespace lightwell {
namespace {

struct DaylightArguments {
  std::string scene, weather, points, output;
  GridArguments grids{};
  MeshArguments mesh{};
  double north_degrees = 0.0, ground = 0.2;
  int sky = DaylightOptions{}.sky_subdivision, rays = DaylightOptions{}.gather_rays;
  bool hourly = false;
  Occupancy occupancy{};
};

// Reads "8-18".
Occupancy parse_occupancy(const std::string& text) {
  Occupancy hours;
  const char* const last = text.data() + text.size();
  const auto [dash, bad_from] = std::from_chars(text.data(), last, hours.from);
  const bool has_dash = bad_from == std::errc() && dash != last && *dash == '-';
  const auto [end, bad_to] = std::from_chars(has_dash ? dash + 1 : last, last, hours.to);
  if (!has_dash || bad_to != std::errc() || end != last || hours.from < 0 ||
      hours.from >= hours.to || hours.to > 24) {
    throw CLI::ValidationError(
        "--occupied",
        fmt::format("'{}' is no span of hours; write two from 0 to 24, such as 8-18", text));
  }
  return hours;
}

// Zenith and north of the scene: those of its sky, or those that its axes suggest.
struct Compass {
  Eigen::Vector3d up, north;
};

Compass compass_of(const Scene& scene, double north_degrees) {
  Sky frame;
  if (scene.sky) {
    frame = *scene.sky;
  } else {
    frame.up = guess_up_axis(scene.cameras, scene_bounds(scene));
    // Drawings have north along +y; scenes with y up, along -z.
    frame.north = std::abs(frame.up.y()) > 0.5 ? Eigen::Vector3d(-Eigen::Vector3d::UnitZ())
                                               : Eigen::Vector3d(Eigen::Vector3d::UnitY());
  }
  return {frame.up, sky_direction(frame, north_degrees, 0.0)};
}

// The sensors of all rooms, in order.
struct Sensors {
  std::vector<Probe> probes{};
  std::vector<YearRoom> rooms{};

  void add(YearRoom room, const std::vector<Probe>& points) {
    if (points.empty()) return;
    room.first = static_cast<Eigen::Index>(probes.size());
    room.count = static_cast<Eigen::Index>(points.size());
    probes.insert(probes.end(), points.begin(), points.end());
    rooms.push_back(std::move(room));
  }
};

Sensors sensors_of(const DaylightArguments& arguments, const Scene& scene,
                   const CleanUpReport& clean_up, const ElementCaster& caster,
                   const Eigen::Vector3d& up) {
  Sensors sensors;
  for (LuxGrid& planned :
       requested_grids(arguments.grids.in_metres(scene), read_lighting_design(scene).grids,
                       clean_up.names ? clean_up.names->apart(scene) : scene, up)) {
    const LuxGrid grid = without_buried_points(caster, std::move(planned));
    sensors.add({.name = grid.name, .grid = grid, .lines = plan_lines(scene, caster, grid, {})},
                grid.points);
  }
  if (!arguments.points.empty()) {
    sensors.add({.name = std::filesystem::path(arguments.points).filename().string()},
                read_probes(arguments.points, scene.metres_per_unit));
  }
  if (sensors.probes.empty()) {
    throw InputError(
        "there are no sensors; name planes with '--plane floor@0.8' or as [[grids]] in the scene "
        "file, or a file of points with '--points'");
  }
  return sensors;
}

DaylightOptions options_of(const DaylightArguments& arguments, const Scene& scene,
                           Console& console) {
  DaylightOptions options{.sky_subdivision = arguments.sky, .gather_rays = arguments.rays};
  const MeshOptions mesh = arguments.mesh.options(scene);
  options.mesh.max_patch_size = mesh.max_patch_size;
  options.progress = console.progress();
  return options;
}

std::vector<std::string> conventions_of(const DaylightArguments& arguments, const Weather& weather,
                                        const SkyPatches& sky, bool has_sky) {
  const Eigen::Vector3d& north = sky.north();
  return {
      "An hour has the mean irradiances of the weather file; the sun stands where it is in the "
      "middle of the hour, standard time, without refraction (Michalsky 1988).",
      fmt::format("Dates are those of {}, since a typical year is put together from several.",
                  weather.is_leap_year ? "the leap year 2016" : "2017"),
      fmt::format("The dome is Perez' all-weather sky (1993) in {} patches of even luminance "
                  "(Tregenza, Reinhart). The sun is a disc of 0.533 degrees in its own place in "
                  "every hour.",
                  sky.dome_count()),
      weather.format.ends_with("(WEA)")
          ? "Lux follow from watts by Perez' efficacies (1990) for a dew point of 11 degrees."
          : "Lux follow from watts by Perez' efficacies (1990) for the dew point of each hour.",
      fmt::format("The ground reflects {:g} of the light of sun and dome, evenly.",
                  arguments.ground),
      "Panes pass light by its angle, with all reflections inside. The sun in mirrors, and through "
      "glass that bends or scatters its light, is left out. There are no blinds.",
      fmt::format("North is ({:.4g}, {:.4g}, {:.4g}) in the scene's axes, {}.", north.x(),
                  north.y(), north.z(), has_sky ? "by its sky" : "assumed"),
      "Lamps and emitting surfaces of the scene are off."};
}

// The measures of all rooms for light times `factor`.
void set_metrics(const AnnualMetrics& metrics, const Eigen::ArrayXf& daylight_factor,
                 RoomMetrics YearRoom::*which, std::vector<YearRoom>& rooms) {
  const SensorMetrics sensors = metrics.sensors();
  for (YearRoom& room : rooms) {
    room.*which = room_metrics(sensors, daylight_factor, room.first, room.count);
  }
}

void add_means(const HourBlock& block, std::vector<YearRoom>& rooms) {
  for (YearRoom& room : rooms) {
    for (std::size_t h = 0; h < block.hours.size(); ++h) {
      room.mean_of_hours[static_cast<std::size_t>(block.hours[h].number)] =
          block.total.col(static_cast<Eigen::Index>(h)).segment(room.first, room.count).mean();
    }
  }
}

// Files of every hour and sensor, where they are asked for.
class HourlyFiles {
 public:
  HourlyFiles(const OutputFolder& folder, int sensors)
      : total_(folder / "illuminance.npy", sensors), sunlight_(folder / "sunlight.npy", sensors) {}

  void append(const HourBlock& block) {
    total_.append(block.total);
    sunlight_.append(block.sunlight);
  }
  void commit() {
    total_.commit();
    sunlight_.commit();
  }

 private:
  NumpyRows total_, sunlight_;
};

// The files that the command will write.
std::vector<std::string> files_of(const DaylightArguments& arguments) {
  std::vector<std::string> files = {"sensors.csv", "hours.csv", "year.html", "year.json"};
  if (arguments.hourly) files.insert(files.end(), {"illuminance.npy", "sunlight.npy"});
  return files;
}

// Goes through the year and fills in the measures of sensors and rooms.
void go_through_year(const DaylightModel& model, const SkyCoefficients& sky,
                     std::span<const SkyHour> hours, double ground, HourlyFiles* files,
                     YearReport& made) {
  const auto counted = [&](double factor) {
    return AnnualMetrics(model.sensor_count(), hours, static_cast<int>(made.weather.hours.size()),
                         made.occupancy, factor);
  };
  for (YearRoom& room : made.rooms) room.mean_of_hours.assign(made.weather.hours.size(), 0.0f);
  AnnualMetrics metrics = counted(1.0), least = counted(1.0 - std::min(1.0, made.error)),
                most = counted(1.0 + made.error);
  simulate_year(model, sky, hours, ground, [&](const HourBlock& block) {
    metrics.add(block);
    least.add(block);
    most.add(block);
    add_means(block, made.rooms);
    if (files) files->append(block);
  });
  made.sensors = metrics.sensors();
  set_metrics(metrics, made.daylight_factor, &YearRoom::metrics, made.rooms);
  set_metrics(least, made.daylight_factor, &YearRoom::least, made.rooms);
  set_metrics(most, made.daylight_factor, &YearRoom::most, made.rooms);
}

// The report of a year before the year is computed, with `notes` on the weather and those of the
// scene.
YearReport report_of(const DaylightArguments& arguments, const Scene& scene, const Weather& weather,
                     const Compass& compass, std::span<const std::string> notes) {
  YearReport made{.title = scene.title.empty() ? scene.file.filename().string() : scene.title,
                  .version = LIGHTWELL_VERSION,
                  .weather = weather,
                  .notes = {notes.begin(), notes.end()},
                  .occupancy = arguments.occupancy,
                  .north = compass.north,
                  .metres_per_unit = scene.metres_per_unit,
                  .unit_name = scene.unit_name};
  made.notes.insert(made.notes.end(), scene.notes.begin(), scene.notes.end());
  return made;
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

int daylight(const DaylightArguments& arguments, Console& console) {
  Report report(console.options());
  note_input(arguments.weather);
  if (!arguments.points.empty()) note_input(arguments.points);
  const Weather weather = read_weather(arguments.weather);
  CleanUpReport clean_up;
  const Scene scene = read_scene_step(arguments.scene, console, report, &clean_up);
  const Compass compass = compass_of(scene, arguments.north_degrees);
  const std::vector<SkyHour> hours = sky_hours(weather, compass.up, compass.north);
  YearReport made =
      report_of(arguments, scene, weather, compass, weather_notes(weather, hours, console));
  const OutputFolder folder(arguments.output);
  for (const std::string& file : files_of(arguments)) require_writable(folder / file);

  Stopwatch watch;
  DaylightModel model(scene, compass.up, compass.north, options_of(arguments, scene, console));
  Sensors sensors = sensors_of(arguments, scene, clean_up, model.caster(), compass.up);
  model.set_sensors(probe_points(model.caster(), sensors.probes));
  const SkyCoefficients sky = model.sky_coefficients().sum();
  report.add_phase("sky", watch.lap());
  made.rooms = std::move(sensors.rooms);
  made.conventions = conventions_of(arguments, weather, model.sky(), scene.sky.has_value());
  made.error = year_error(model, sky, hours, arguments.ground);
  report.add_phase("error", watch.lap());
  made.daylight_factor = daylight_factors(model, sky, arguments.ground);
  if (!(made.daylight_factor > 0.0f).any()) {
    made.notes.emplace_back(
        "No daylight reaches any sensor: the scene has no opening, or its windows are opaque.");
    console.say("warning: " + made.notes.back());
  }
  std::optional<HourlyFiles> files;
  if (arguments.hourly) files.emplace(folder, model.sensor_count());
  go_through_year(model, sky, hours, arguments.ground, files ? &*files : nullptr, made);
  console.finish_phase();
  stop_if_interrupted();
  report.add_phase("year", watch.lap());

  write_sensors(folder / "sensors.csv", sensors.probes, made.sensors, made.daylight_factor,
                scene.metres_per_unit);
  write_hours(folder / "hours.csv", hours, weather.is_leap_year);
  write_whole(folder / "year.html", {year_page(made)});
  const Json figures = year_json(made);
  write_json(folder / "year.json", figures);
  if (files) files->commit();
  for (const std::string& file : files_of(arguments)) report.add_file(folder / file);
  report.add("patches", model.mesh().patch_count());
  report.add("sensors", sensors.probes.size());
  report.add("hours_with_light", hours.size());
  for (const char* key : {"relative_error", "rooms"}) report.add(key, figures[key]);
  if (!console.options().json && !console.options().quiet) fmt::print("{}", year_text(made));
  report.print();
  return exit_done;
}

}  // namespace

Action add_daylight(CLI::App& command) {
  const auto arguments = std::make_shared<DaylightArguments>();
  command.description(
      "Daylight of a year: every hour's illuminance at sensors, with the sun as a disc in its own "
      "place,\nand what standards make of it: DA, UDI, sDA, ASE, EN 17037, daylight factors.");
  command.add_option("scene", arguments->scene, "scene file, as for 'solve'")
      ->required()
      ->type_name("SCENE");
  command
      .add_option("--weather", arguments->weather,
                  "hourly weather of a year: .epw (EnergyPlus) or .wea (RADIANCE)")
      ->required()
      ->type_name("FILE");
  command
      .add_option("-o,--output", arguments->output,
                  "folder for sensors.csv, hours.csv, year.html and year.json")
      ->required()
      ->type_name("FOLDER");
  command
      .add_option("--points", arguments->points,
                  "sensors: CSV with columns x,y,z,nx,ny,nz in the scene file's unit")
      ->type_name("FILE");
  arguments->grids.add_to(command);
  command
      .add_option("--north", arguments->north_degrees,
                  "turns north clockwise, seen from above, from that of the scene's sky (without a "
                  "sky: +y, or -z where y is up)")
      ->type_name("DEGREES")
      ->check(CLI::Range(-360.0, 360.0).description(""));
  command
      .add_option("--ground", arguments->ground,
                  "reflectance of the ground outside of the scene (default 0.2)")
      ->type_name("RHO")
      ->check(CLI::Range(0.0, 1.0).description(""));
  command
      .add_option_function<std::string>(
          "--occupied",
          [arguments](const std::string& text) { arguments->occupancy = parse_occupancy(text); },
          "occupied hours of every day, standard time (default 8-18)")
      ->type_name("FROM-TO");
  command
      .add_option("--sky", arguments->sky,
                  "subdivision of Tregenza's 145 sky patches, each way (default 4)")
      ->type_name("N")
      ->check(whole_number(1, 8));
  command
      .add_option("--rays", arguments->rays,
                  "gather rays per sensor, a power of two (default 1024)")
      ->type_name("N")
      ->check(power_of_two());
  command
      .add_option("--max-patch-size", arguments->mesh.max_patch_size,
                  "longest patch edge (default: about 3200 patches)")
      ->type_name("LENGTH")
      ->check(positive());
  command.add_flag("--hourly", arguments->hourly,
                   "also write illuminance.npy and sunlight.npy: hours of hours.csv x sensors, lx");
  command.footer(
      "Example: lightwell daylight office.toml --weather oakland.epw --plane floor@0.8 -o year");
  return [arguments](Console& console) { return daylight(*arguments, console); };
}

}  // namespace lightwell
