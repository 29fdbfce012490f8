#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <tuple>

#include "cli/arguments.h"
#include "cli/compass.h"
#include "cli/facet_geometry.h"
#include "cli/shortwave.h"
#include "scene/io/comma_fields.h"
#include "scene/io/dashed_pair.h"

namespace lightwell {
namespace {

// Reads "45,180".
std::pair<double, double> parse_sun(const std::string& text) {
  const auto fields = comma_fields(text);
  if (fields.size() == 2) {
    const auto altitude = parsed_number(std::string(fields[0]));
    const auto azimuth = parsed_number(std::string(fields[1]));
    if (altitude && azimuth && *altitude > 0.0 && *altitude <= 90.0 && *azimuth >= -360.0 &&
        *azimuth <= 360.0) {
      return {*altitude, *azimuth};
    }
  }
  throw CLI::ValidationError(
      "--sun", fmt::format("'{}' is no place of the sun; write its altitude above the horizon, 0 "
                           "to 90, and its azimuth from north by east, such as 45,180",
                           text));
}

// Month and day of "06-21"; empty if there is no such day.
std::optional<HourOfYear> day_of(std::string_view text, bool is_leap_year) {
  const auto date = dashed_pair(text);
  if (!date) return std::nullopt;
  const HourOfYear found{.month = date->first, .day = date->second};
  return number_of(found, is_leap_year) < 0 ? std::nullopt : std::optional(found);
}

// Reads "06-21" and "06-01..08-31". The 29th of February is a day of leap years.
DaySpan parse_days(const std::string& text) {
  constexpr std::string_view dots = "..";
  const auto middle = text.find(dots);
  const std::string_view all = text;
  const auto first = day_of(all.substr(0, middle), true);
  const auto last =
      middle == std::string::npos ? first : day_of(all.substr(middle + dots.size()), true);
  if (first && last) return {.first = *first, .last = *last};
  throw CLI::ValidationError(
      "--days", fmt::format("'{}' is no span of days; write month and day, such as 06-21, or two "
                            "of them, such as 06-01..08-31",
                            text));
}

HourOfYear parse_date(const std::string& text) {
  if (const auto date = day_of(text, false)) return *date;
  throw CLI::ValidationError(
      "--date", fmt::format("'{}' is no date; write month and day, such as 06-21", text));
}

void add_sun_and_sky(CLI::App& command, ShortwaveArguments& arguments) {
  constexpr double brightest = 1e6;  // W/m^2
  command
      .add_option_function<std::string>(
          "--sun", [&arguments](const std::string& text) { arguments.sun = parse_sun(text); },
          "place of the sun in degrees: altitude, and azimuth from north by east, such as 45,180")
      ->type_name("ALT,AZ");
  command.add_option("--direct", arguments.direct, "irradiance across the sun's rays (default 0)")
      ->type_name("W/m2")
      ->check(number_within(0.0, brightest, "an irradiance"));
  command
      .add_option("--diffuse", arguments.diffuse,
                  "irradiance of open level ground by the sky (default 0)")
      ->type_name("W/m2")
      ->check(number_within(0.0, brightest, "an irradiance"));
  command
      .add_option("--sky", arguments.sky,
                  "radiance of the sky: even (default), or perez, the all-weather sky of sun and "
                  "sky, brighter about the sun and at the horizon")
      ->type_name("KIND")
      ->check(one_of("sky", {"even", "perez"}));
  command
      .add_option_function<std::string>(
          "--date", [&arguments](const std::string& text) { arguments.date = parse_date(text); },
          "date of the instant for --sky perez, such as 06-21")
      ->type_name("MM-DD");
  command
      .add_option("--up", arguments.up,
                  "axis that points to the zenith, y or z (default: that of the scene's sky or "
                  "cameras, else z where the model is longer along y, else y; z with --udales)")
      ->type_name("AXIS")
      ->check(one_of("axis", {"y", "z"}));
  add_north(command, arguments.north_degrees);
}

void add_hours(CLI::App& command, ShortwaveArguments& arguments) {
  command
      .add_option("--weather", arguments.weather,
                  "sums over the hours of a year, in place of --sun, --direct and --diffuse: .epw "
                  "(EnergyPlus) or .wea (RADIANCE)")
      ->type_name("FILE");
  command
      .add_option_function<std::string>(
          "--days", [&arguments](const std::string& text) { arguments.days = parse_days(text); },
          "days of --weather: 06-21, or 06-01..08-31 (default: the year)")
      ->type_name("MM-DD[..MM-DD]");
  command
      .add_option("--hourly", arguments.hourly,
                  "also hours.csv and net.npy, with --points total.npy, in this folder: hours x "
                  "facets or points, W/m2")
      ->type_name("FOLDER");
  command
      .add_option("--rays", arguments.rays,
                  fmt::format("fewest shadow rays of a facet for each place of the sun, a power of "
                              "two from 64 to 1024 (default {}; {} with --weather)",
                              rays_of_one_sun, rays_of_many_suns))
      ->type_name("N")
      ->check(CLI::Range(rays_of_many_suns, rays_of_one_sun).description(""))
      ->check(power_of_two());
}

void add_points(CLI::App& command, ShortwaveArguments& arguments) {
  command
      .add_option("--points", arguments.points,
                  "also light at points: CSV with columns x,y,z,nx,ny,nz in the scene file's unit")
      ->type_name("FILE");
  command
      .add_option("--points-output", arguments.points_output,
                  "CSV: the points with sky_view_factor, direct, diffuse, reflected, total")
      ->type_name("FILE")
      ->check(with_extension({".csv"}));
}

void add_udales(CLI::App& command, ShortwaveArguments& arguments) {
  command
      .add_option("--udales", arguments.udales,
                  "also svf.inp, netsw.inp, vfsparse.inp and Sdir.txt of uDALES in this folder")
      ->type_name("FOLDER");
  command.add_flag("--udales-albedos", arguments.has_udales_albedos,
                   "albedos of the facets by facets.inp and factypes.inp of the case in that "
                   "folder, in place of --albedo");
  command.add_option("--case", arguments.number, "number of uDALES' case (default 001)")
      ->type_name("NNN")
      ->check(CLI::Validator(
          [](const std::string& text) {
            const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
            return text.size() == 3 && std::ranges::all_of(text, is_digit)
                       ? std::string()
                       : fmt::format("three digits are needed, not '{}'", text);
          },
          std::string{}));
}

// Throws unless what `option` needs is there.
void require(bool is_there, const char* option, const char* sentence) {
  if (!is_there) throw CLI::ValidationError(option, sentence);
}

}  // namespace

bool DaySpan::has(const HourOfYear& hour) const {
  const std::pair day(hour.month, hour.day), begin(first.month, first.day),
      end(last.month, last.day);
  if (begin <= end) return begin <= day && day <= end;
  return begin <= day || day <= end;
}

void ShortwaveArguments::add_to(CLI::App& command) {
  add_facet_geometry(command, scene);
  command
      .add_option(
          "-o,--output", output,
          "CSV with a line for each facet: sky_view_factor, direct, diffuse, reflected, net")
      ->required()
      ->type_name("FILE")
      ->check(with_extension({".csv"}));
  auto* given = command.add_option("--albedo", albedo, "albedo of all facets")
                    ->type_name("A")
                    ->check(number_within(0.0, highest_albedo, "an albedo"));
  command
      .add_option("--surfaces", surfaces,
                  "CSV: surface (a name or a pattern), albedo; in place of --albedo")
      ->type_name("FILE")
      ->excludes(given);
  add_sun_and_sky(command, *this);
  add_hours(command, *this);
  add_points(command, *this);
  add_udales(command, *this);
  add_target_error(command, target_error, "Options");
}

void ShortwaveArguments::check() const {
  const bool has_sun = direct.value_or(0.0) > 0.0;
  require(!has_sun || sun, "--direct", "the sun needs a place; give --sun ALTITUDE,AZIMUTH");
  require(!has_udales_albedos || !udales.empty(), "--udales-albedos",
          "the case lies in --udales FOLDER; give the folder as well");
  require(!has_udales_albedos || (!albedo && surfaces.empty()), "--udales-albedos",
          "albedos come from one place; leave out --albedo and --surfaces");
  require(albedo || !surfaces.empty() || has_udales_albedos ||
              (weather.empty() && !has_sun && !(diffuse.value_or(0.0) > 0.0)),
          "--albedo", "light is reflected by albedos; give --albedo A, or --surfaces FILE.csv");
  require(weather.empty() || (!sun && !direct && !diffuse), "--weather",
          "the sun and the sky of its hours stand in place of --sun, --direct and --diffuse; give "
          "either");
  require(weather.empty() || udales.empty(), "--udales",
          "its files have one instant and not the hours of --weather; give --sun, --direct and "
          "--diffuse");
  require(!weather.empty() || !days, "--days", "days are those of --weather FILE; give it as well");
  require(!weather.empty() || hourly.empty(), "--hourly",
          "hours are those of --weather FILE; give it as well");
  require(!has_perez_sky() || !weather.empty() || (sun && date), "--sky",
          "Perez' sky follows from the sun and the date; give --sun ALTITUDE,AZIMUTH and --date "
          "MM-DD, or --weather FILE");
  require(!date || (has_perez_sky() && weather.empty()), "--date",
          "the date is that of an instant under --sky perez; leave it out, or give --sky perez and "
          "no --weather");
  require(!udales.empty() || !number, "--case",
          "the number names the files of --udales FOLDER; give the folder as well");
  require(points.empty() == points_output.empty(), points.empty() ? "--points-output" : "--points",
          "points are read from --points FILE and written to --points-output FILE; give both");
}

}  // namespace lightwell
