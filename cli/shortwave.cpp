// Sky view factors, and sun and sky with all reflections, of the facets of a scene and of points.
#include "cli/shortwave.h"

#include <fmt/format.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "cli/commands.h"
#include "cli/facet_geometry.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/radiating_surfaces.h"
#include "cli/udales_files.h"
#include "daylight/year_files.h"
#include "raytrace/readings/exposure_points.h"
#include "scene/errors.h"
#include "scene/sun_position.h"
#include "viewer/export/compass.h"

namespace lightwell {
namespace {

// Files that the command writes besides the table of facets.
struct ShortwaveOutputs {
  // Throws std::runtime_error if a file cannot be written.
  explicit ShortwaveOutputs(const ShortwaveArguments& arguments);

  std::optional<OutputFolder> udales{}, hourly{};
  std::vector<std::filesystem::path> files{};
};

ShortwaveOutputs::ShortwaveOutputs(const ShortwaveArguments& arguments) : files{arguments.output} {
  if (!arguments.points_output.empty()) files.emplace_back(arguments.points_output);
  if (!arguments.udales.empty()) {
    udales.emplace(arguments.udales);
    for (auto& file : udales_files(arguments.udales, arguments.case_number())) {
      files.push_back(file);
    }
  }
  if (!arguments.hourly.empty()) {
    hourly.emplace(arguments.hourly);
    files.push_back(*hourly / "hours.csv");
    files.push_back(*hourly / "net.npy");
    if (!arguments.points.empty()) files.push_back(*hourly / "total.npy");
  }
  require_different(files);
  for (const auto& file : files) require_writable(file);
}

// The hours of the weather file that the command computes.
std::vector<SunHour> hours_of(const ShortwaveArguments& arguments, const Weather& weather) {
  std::vector<SunHour> hours = sun_hours(weather);
  std::erase_if(hours, [&](const SunHour& hour) {
    return arguments.days && !arguments.days->has(hour_of_year(hour.number, weather.is_leap_year));
  });
  if (hours.empty()) {
    throw InputError(fmt::format("{}: no hour of the days asked for has light; give other '--days'",
                                 arguments.weather));
  }
  return hours;
}

// Reads what is short before the long work.
ShortwaveResult read_inputs(const ShortwaveArguments& arguments, const Scene& scene) {
  for (const std::string* file : {&arguments.surfaces, &arguments.points, &arguments.weather}) {
    if (!file->empty()) note_input(*file);
  }
  ShortwaveResult of;
  if (!arguments.points.empty()) of.probes = read_probes(arguments.points, scene.metres_per_unit);
  if (!arguments.weather.empty()) {
    of.weather = read_weather(arguments.weather);
    of.hours = hours_of(arguments, of.weather);
  }
  return of;
}

Eigen::ArrayXd albedos_of(const ShortwaveArguments& arguments, const ViewFactorRows& rows) {
  if (!arguments.surfaces.empty()) return read_albedos(arguments.surfaces, rows);
  if (arguments.has_udales_albedos) {
    return read_udales_albedos(arguments.udales, arguments.case_number(), rows.count());
  }
  return Eigen::ArrayXd::Constant(rows.count(), arguments.albedo.value_or(0.0));
}

std::vector<SunAndSky> instants_of(const ShortwaveArguments& arguments, const ShortwaveResult& of,
                                   const Sky& compass) {
  const auto under_sky = [&](const SunAndSky& light, const HourOfYear& date) {
    if (!arguments.has_perez_sky()) return light;
    const int year = year_of_dates(of.weather.is_leap_year);
    return under_perez_sky(light, compass.up, day_of_year(year, date.month, date.day));
  };
  if (!of.is_of_hours()) {
    SunAndSky light{.direct = arguments.direct.value_or(0.0),
                    .diffuse = arguments.diffuse.value_or(0.0)};
    if (arguments.sun) {
      light.sun = sky_direction(compass, arguments.sun->second, arguments.sun->first);
    }
    return {arguments.date ? under_sky(light, *arguments.date) : light};
  }
  std::vector<SunAndSky> instants;
  for (const SunHour& hour : of.hours) {
    instants.push_back(
        under_sky({.sun = sky_direction(compass, hour.azimuth_degrees, hour.altitude_degrees),
                   .direct = hour.direct_normal,
                   .diffuse = hour.diffuse_horizontal},
                  hour_of_year(hour.number, of.weather.is_leap_year)));
  }
  return instants;
}

// Sums of instants, and the files of every hour.
class ShortwaveSink {
 public:
  ShortwaveSink(const ShortwaveArguments& arguments, ShortwaveResult& of) : of_(of) {
    const auto rows = of.albedo.size(), points = of.point_sky_view.size();
    for (auto* sum : {&of.sums.direct, &of.sums.diffuse, &of.sums.reflected, &of.sums.net}) {
      *sum = Eigen::ArrayXd::Zero(rows);
    }
    for (auto* sum : {&of.sums.point_direct, &of.sums.point_diffuse, &of.sums.point_reflected}) {
      *sum = Eigen::ArrayXd::Zero(points);
    }
    if (arguments.hourly.empty()) return;
    const std::filesystem::path folder = arguments.hourly;
    net_.emplace(folder / "net.npy", static_cast<int>(rows));
    if (points > 0) total_.emplace(folder / "total.npy", static_cast<int>(points));
  }

