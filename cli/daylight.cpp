#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/compass.h"
#include "cli/daylight_year.h"
#include "scene/errors.h"
#include "scene/io/weather/clock_time.h"

namespace lightwell {
namespace {

// Reads the text of an option by a reader of the library, whose errors become those of the option.
template <class Read>
auto read_option(const char* option, const std::string& text, const Read& read) {
  try {
    return read(text);
  } catch (const InputError& error) {
    throw CLI::ValidationError(option, error.what());
  }
}

std::string parse_page(const std::string& text) {
  if (std::filesystem::path(text).extension() != ".html") {
    throw CLI::ValidationError(
        "--walk", fmt::format("'{}' is no name of a page; write one such as walk.html", text));
  }
  return text;
}

int daylight(const DaylightArguments& arguments, Console& console) {
  Report report(console.options());
  const DaylightStudy study = read_daylight_study(arguments, console, report);
  return arguments.at ? daylight_of_instant(arguments, study, console, report)
                      : daylight_of_year(arguments, study, console, report);
}

// Options on rooms that are judged.
void add_rooms(CLI::App& command, const std::shared_ptr<DaylightArguments>& arguments) {
  CLI::Option* const rating =
      command
          .add_option("--rating", arguments->ratings,
                      "hold the rooms to a rating: leed, breeam-office, ...; may be repeated")
          ->type_name("KEY")
          ->type_size(1)
          ->allow_extra_args(false);
  command
      .add_option("--ratings", arguments->rating_table,
                  "table of ratings in place of the program's")
      ->type_name("FILE.toml")
      ->needs(rating);
  CLI::Option* const rooms =
      command
          .add_option("--rooms", arguments->rooms,
                      "use of rooms, and their lamps, whose energy daylight saves (EN 15193-1)")
          ->type_name("FILE.toml");
  command.get_option("--at")->excludes(rating)->excludes(rooms);
}

// Options on what people do and see.
void add_people(CLI::App& command, const std::shared_ptr<DaylightArguments>& arguments) {
  constexpr double highest_sun = 89.0;
  command
      .add_option("--windows", arguments->windows,
                  "states of windows and their operation, beside those of a native scene file")
      ->type_name("FILE.toml");
  CLI::Option* const observer =
      command
          .add_option("--observer", arguments->observers,
                      "glare (DGP) of an eye at this camera's place; may be repeated")
          ->type_name("CAMERA")
          ->type_size(1)
          ->allow_extra_args(false);
  CLI::Option* const sun_points =
      command
          .add_option("--sun-points", arguments->sun_points,
                      "hours of sun at points of windows (EN 17037): CSV as for --points")
          ->type_name("FILE");
  command
      .add_option_function<std::string>(
          "--sun-day",
          [arguments](const std::string& text) {
            const ExposureDay day = read_option("--sun-day", text, read_exposure_day);
            arguments->sun_day.month = day.month;
            arguments->sun_day.day = day.day;
          },
          "day of --sun-points, 02-01 to 03-21 (default 03-21)")
      ->type_name("MM-DD")
      ->needs(sun_points);
  command
      .add_option("--least-sun", arguments->sun_day.least_altitude_degrees,
                  "least altitude of the sun that counts for --sun-points (default 0)")
      ->type_name("DEGREES")
      ->check(number_within(0.0, highest_sun, "an altitude in degrees"))
      ->needs(sun_points);
  command
      .add_option_function<std::string>(
          "--at",
          [arguments](const std::string& text) {
            arguments->at = read_option("--at", text, read_clock_time);
            arguments->at_text = text;
          },
          "one instant in standard time instead of the year: \"2024-11-21 15:30\"")
      ->type_name("TIME")
      ->excludes(observer)
      ->excludes(sun_points);
}

}  // namespace

Action add_daylight(CLI::App& command) {
  const auto arguments = std::make_shared<DaylightArguments>();
  command.description(
      "Daylight of a year: every hour's illuminance at sensors, with the sun as a disc in its own "
      "place,\nand what standards make of it: DA, UDI, sDA, ASE, EN 17037, daylight factors, "
      "LEED and BREEAM.");
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
                  "folder for sensors.csv, hours.csv, year.html and year.json; with --at for "
                  "instant.csv and instant.html")
      ->required()
      ->type_name("FOLDER");
  command
      .add_option("--points", arguments->points,
                  "sensors: CSV with columns x,y,z,nx,ny,nz in the scene file's unit")
      ->type_name("FILE");
  arguments->grids.add_to(command);
  add_north(command, arguments->north_degrees);
  command
      .add_option("--ground", arguments->ground,
                  "reflectance of the ground outside of the scene (default 0.2)")
      ->type_name("RHO")
      ->check(number_within(0.0, 1.0, "a reflectance"));
  command
      .add_option_function<std::string>(
          "--occupied",
          [arguments](const std::string& text) {
            arguments->occupancy = read_option("--occupied", text, read_occupancy);
          },
          "occupied hours of every day, standard time (default 8-18)")
      ->type_name("FROM-TO");
  command
      .add_option("--sky", arguments->sky,
                  "subdivision of Tregenza's 145 sky patches, each way (default 4)")
      ->type_name("N")
      ->check(whole_number(1, 8));
  command
      .add_option("--rays", arguments->rays,
                  fmt::format("gather rays per sensor, a power of two (default {})",
                              DaylightOptions{}.gather_rays))
      ->type_name("N")
      ->check(power_of_two());
  command
      .add_option("--max-patch-size", arguments->mesh.max_patch_size,
                  "longest patch edge (default: about 3200 patches)")
      ->type_name("LENGTH")
      ->check(positive());
  add_people(command, arguments);
  add_rooms(command, arguments);
  command.add_flag("--hourly", arguments->hourly,
                   "also write illuminance.npy and sunlight.npy: hours of hours.csv x sensors, lx");
  command
      .add_option_function<std::string>(
          "--walk", [arguments](const std::string& text) { arguments->walk = parse_page(text); },
          "also write a page to walk in, at all hours of the year")
      ->type_name("FILE.html");
  command.get_option("--at")
      ->excludes(command.get_option("--walk"))
      ->excludes(command.get_option("--hourly"))
      ->excludes(command.get_option("--occupied"));
  command.footer(
      "Example: lightwell daylight office.toml --weather oakland.epw --plane floor@0.8 -o year");
  return [arguments](Console& console) { return daylight(*arguments, console); };
}

}  // namespace lightwell
