#include "radiosity/refine/illuminance_bound.h"

#include <algorithm>
#include <cmath>

#include "radiosity/refine/error_reference.h"

namespace lightwell {
namespace {

// lx of 1 W/m^2 in every band.
double lux_of_grey(const Bands& bands) {
  return luminous(bands, constant_spectrum(bands, 1.0f));
}

// Values relative to error_references(), in lx.
Eigen::ArrayXf in_lux(const PatchMesh& mesh, const RadiositySolution& solution,
                      const Eigen::ArrayXf& relative) {
  const Eigen::ArrayXd reference = error_references(mesh, solution.irradiance(), solution.parts);
  return (lux_of_grey(solution.bands) * reference * relative.cast<double>()).cast<float>();
}

}  // namespace

Eigen::ArrayXf illuminance_bounds(const PatchMesh& mesh, const RadiositySolution& solution) {
  const Eigen::ArrayXf relative = error_bound(solution);
  if (relative.size() == 0) return {};
  return in_lux(mesh, solution, relative);
}

Eigen::ArrayXf illuminance_errors(const PatchMesh& mesh, const RadiositySolution& solution) {
  if (solution.gather_noise.size() == 0) return {};
  if (solution.interpolation_error.size() > 0) return 0.5f * illuminance_bounds(mesh, solution);
  Eigen::ArrayXf error = in_lux(mesh, solution, solution.gather_noise);
  const BandArray E = solution.irradiance();
  for (int e = 0; e < mesh.element_count(); ++e) {
    double low = INFINITY, high = 0.0;
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      const double lux = luminous(solution.bands, E.row(mesh.corners[e][c]).transpose());
      low = std::min(low, lux);
      high = std::max(high, lux);
    }
    error[e] = std::hypot(error[e], static_cast<float>(0.5 * (high - low)));
  }
  return error;
}

}  // namespace lightwell
