// Net radiant exchange of the surfaces of a scene.
#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/facet_geometry.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/radiating_surfaces.h"
#include "cli/report.h"
#include "cli/steps.h"
#include "radiosity/form_factors/facet_view_factors.h"
#include "radiosity/radiation/radiant_exchange.h"
#include "scene/atomic_file.h"
#include "scene/errors.h"
#include "scene/io/comma_fields.h"

namespace lightwell {
namespace {

struct RadiationArguments {
  std::string scene, surfaces, output, gebhart, script_f;
  double surroundings = 0.0;  // K
  double target_error = 1e-3;
  bool two_sided = false;
};

struct Radiating {
  FacetViewFactors found;
  ExchangeAreas areas;
  std::vector<RadiatingSurface> surfaces;
  RadiantExchange exchange;
};

void write_rows(const std::string& file, const Radiating& of) {
  AtomicStream target(file);
  std::ostream& out = target.stream();
  out << "row,surface,facet,side,area,emittance,kelvin,radiosity,irradiation,heat\n";
  const ViewFactorRows& rows = of.found.rows;
  for (int i = 0; i < rows.count(); ++i) {
    const auto r = static_cast<std::size_t>(i);
    out << fmt::format("{},{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", i + 1,
                       quoted_field(rows.name[r]), rows.facet[r],
                       rows.is_back[r] ? "back" : "front", of.areas.area[i],
                       of.surfaces[r].emittance, of.exchange.kelvin[i], of.exchange.radiosity[i],
                       of.exchange.irradiation[i], of.exchange.heat[i]);
  }
  target.commit();
}

// A line for each row; the last column is the surroundings.
void write_factors(const std::string& file, const Eigen::MatrixXd& factors) {
  AtomicStream target(file);
  for (Eigen::Index i = 0; i < factors.rows(); ++i) {
    for (Eigen::Index j = 0; j < factors.cols(); ++j) {
      target.stream() << (j > 0 ? "," : "") << fmt::format("{:.12g}", factors(i, j));
    }
    target.stream() << '\n';
  }
  target.commit();
}

// Area, mean temperature and heat of each surface, by the names of rows.
Json surface_facts(const Radiating& of) {
  struct Sum {
    double area = 0.0, kelvin = 0.0, heat = 0.0;
  };
  std::map<std::string, Sum> sums;
  for (int i = 0; i < of.found.rows.count(); ++i) {
    Sum& sum = sums[of.found.rows.name[static_cast<std::size_t>(i)]];
    sum.area += of.areas.area[i];
    sum.kelvin += of.areas.area[i] * of.exchange.kelvin[i];
    sum.heat += of.exchange.heat[i];
  }
  Json facts = Json::array();
  for (const auto& [name, sum] : sums) {
    facts.push_back({{"surface", name},
                     {"area", sum.area},
                     {"mean_kelvin", sum.area > 0.0 ? Json(sum.kelvin / sum.area) : Json()},
                     {"heat", sum.heat}});
  }
  return facts;
}

std::string facts_text(const Json& facts) {
  std::string text =
      fmt::format("{:<24} {:>12} {:>12} {:>14}\n", "surface", "area m2", "mean K", "heat W");
  for (const Json& each : facts["surfaces"]) {
    const Json& kelvin = each["mean_kelvin"];
    text += fmt::format("{:<24} {:>12.5g} {:>12} {:>14.6g}\n",
                        plain_lines(each["surface"].get<std::string>()), each["area"].get<double>(),
                        kelvin.is_number() ? fmt::format("{:.2f}", kelvin.get<double>()) : "-",
                        each["heat"].get<double>());
  }
  return text + fmt::format("{:<24} {:>12} {:>12} {:>14.6g}\n", "to the surroundings", "", "",
                            facts["to_surroundings"].get<double>());
}

// The exchange, whose faults are told of the surfaces by the names that the table has.
RadiantExchange named_exchange(const RadiationArguments& arguments, const Radiating& of) {
  try {
    return radiant_exchange(of.areas, of.surfaces, arguments.surroundings);
  } catch (const RadiatingSurfaceError& error) {
    const auto row = static_cast<std::size_t>(error.surface);
    const ViewFactorRows& rows = of.found.rows;
    throw InputError(fmt::format("{}: surface '{}', facet {}{}: {}", arguments.surfaces,
                                 rows.name[row], rows.facet[row],
                                 rows.is_back[row] != 0 ? " (back)" : "", error.fault));
  }
}

Radiating exchange_of(const RadiationArguments& arguments, const FacetGeometry& geometry,
                      const Feedback& feedback) {
  const auto& [console, report] = feedback;
  Stopwatch watch;
  FacetViewFactorOptions options{.target_error = arguments.target_error,
                                 .two_sided = arguments.two_sided,
                                 .progress = console.progress()};
  std::vector<RadiatingSurface> surfaces;
  // Mistakes in the table are found before the long work.
  options.rows_found = [&](const ViewFactorRows& rows) {
    if (rows.count() > most_radiating_surfaces) {
      throw InputError(fmt::format(
          "{}: {} facets are more than the {} whose exchange fits into "
          "memory; merge facets of one temperature",
          geometry.numbered.scene.file.string(), rows.count(), most_radiating_surfaces));
    }
    static_cast<void>(read_radiating_surfaces(arguments.surfaces, rows,
                                              std::vector<double>(rows.name.size(), 1.0)));
  };
  options.phase_done = [&](const char* phase) { report.add_phase(phase, watch.lap()); };
  Radiating of{.found = facet_view_factors(geometry.numbered, geometry.check, options)};
  console.finish_phase();
  stop_if_interrupted();
  of.areas = exchange_areas(of.found.factors);
  of.surfaces = read_radiating_surfaces(arguments.surfaces, of.found.rows, of.found.factors.area);
  of.exchange = named_exchange(arguments, of);
  report.add_phase("exchange", watch.lap());
  return of;
}

void write_results(const RadiationArguments& arguments, const Radiating& of, Report& report) {
  write_rows(arguments.output, of);
  report.add_file(arguments.output);
  if (arguments.gebhart.empty() && arguments.script_f.empty()) return;
  Eigen::ArrayXd emittance(of.areas.count());
  for (int i = 0; i < of.areas.count(); ++i) {
    emittance[i] = of.surfaces[static_cast<std::size_t>(i)].emittance;
  }
  if (!arguments.gebhart.empty()) {
    write_factors(arguments.gebhart, gebhart_factors(of.areas, emittance));
    report.add_file(arguments.gebhart);
  }
  if (!arguments.script_f.empty()) {
    write_factors(arguments.script_f, transfer_factors(of.areas, emittance));
    report.add_file(arguments.script_f);
  }
}

int radiation(const RadiationArguments& arguments, Console& console) {
  Report report(console.options());
  const FacetGeometry geometry = read_facet_geometry(arguments.scene, console.options());
  note_input(arguments.surfaces);
  require_different({arguments.output, arguments.gebhart, arguments.script_f});
  for (const std::string& file : {arguments.output, arguments.gebhart, arguments.script_f}) {
    if (!file.empty()) require_writable(file);
  }
  for (const std::string& note : geometry.notes) console.say("note: " + note);
  const Radiating of = exchange_of(arguments, geometry, {console, report});
  Json facts{{"rows", of.areas.count()},
             {"surfaces", surface_facts(of)},
             {"to_surroundings", of.exchange.to_surroundings},
             {"error_estimate", of.found.error ? Json(*of.found.error) : Json()}};
  for (const auto& [key, value] : facts.items()) report.add(key, value);
  write_results(arguments, of, report);
  const CommonOptions& common = console.options();
  if (!common.json && !common.quiet) fmt::print("{}", facts_text(facts));
  report.print();
  return of.found.is_short(arguments.target_error) ? exit_not_accurate : exit_done;
}

void add_factors(CLI::App& command, RadiationArguments& arguments) {
  command
      .add_option("--gebhart", arguments.gebhart,
                  "also Gebhart factors, .csv: a line for each row, the surroundings last")
      ->type_name("FILE")
      ->check(with_extension({".csv"}));
  command
      .add_option("--script-f", arguments.script_f,
                  "also transfer factors of Hottel and Sarofim, .csv: likewise")
      ->type_name("FILE")
      ->check(with_extension({".csv"}));
}

}  // namespace

Action add_radiation(CLI::App& command) {
  const auto arguments = std::make_shared<RadiationArguments>();
  command.description(
      "Net radiant heat of gray, diffuse surfaces from their temperatures and emittances.");
  add_facet_geometry(command, arguments->scene);
  command
      .add_option("--surfaces", arguments->surfaces,
                  "CSV: surface (a name or a pattern), emittance, and kelvin, celsius or heat (W)")
      ->required()
      ->type_name("FILE");
  command
      .add_option("-o,--output", arguments->output,
                  "CSV with a line for each facet: kelvin, radiosity, irradiation, heat")
      ->required()
      ->type_name("FILE")
      ->check(with_extension({".csv"}));
  command
      .add_option("--surroundings", arguments->surroundings,
                  "temperature behind openings, K (default 0: nothing comes from there)")
      ->type_name("K")
      ->check(CLI::Validator(
          [](std::string& text) {
            const auto value = parsed_number(text);
            return value && *value >= 0.0 && *value <= hottest_surface
                       ? std::string()
                       : fmt::format("a temperature from 0 to {:g} K is needed, not '{}'",
                                     hottest_surface, text);
          },
          std::string{}));
  add_factors(command, *arguments);
  add_target_error(command, arguments->target_error, "Options");
  command.add_flag("--two-sided", arguments->two_sided, "both sides of facets radiate");
  command.footer("Example: lightwell radiation room.stl --surfaces temperatures.csv -o heats.csv");
  return [arguments](Console& console) { return radiation(*arguments, console); };
}

}  // namespace lightwell
