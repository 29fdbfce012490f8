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

// Adds a share of the range of E over an element's corners to errors, lx per element.
void add_ranges(const PatchMesh& mesh, const Bands& bands, const BandArray& E, double share,
                Eigen::ArrayXf& error) {
  for (int e = 0; e < mesh.element_count(); ++e) {
    double low = INFINITY, high = 0.0;
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      const double lux = luminous(bands, E.row(mesh.corners[e][c]).transpose());
      low = std::min(low, lux);
      high = std::max(high, lux);
    }
    error[e] = std::hypot(error[e], static_cast<float>(share * (high - low)));
  }
}

// RMS error of caustics over an element, as a share of the range of its corners. A vertex has the
// mean of the elements around it. A step J in the middle of an element gives corners of J/4 and
// 3J/4, a range of J/2, and the error rises from J/4 to J/2 on either side of the step. Its square
// is (1/16 + 1/8 + 1/4) J^2 / 3 in the mean, 7/12 of the squared range. Of a step elsewhere it is
// less.
const double of_caustic_range = std::sqrt(7.0 / 12.0);

// Adds the error of caustics, times `factor`, to errors, lx per element.
void add_caustics(const PatchMesh& mesh, const RadiositySolution& solution, double factor,
                  Eigen::ArrayXf& error) {
  const BandArray& caustic = solution.caustic_irradiance;
  if (caustic.size() == 0) return;
  add_ranges(mesh, solution.bands, caustic, factor * of_caustic_range, error);
}

}  // namespace

Eigen::ArrayXf illuminance_bounds(const PatchMesh& mesh, const RadiositySolution& solution) {
  const Eigen::ArrayXf relative = error_bound(solution);
  if (relative.size() == 0) return {};
  constexpr double of_error = 2.0;  // as in error_bound()
  Eigen::ArrayXf bound = in_lux(mesh, solution, relative);
  add_caustics(mesh, solution, of_error, bound);
  return bound;
}

Eigen::ArrayXf illuminance_errors(const PatchMesh& mesh, const RadiositySolution& solution) {
  if (solution.gather_noise.size() == 0) return {};
  if (solution.interpolation_error.size() > 0) return 0.5f * illuminance_bounds(mesh, solution);
  Eigen::ArrayXf error = in_lux(mesh, solution, solution.gather_noise);
  BandArray E = solution.irradiance();
  if (solution.caustic_irradiance.size() > 0) E -= solution.caustic_irradiance;
  add_ranges(mesh, solution.bands, E, 0.5, error);
  add_caustics(mesh, solution, 1.0, error);
  return error;
}

}  // namespace lightwell
