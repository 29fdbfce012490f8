#include <fmt/format.h>

#include <array>
#include <charconv>
#include <memory>
#include <numeric>
#include <optional>

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

constexpr std::array<const char*, 4> result_files = {"sensors.csv", "hours.csv", "year.html",
                                                     "year.json"};

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
    // On drawings +y is north; where y is up, -z is.
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
                                        const SkyPatches& sky) {
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

int daylight(const DaylightArguments& arguments, Console& console) {
  Report report(console.options());
  note_input(arguments.weather);
  if (!arguments.points.empty()) note_input(arguments.points);
  const Weather weather = read_weather(arguments.weather);
  CleanUpReport clean_up;
  const Scene scene = read_scene_step(arguments.scene, console, report, &clean_up);
  for (const std::string& note : weather.notes) console.say("note: " + note);
  const auto [up, north] = compass_of(scene, arguments.north_degrees);
  const std::vector<SkyHour> hours = sky_hours(weather, up, north);
  const OutputFolder folder(arguments.output);
  for (const char* file : result_files) require_writable(folder / file);

  Stopwatch watch;
  DaylightModel model(scene, up, north, options_of(arguments, scene, console));
  Sensors sensors = sensors_of(arguments, scene, clean_up, model.caster(), up);
  if (sensors.probes.empty()) {
    throw InputError(
        "there are no sensors; name planes with '--plane floor@0.8' or as [[grids]] in the scene "
        "file, or a file of points with '--points'");
  }
  model.set_sensors(probe_points(model.caster(), sensors.probes));
  const SkyCoefficients sky = model.sky_coefficients().sum();
  report.add_phase("sky", watch.lap());

  YearReport made{.title = scene.title.empty() ? scene.file.filename().string() : scene.title,
                  .version = LIGHTWELL_VERSION,
                  .weather = weather,
                  .conventions = conventions_of(arguments, weather, model.sky()),
                  .notes = weather.notes,
                  .occupancy = arguments.occupancy,
                  .north = north,
                  .metres_per_unit = scene.metres_per_unit,
                  .unit_name = scene.unit_name,
                  .rooms = std::move(sensors.rooms)};
  made.error = year_error(model, sky, hours, arguments.ground);
  report.add_phase("error", watch.lap());
  made.daylight_factor = daylight_factors(model, sky, arguments.ground);
  if (!(made.daylight_factor > 0.0f).any()) {
    made.notes.emplace_back(
        "No daylight reaches any sensor: the scene has no opening, or its windows are opaque.");
    console.say("warning: " + made.notes.back());
  }
  const auto year_hours = static_cast<int>(weather.hours.size());
  for (YearRoom& room : made.rooms) room.mean_of_hours.assign(weather.hours.size(), 0.0f);
  const auto counted = [&](double factor) {
    return AnnualMetrics(model.sensor_count(), hours, year_hours, arguments.occupancy, factor);
  };
  AnnualMetrics metrics = counted(1.0), least = counted(1.0 - std::min(1.0, made.error)),
                most = counted(1.0 + made.error);
  std::optional<HourlyFiles> files;
  if (arguments.hourly) files.emplace(folder, model.sensor_count());
  simulate_year(model, sky, hours, arguments.ground, [&](const HourBlock& block) {
    metrics.add(block);
    least.add(block);
    most.add(block);
    add_means(block, made.rooms);
    if (files) files->append(block);
  });
  console.finish_phase();
  stop_if_interrupted();
  report.add_phase("year", watch.lap());
  made.sensors = metrics.sensors();
  set_metrics(metrics, made.daylight_factor, &YearRoom::metrics, made.rooms);
  set_metrics(least, made.daylight_factor, &YearRoom::least, made.rooms);
  set_metrics(most, made.daylight_factor, &YearRoom::most, made.rooms);

  write_sensors(folder / "sensors.csv", sensors.probes, made.sensors, made.daylight_factor,
                scene.metres_per_unit);
  write_hours(folder / "hours.csv", hours, weather.is_leap_year);
  write_whole(folder / "year.html", {year_page(made)});
  write_json(folder / "year.json", year_json(made));
  for (const char* file : result_files) report.add_file(folder / file);
  if (files) {
    files->commit();
    report.add_file(folder / "illuminance.npy");
    report.add_file(folder / "sunlight.npy");
  }
  report.add("patches", model.mesh().patch_count());
  report.add("sensors", sensors.probes.size());
  report.add("hours_with_light", hours.size());
  const Json figures = year_json(made);
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
                  "subdivision of Tregenza's 145 sky patches, each way (default 2)")
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
