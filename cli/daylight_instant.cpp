#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/daylight_year.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "daylight/operated_year.h"
#include "daylight/year_files.h"
#include "raytrace/readings/probe_surface.h"
#include "scene/errors.h"
#include "viewer/export/write_whole.h"
#include "viewer/report/year_instant.h"

namespace lightwell {
namespace {

constexpr const char* const instant_files[] = {"instant.csv", "instant.html"};

SkyHour sky_of_instant(const DaylightArguments& arguments, const DaylightInputs& inputs) {
  const auto sky = sky_instant(inputs.weather, *arguments.at, inputs.up, inputs.north);
  if (!sky) {
    throw InputError(fmt::format(
        "{}: at {} standard time the sun is below the horizon, or the weather has no light; give "
        "'--at' another time",
        arguments.weather, arguments.at_text));
  }
  return *sky;
}

std::vector<std::string> conventions_of_instant(const DaylightArguments& arguments,
                                                const DaylightInputs& inputs,
                                                const SkyPatches& sky) {
  std::vector<std::string> sentences = {
      "Sun and dome have the mean irradiances of the weather file's hour that holds the instant; "
      "the sun stands where it is at the instant, standard time, without refraction (Michalsky "
      "1988).",
      "Blinds that close and open by their illuminance are taken as open before."};
  if (inputs.windows.groups.empty()) sentences.pop_back();
  const std::vector<std::string> more = daylight_conventions(arguments, inputs, sky);
  sentences.insert(sentences.end(), more.begin(), more.end());
  return sentences;
}

// The light of the instant in its states of windows.
void set_light(const DaylightArguments& arguments, const DaylightInputs& inputs,
               const DaylightModel& model, const std::vector<SensorRange>& ranges,
               InstantReport& made) {
  const std::vector<SkyHour> hours = {made.sky};
  const OperatedYear year = operate_year(inputs.scene, model, inputs.windows,
                                         {.hours = hours,
                                          .is_leap_year = inputs.weather.is_leap_year,
                                          .ground_reflectance = arguments.ground,
                                          .rooms = ranges},
                                         [&](const ComputedYear&, const HourBlock& block) {
                                           made.total = block.total.col(0);
                                           made.sunlight = block.sunlight.col(0);
                                         });
  // Computed last are the states of the instant.
  made.of.error = year.errors.back();
  made.states = states_text(inputs.windows, year.plan.computations.back());
}

}  // namespace

int daylight_of_instant(const DaylightArguments& arguments, const DaylightInputs& inputs,
                        Console& console, Report& report) {
  for (const std::string& note : inputs.weather.notes) console.say("note: " + note);
  InstantReport made{.of = daylight_report(arguments, inputs, inputs.weather.notes),
                     .when = arguments.at_text,
                     .sky = sky_of_instant(arguments, inputs)};
  const OutputFolder folder(arguments.output);
  for (const char* file : instant_files) require_writable(folder / file);

  Stopwatch watch;
  DaylightModel model(inputs.scene, inputs.up, inputs.north,
                      daylight_options(arguments, inputs.scene, console));
  DaylightSensors sensors = daylight_sensors(arguments, inputs, model.caster());
  model.set_sensors(probe_points(model.caster(), sensors.probes));
  made.of.conventions = conventions_of_instant(arguments, inputs, model.sky());
  const std::vector<SensorRange> ranges = sensors.ranges();
  made.of.rooms = std::move(sensors.rooms);
  set_light(arguments, inputs, model, ranges, made);
  console.finish_phase();
  stop_if_interrupted();
  report.add_phase("instant", watch.lap());

  write_instant(folder / "instant.csv", sensors.probes, made.total, made.sunlight,
                inputs.scene.metres_per_unit);
  write_whole(folder / "instant.html", {instant_page(made)});
  for (const char* file : instant_files) report.add_file(folder / file);
  report.add("patches", model.mesh().patch_count());
  report.add("sensors", sensors.probes.size());
  const Json figures = instant_json(made);
  for (const auto& [key, value] : figures.items()) report.add(key, value);
  if (!console.options().json && !console.options().quiet) fmt::print("{}", instant_text(made));
  report.print();
  return exit_done;
}

}  // namespace lightwell
