#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/report.h"
#include "radiosity/radiation/shortwave_model.h"
#include "raytrace/readings/probe.h"
#include "scene/io/weather/sun_hours.h"

namespace lightwell {

/// Days of a year, the last included; a span may go on into the next year.
struct DaySpan {
  HourOfYear first{.month = 1, .day = 1}, last{.month = 12, .day = 31};

  bool has(const HourOfYear& hour) const;
};

/// Arguments of 'lightwell shortwave'.
struct ShortwaveArguments {
  std::string scene, surfaces, output, udales, up;
  std::string points, points_output;
  std::string weather, hourly;
  std::optional<DaySpan> days{};
  std::string sky = "even";
  std::optional<HourOfYear> date{};     ///< of the instant, for Perez' sky
  std::optional<std::string> number{};  ///< of uDALES' case
  std::optional<double> albedo{};
  std::optional<std::pair<double, double>> sun{};  ///< altitude, azimuth, degrees
  std::optional<double> direct{}, diffuse{};       ///< W/m^2
  std::optional<int> rays{};
  bool has_udales_albedos = false;
  double north_degrees = 0.0;
  double target_error = 1e-3;

  void add_to(CLI::App& command);
  /// Throws CLI::ValidationError for options that do not go together.
  void check() const;
  bool has_perez_sky() const { return sky == "perez"; }
  /// The option --up, or z for models of uDALES; empty: by the scene.
  std::string zenith() const { return up.empty() && !udales.empty() ? "z" : up; }
  std::string case_number() const { return number.value_or("001"); }
};

/// Power of an hour on all rows, W.
struct HourPower {
  double arriving = 0.0, absorbed = 0.0, escaped = 0.0;
};

/// Light on rows and points, W/m^2; of many hours, their sum, Wh/m^2.
struct ShortwaveSums {
  Eigen::ArrayXd direct{}, diffuse{}, reflected{}, net{};
  Eigen::ArrayXd point_direct{}, point_diffuse{}, point_reflected{};
};

/// Results of the command.
struct ShortwaveResult {
  FacetViewFactors found{};
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  Eigen::ArrayXd albedo{}, sky_view{}, point_sky_view{};
  std::vector<Probe> probes{};
  Weather weather{};
  std::vector<SunHour> hours{};     ///< with --weather
  std::vector<HourPower> powers{};  ///< of each instant
  ShortwaveSums sums{};

  bool is_of_hours() const { return !hours.empty(); }
};

/// Writes a line for each row. Each function throws std::runtime_error with the file and the
/// reason.
void write_shortwave_rows(const std::filesystem::path& csv, const ShortwaveResult& of);
/// Writes a line for each point.
void write_shortwave_points(const std::filesystem::path& csv, const ShortwaveResult& of,
                            double metres_per_unit);
/// Writes a line for each hour with light.
void write_shortwave_hours(const std::filesystem::path& csv, const ShortwaveResult& of);

}  // namespace lightwell
