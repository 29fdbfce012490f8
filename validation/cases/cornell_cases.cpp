#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "radiosity/solve.h"
#include "raytrace/readings/probe.h"
#include "scene/io/comma_fields.h"
#include "scene/io/read_scene.h"
#include "validation/cases/case_lists.h"
#include "validation/cases/reference_data.h"

namespace lightwell {
namespace {

// cornell/README.md has these bounds of the solution on the mesh.
constexpr double rmse_bound = 0.015, percentile_bound = 0.04;
// The reference's own error, relative RMS.
constexpr double reference_error = 0.0011;

// Columns of cornell/reference/irradiance.csv: surface, x, y, z (mm), normal, three bands.
struct CornellPoints {
  std::vector<Probe> probes{};
  BandArray E{};
};

CornellPoints cornell_points(double metres_per_unit) {
  const EmbeddedFile file("irradiance.csv", validation_data::cornell_irradiance_csv);
  CornellPoints points{.probes = read_probes(file.path(), metres_per_unit)};
  points.E.resize(static_cast<Eigen::Index>(points.probes.size()), 3);
  std::string_view text = validation_data::cornell_irradiance_csv;
  text.remove_prefix(text.find('\n') + 1);
  for (Eigen::Index i = 0; i < points.E.rows(); ++i) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    constexpr std::size_t first = 7;
    const std::vector<std::string_view> fields = comma_fields(line);
    for (int k = 0; k < 3; ++k) {
      points.E(i, k) = std::stof(std::string(fields.at(first + static_cast<std::size_t>(k))));
    }
  }
  return points;
}

ComparedValues cornell_box(const Progress& progress) {
  const EmbeddedFile file("cornell.toml", validation_data::cornell_toml);
  const Scene scene = read_toml(file.path());
  SolveOptions options;
  options.run.progress = progress;
  const SolvedScene solved = solve_scene(scene, options);
  const CornellPoints points = cornell_points(scene.metres_per_unit);
  const ElementCaster caster(solved.mesh);
  const BandArray E = interpolate_irradiance(caster, solved.solution, points.probes);
  const Eigen::ArrayXXd off = (E - points.E).cast<double>().abs();
  Eigen::ArrayXXd relative = off / points.E.cast<double>();
  double* const begin = relative.data();
  double* const at = begin + static_cast<Eigen::Index>(0.95 * static_cast<double>(relative.size()));
  std::nth_element(begin, at, begin + relative.size());

  const EnergyBalance& energy = solved.solution.energy;
  // Radiances 17.0, 11.8 and 4.0 W/(m^2 sr) of a light of 130 mm x 105 mm.
  const double emitted = std::numbers::pi * (17.0 + 11.8 + 4.0) * 0.130 * 0.105;
  return {{"relative RMS error of irradiance", 0.0,
           std::sqrt(off.square().mean()) / points.E.cast<double>().mean(), rmse_bound},
          {"95th percentile of the relative error", 0.0, *at, percentile_bound},
          {"mean irradiance, W/m2", points.E.cast<double>().mean(), E.cast<double>().mean(),
           (reference_error + solved.solution.error_estimate) * points.E.cast<double>().mean()},
          {"emitted power, W", emitted, energy.emitted, 1e-5 * emitted},
          {"absorbed, escaped and unshot power, W", emitted,
           energy.absorbed + energy.escaped + energy.unshot, 1e-4 * emitted}};
}

}  // namespace

std::vector<ValidationCase> cornell_cases() {
  return {{.id = "cornell-box",
           .group = "Cornell box",
           .title = "the Cornell box at 1863 points, solved with default options",
           .source = "converged final gathering and path tracing with Mitsuba 3.9.1 "
                     "(cornell/reference/README.md), 0.11 % RMS; pi L A of the light",
           .reason = "1.5 % RMS and 4 % for 95 of 100 points: the bounds of ./cornell/run; the "
                     "reference's 0.11 % and the solve's own estimate for the mean; 1e-5 and 1e-4 "
                     "of powers of floats",
           .compute = cornell_box}};
}

}  // namespace lightwell
