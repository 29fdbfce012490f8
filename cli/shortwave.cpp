// Sky view factors, and sun and sky with all reflections, of the facets of a scene.
#include "radiosity/radiation/shortwave.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <optional>
#include <string>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/compass.h"
#include "cli/facet_geometry.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/radiating_surfaces.h"
#include "cli/report.h"
#include "cli/udales_files.h"
#include "radiosity/radiation/sky_exposure.h"
#include "scene/atomic_file.h"
#include "scene/io/comma_fields.h"

namespace lightwell {
namespace {

struct ShortwaveArguments {
  std::string scene, surfaces, output, udales, number = "001", up;
  std::optional<double> albedo{};
  std::optional<std::pair<double, double>> sun{};  // altitude, azimuth, degrees
  double direct = 0.0, diffuse = 0.0;              // W/m^2
  double north_degrees = 0.0;
  double target_error = 1e-3;

  // Models of uDALES have z up.
  std::string zenith() const { return up.empty() && !udales.empty() ? "z" : up; }
  bool has_light() const { return direct > 0.0 || diffuse > 0.0; }
};

struct Shortwave {
  FacetViewFactors found;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  Eigen::ArrayXd albedo, sky_view, direct, diffuse;
  ShortwaveExchange exchange;
};

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

void check_arguments(const ShortwaveArguments& arguments) {
  if (arguments.direct > 0.0 && !arguments.sun) {
    throw CLI::ValidationError("--direct", "the sun needs a place; give --sun ALTITUDE,AZIMUTH");
  }
  if (arguments.has_light() && !arguments.albedo && arguments.surfaces.empty()) {
    throw CLI::ValidationError(
        "--albedo", "light is reflected by albedos; give --albedo A, or --surfaces FILE.csv");
  }
}

Eigen::ArrayXd albedos_of(const ShortwaveArguments& arguments, const ViewFactorRows& rows) {
  if (!arguments.surfaces.empty()) return read_albedos(arguments.surfaces, rows);
  return Eigen::ArrayXd::Constant(rows.count(), arguments.albedo.value_or(0.0));
}

Shortwave shortwave_of(const ShortwaveArguments& arguments, const FacetGeometry& geometry,
                       const Feedback& feedback) {
  const auto& [console, report] = feedback;
  Stopwatch watch;
  FacetViewFactorOptions options{.target_error = arguments.target_error,
                                 .progress = console.progress()};
  Shortwave of;
  // Mistakes in the table are found before the long work.
  options.rows_found = [&](const ViewFactorRows& rows) { of.albedo = albedos_of(arguments, rows); };
  options.phase_done = [&](const char* phase) { report.add_phase(phase, watch.lap()); };
  of.found = facet_view_factors(geometry.numbered, geometry.check, options);
  console.finish_phase();
  stop_if_interrupted();
  const Sky compass =
      compass_of(geometry.numbered.scene, arguments.north_degrees, arguments.zenith());
  of.up = compass.up;
  of.sky_view = sky_view_factors(of.found, compass.up);
  stop_if_interrupted();
  of.diffuse = arguments.diffuse * of.sky_view;
  of.direct = Eigen::ArrayXd::Zero(of.found.rows.count());
  if (arguments.direct > 0.0) {
    const auto [altitude, azimuth] = *arguments.sun;
    of.direct = arguments.direct * sun_factors(of.found, sky_direction(compass, azimuth, altitude));
  }
  report.add_phase("sun_and_sky", watch.lap());
  of.exchange = shortwave_exchange(of.found.factors, of.direct + of.diffuse, of.albedo);
  report.add_phase("exchange", watch.lap());
  return of;
}

void write_rows(const std::string& file, const Shortwave& of) {
  AtomicStream target(file);
  std::ostream& out = target.stream();
  out << "row,surface,facet,area,albedo,sky_view_factor,direct,diffuse,reflected,net\n";
  const ViewFactorRows& rows = of.found.rows;
  for (int i = 0; i < rows.count(); ++i) {
    const auto r = static_cast<std::size_t>(i);
    out << fmt::format("{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", i + 1,
                       quoted_field(rows.name[r]), rows.facet[r], of.found.factors.area[r],
                       of.albedo[i], of.sky_view[i], of.direct[i], of.diffuse[i],
                       of.exchange.reflected[i], of.exchange.net[i]);
  }
  target.commit();
}

Json facts_of(const Shortwave& of) {
  const auto& area = of.found.factors.area;
  const Eigen::Map<const Eigen::ArrayXd> A(area.data(), static_cast<Eigen::Index>(area.size()));
  const double all = A.sum();
  return {{"rows", of.found.rows.count()},
          {"area", all},
          {"up", {of.up.x(), of.up.y(), of.up.z()}},
          {"mean_sky_view_factor", all > 0.0 ? Json((A * of.sky_view).sum() / all) : Json()},
          {"arriving", of.exchange.arriving},
          {"absorbed", of.exchange.absorbed},
          {"escaped", of.exchange.escaped},
          {"error_estimate", of.found.error ? Json(*of.found.error) : Json()}};
}

std::string facts_text(const Json& facts) {
  const auto value = [&](const char* key) {
    return facts[key].is_number() ? fmt::format("{:.6g}", facts[key].get<double>()) : "-";
  };
  std::string text =
      fmt::format("{} facets, up is {}, mean sky view factor {}\n", facts["rows"].get<int>(),
                  facts["up"].dump(), value("mean_sky_view_factor"));
  text += fmt::format("from sun and sky {} W, absorbed {} W, reflected away {} W\n",
                      value("arriving"), value("absorbed"), value("escaped"));
  if (facts.contains("nnz")) text += fmt::format("nnz = {}\n", facts["nnz"].get<std::int64_t>());
  return text;
}

int shortwave(const ShortwaveArguments& arguments, Console& console) {
  Report report(console.options());
  const FacetGeometry geometry = read_facet_geometry(arguments.scene, console.options());
  if (!arguments.surfaces.empty()) note_input(arguments.surfaces);
  std::optional<OutputFolder> folder;
  std::vector<std::filesystem::path> files{arguments.output};
  if (!arguments.udales.empty()) {
    folder.emplace(arguments.udales);
    for (auto& file : udales_files(arguments.udales, arguments.number)) files.push_back(file);
  }
  require_different(files);
  for (const auto& file : files) require_writable(file);
  for (const std::string& note : geometry.notes) console.say("note: " + note);
  const Shortwave of = shortwave_of(arguments, geometry, {console, report});
  Json facts = facts_of(of);
  write_rows(arguments.output, of);
  if (folder) {
    facts["nnz"] = write_udales(arguments.udales, arguments.number,
                                {.factors = of.found.factors,
                                 .sky_view = of.sky_view,
                                 .direct = of.direct,
                                 .net = of.exchange.net});
  }
  for (const auto& file : files) report.add_file(file);
  for (const auto& [key, value] : facts.items()) report.add(key, value);
  const CommonOptions& common = console.options();
  if (!common.json && !common.quiet) fmt::print("{}", facts_text(facts));
  report.print();
  return of.found.is_short(arguments.target_error) ? exit_not_accurate : exit_done;
}

// Accepts numbers from 0 to `most`.
CLI::Validator from_zero_to(double most, const char* what) {
  return {[most, what](std::string& text) {
            const auto value = parsed_number(text);
            return value && *value >= 0.0 && *value <= most
                       ? std::string()
                       : fmt::format("{} from 0 to {:g} is needed, not '{}'", what, most, text);
          },
          std::string{}};
}

void add_light(CLI::App& command, ShortwaveArguments& arguments) {
  constexpr double brightest = 1e6;  // W/m^2
  command
      .add_option_function<std::string>(
          "--sun", [&arguments](const std::string& text) { arguments.sun = parse_sun(text); },
          "place of the sun in degrees: altitude, and azimuth from north by east, such as 45,180")
      ->type_name("ALT,AZ");
  command.add_option("--direct", arguments.direct, "irradiance across the sun's rays (default 0)")
      ->type_name("W/m2")
      ->check(from_zero_to(brightest, "an irradiance"));
  command
      .add_option("--diffuse", arguments.diffuse,
                  "irradiance of open level ground by an even sky (default 0)")
      ->type_name("W/m2")
      ->check(from_zero_to(brightest, "an irradiance"));
  command
      .add_option("--up", arguments.up,
                  "axis that points to the zenith, y or z (default: that of the scene's sky or "
                  "cameras, else z where the model is longer along y, else y; z with --udales)")
      ->type_name("AXIS")
      ->check(one_of("axis", {"y", "z"}));
  add_north(command, arguments.north_degrees);
}

void add_udales(CLI::App& command, ShortwaveArguments& arguments) {
  command
      .add_option("--udales", arguments.udales,
                  "also svf.inp, netsw.inp, vfsparse.inp and Sdir.txt of uDALES in this folder")
      ->type_name("FOLDER");
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

}  // namespace

Action add_shortwave(CLI::App& command) {
  const auto arguments = std::make_shared<ShortwaveArguments>();
  command.description(
      "Sky view factors of facets, and the light of sun and sky that facets absorb, with all "
      "reflections.");
  add_facet_geometry(command, arguments->scene);
  command
      .add_option(
          "-o,--output", arguments->output,
          "CSV with a line for each facet: sky_view_factor, direct, diffuse, reflected, net")
      ->required()
      ->type_name("FILE")
      ->check(with_extension({".csv"}));
  auto* albedo = command.add_option("--albedo", arguments->albedo, "albedo of all facets")
                     ->type_name("A")
                     ->check(from_zero_to(highest_albedo, "an albedo"));
  command
      .add_option("--surfaces", arguments->surfaces,
                  "CSV: surface (a name or a pattern), albedo; in place of --albedo")
      ->type_name("FILE")
      ->excludes(albedo);
  add_light(command, *arguments);
  add_udales(command, *arguments);
  add_target_error(command, arguments->target_error, "Options");
  command.footer(
      "Example: lightwell shortwave city.stl --albedo 0.2 --sun 45,180 --direct 800 --diffuse 100 "
      "-o k.csv");
  command.callback([arguments] { check_arguments(*arguments); });
  return [arguments](Console& console) { return shortwave(*arguments, console); };
}

}  // namespace lightwell
