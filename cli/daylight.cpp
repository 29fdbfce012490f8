#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "cli/steps.h"
#include "daylight/annual_metrics.h"
#include "daylight/year_files.h"
#include "raytrace/readings/probe.h"
#include "scene/errors.h"
#include "scene/io/weather/weather_file.h"

namespace lightwell {
namespace {

struct DaylightArguments {
  std::string scene, weather, points, output;
  double north_degrees = 0.0;
  double ground = 0.2;
  int sky = 2, rays = 1024;
  bool hourly = false;
  Occupancy occupancy{};
};

int daylight(const DaylightArguments& arguments, Console& console) {
  Report report(console.options());
  Scene scene = read_scene_step(arguments.scene, console, report);
  note_input(arguments.weather);
  const Weather weather = read_weather(arguments.weather);
  for (const std::string& note : weather.notes) console.say("note: " + note);
  note_input(arguments.points);
  const std::vector<Probe> sensors = read_probes(arguments.points, scene.metres_per_unit);
  const OutputFolder folder(arguments.output);
  const double metres = scene.metres_per_unit;
  const Sky frame = scene.sky ? *scene.sky : Sky{.up = Eigen::Vector3d::UnitZ(), .north = Eigen::Vector3d::UnitY()};
  const Eigen::Vector3d north = sky_direction(frame, arguments.north_degrees, 0.0);
  const std::vector<SkyHour> hours = sky_hours(weather, frame.up, north);

  Stopwatch watch;
  DaylightOptions options{.sky_subdivision = arguments.sky, .gather_rays = arguments.rays};
  options.progress = console.progress();
  DaylightModel model(std::move(scene), frame.up, north, options);
  report.add_phase("form_factors", watch.lap());
  std::vector<GatherPoint> points;
  for (const Probe& sensor : sensors) {
    points.push_back({.position = sensor.position, .normal = sensor.normal});
  }
  model.set_sensors(points);
  report.add_phase("views", watch.lap());
  const SensorLight by_sky = model.sky_coefficients();
  report.add_phase("sky", watch.lap());
  const SkyCoefficients sky = by_sky.direct + by_sky.reflected;
  const Eigen::ArrayXf daylight_factor = daylight_factors(model, sky, arguments.ground);
  AnnualMetrics metrics(model.sensor_count(), hours, static_cast<int>(weather.hours.size()),
                        arguments.occupancy);
  std::optional<NumpyRows> total, sunlight;
  if (arguments.hourly) {
    total.emplace(folder / "illuminance.npy", model.sensor_count());
    sunlight.emplace(folder / "sunlight.npy", model.sensor_count());
  }
  simulate_year(model, sky, hours, arguments.ground, [&](const HourBlock& block) {
    metrics.add(block);
    if (!total) return;
    total->append(block.total);
    sunlight->append(block.sunlight);
  });
  console.finish_phase();
  stop_if_interrupted();
  report.add_phase("year", watch.lap());
  const SensorMetrics of_sensors = metrics.sensors();
  const RoomMetrics room = room_metrics(of_sensors, daylight_factor);
  write_sensors(folder / "sensors.csv", sensors, of_sensors, daylight_factor, metres);
  write_hours(folder / "hours.csv", hours, weather.is_leap_year);
  if (total) {
    total->commit();
    sunlight->commit();
  }
  report.add("patches", model.mesh().patch_count());
  report.add("sensors", sensors.size());
  report.add("hours", hours.size());
  report.add("sDA300_50", room.spatial_autonomy);
  report.add("ASE1000_250", room.sun_exposure);
  report.add("mean_DA300", room.mean_autonomy);
  report.add("mean_cDA300", room.mean_continuous_autonomy);
  report.add("mean_lux", room.mean_lux);
  report.add("mean_daylight_factor", room.mean_daylight_factor);
  report.add("median_daylight_factor", room.median_daylight_factor);
  report.add("en_17037", room.en_level);
  report.print();
  return exit_done;
}

}  // namespace

Action add_daylight(CLI::App& command) {
  const auto arguments = std::make_shared<DaylightArguments>();
  command.description("Daylight of a year at sensors: illuminance of each hour, and the metrics.");
  command.add_option("scene", arguments->scene, "scene file, as for 'solve'")
      ->required()
      ->type_name("SCENE");
  command.add_option("--weather", arguments->weather, "hourly weather: .epw or .wea")
      ->required()
      ->type_name("FILE");
  command
      .add_option("--points", arguments->points,
                  "CSV of sensors with columns x,y,z,nx,ny,nz in the scene file's unit")
      ->required()
      ->type_name("FILE");
  command.add_option("-o,--output", arguments->output, "folder for the results")
      ->required()
      ->type_name("FOLDER");
  command.add_option("--ground", arguments->ground, "reflectance of the ground (default 0.2)")
      ->check(CLI::Range(0.0, 1.0));
  command.add_option("--sky", arguments->sky, "subdivision of the sky (default 2)");
  command.add_option("--rays", arguments->rays, "gather rays per sensor (default 1024)");
  command.add_flag("--hourly", arguments->hourly, "also write every hour of every sensor, as .npy");
  return [arguments](Console& console) { return daylight(*arguments, console); };
}

}  // namespace lightwell