  void add(const ShortwaveInstant& light) {
    ShortwaveSums& sums = of_.sums;
    sums.direct += light.direct;
    sums.diffuse += light.diffuse;
    sums.reflected += light.exchange.reflected;
    sums.net += light.exchange.net;
    sums.point_direct += light.point_direct;
    sums.point_diffuse += light.point_diffuse;
    sums.point_reflected += light.point_reflected;
    of_.powers.push_back({.arriving = light.exchange.arriving,
                          .absorbed = light.exchange.absorbed,
                          .escaped = light.exchange.escaped});
    if (net_) net_->append(light.exchange.net.cast<float>());
    if (total_) {
      total_->append(
          (light.point_direct + light.point_diffuse + light.point_reflected).cast<float>());
    }
  }

  void commit() {
    if (net_) net_->commit();
    if (total_) total_->commit();
  }

 private:
  ShortwaveResult& of_;
  std::optional<NumpyRows> net_{}, total_{};
};

void compute_shortwave(const ShortwaveArguments& arguments, const FacetGeometry& geometry,
                       const Feedback& feedback, ShortwaveResult& of) {
  const auto& [console, report] = feedback;
  Stopwatch watch;
  FacetViewFactorOptions options{.target_error = arguments.target_error,
                                 .progress = console.progress()};
  // Mistakes in the table are found before the long work.
  options.rows_found = [&](const ViewFactorRows& rows) { of.albedo = albedos_of(arguments, rows); };
  options.phase_done = [&](const char* phase) { report.add_phase(phase, watch.lap()); };
  of.found = facet_view_factors(geometry.numbered, geometry.check, options);
  console.finish_phase();
  stop_if_interrupted();
  const Sky compass =
      compass_of(geometry.numbered.scene, arguments.north_degrees, arguments.zenith());
  of.up = compass.up;
  const ElementCaster caster(of.found.mesh);
  ShortwaveModel model(of.found, caster, exposure_points(caster, of.probes), compass.up,
                       console.progress());
  if (arguments.has_perez_sky()) model.see_dome(console.progress());
  of.sky_view = model.sky_view();
  of.point_sky_view = model.points().sky;
  console.finish_phase();
  report.add_phase("sky", watch.lap());
  ShortwaveSink sink(arguments, of);
  const int usual_rays = of.is_of_hours() ? rays_of_many_suns : rays_of_one_sun;
  model.run(
      instants_of(arguments, of, compass), of.albedo, arguments.rays.value_or(usual_rays),
      [&](int, const ShortwaveInstant& light) { sink.add(light); }, console.progress());
  sink.commit();
  console.finish_phase();
  stop_if_interrupted();
  report.add_phase("sun_and_exchange", watch.lap());
}

Json facts_of(const ShortwaveArguments& arguments, const ShortwaveResult& of) {
  const auto& area = of.found.factors.area;
  const Eigen::Map<const Eigen::ArrayXd> A(area.data(), static_cast<Eigen::Index>(area.size()));
  const double all = A.sum();
  HourPower sum;
  for (const HourPower& power : of.powers) {
    sum.arriving += power.arriving;
    sum.absorbed += power.absorbed;
    sum.escaped += power.escaped;
  }
  Json facts{{"rows", of.found.rows.count()},
             {"area", all},
             {"up", {of.up.x(), of.up.y(), of.up.z()}},
             {"mean_sky_view_factor", all > 0.0 ? Json((A * of.sky_view).sum() / all) : Json()}};
  constexpr double kilo = 1e3;
  const double unit = of.is_of_hours() ? kilo : 1.0;
  const char* const suffix = of.is_of_hours() ? "_kwh" : "";
  facts[fmt::format("arriving{}", suffix)] = sum.arriving / unit;
  facts[fmt::format("absorbed{}", suffix)] = sum.absorbed / unit;
  facts[fmt::format("escaped{}", suffix)] = sum.escaped / unit;
  facts["sky"] = arguments.sky;
  if (of.is_of_hours()) facts["hours"] = of.hours.size();
  if (!of.probes.empty()) facts["points"] = of.probes.size();
  facts["error_estimate"] = of.found.error ? Json(*of.found.error) : Json();
  return facts;
}

std::string shortwave_text(const Json& facts) {
  const auto value = [&](const std::string& key) {
    return facts[key].is_number() ? fmt::format("{:.6g}", facts[key].get<double>()) : "-";
  };
  const bool is_of_hours = facts.contains("hours");
  const std::string suffix = is_of_hours ? "_kwh" : "", unit = is_of_hours ? "kWh" : "W";
  std::string text =
      fmt::format("{} facets, up is {}, mean sky view factor {}\n", facts["rows"].get<int>(),
                  facts["up"].dump(), value("mean_sky_view_factor"));
  if (is_of_hours) text += fmt::format("{} hours with light\n", value("hours"));
  text += fmt::format("from sun and sky {0} {3}, absorbed {1} {3}, reflected away {2} {3}\n",
                      value("arriving" + suffix), value("absorbed" + suffix),
                      value("escaped" + suffix), unit);
  if (facts.contains("nnz")) text += fmt::format("nnz = {}\n", facts["nnz"].get<std::int64_t>());
  return text;
}

int shortwave(const ShortwaveArguments& arguments, Console& console) {
  Report report(console.options());
  const FacetGeometry geometry = read_facet_geometry(arguments.scene, console.options());
  ShortwaveResult of = read_inputs(arguments, geometry.numbered.scene);
  const ShortwaveOutputs outputs(arguments);
  for (const std::string& note : geometry.notes) console.say("note: " + note);
  for (const std::string& note : of.weather.notes) console.say("note: " + note);
  compute_shortwave(arguments, geometry, {console, report}, of);
  Json facts = facts_of(arguments, of);
  write_shortwave_rows(arguments.output, of);
  if (!of.probes.empty()) {
    write_shortwave_points(arguments.points_output, of, geometry.numbered.scene.metres_per_unit);
  }
  if (outputs.hourly) write_shortwave_hours(*outputs.hourly / "hours.csv", of);
  if (outputs.udales) {
    facts["nnz"] = write_udales(arguments.udales, arguments.case_number(),
                                {.factors = of.found.factors,
                                 .sky_view = of.sky_view,
                                 .direct = of.sums.direct,
                                 .net = of.sums.net});
  }
  for (const auto& file : outputs.files) report.add_file(file);
  for (const auto& [key, value] : facts.items()) report.add(key, value);
  const CommonOptions& common = console.options();
  if (!common.json && !common.quiet) fmt::print("{}", shortwave_text(facts));
  report.print();
  return of.found.is_short(arguments.target_error) ? exit_not_accurate : exit_done;
}

}  // namespace

Action add_shortwave(CLI::App& command) {
  const auto arguments = std::make_shared<ShortwaveArguments>();
  command.description(
      "Sky view factors of facets and points, and the light of sun and sky that facets absorb,\n"
      "with all reflections: at an instant, or over the hours of a year.");
  arguments->add_to(command);
  command.footer(
      "Example: lightwell shortwave city.stl --albedo 0.2 --sun 45,180 --direct 800 --diffuse 100 "
      "-o k.csv");
  command.callback([arguments] { arguments->check(); });
  return [arguments](Console& console) { return shortwave(*arguments, console); };
}

}  // namespace lightwell
