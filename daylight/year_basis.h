#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "daylight/daylight_model.h"
#include "daylight/sky_year.h"

namespace lightwell {

/// Effort of find_year_basis().
struct YearBasisOptions {
  int most = 32;            ///< terms, a multiple of 4
  double error = 0.01;      ///< to reach, of YearBasis::error
  int samples = 512;        ///< vertices that the basis is found from
  int checks = 256;         ///< other vertices, at which its error is measured
  int sky_subdivision = 1;  ///< of the dome as seen from vertices: Tregenza's 145 patches
  DomeEffort view{.search = 2, .rays = 1024};  ///< of a vertex towards the dome
  int rays = 4096;  ///< of a vertex, for light that surfaces reflect; sample vertices have fewer
  int most_vertices = 400'000;
  double most_memory = 3e9;  ///< bytes, of the light that arrives at all patches in all hours
  double most_bytes = 48e6;  ///< of the light in 16 bits; there are fewer terms rather than more
};

/// The light of all vertices in all hours of a year, but that straight from the sun, as a sum of
/// few terms:
///
///     E(vertex, hour) = sum_k light_k(vertex) weight_k(hour),  lx
///
/// Light of dome and ground, direct and reflected, and reflected sunlight vary smoothly over a
/// room, so that the singular values of E fall fast. Light straight from the sun has sharp edges,
/// which no such sum has.
struct YearBasis {
  Eigen::ArrayXXf weight{};  ///< hours x terms
  /// lx, vertices of the model's mesh x (terms x bands), the bands of a term side by side. The
  /// illuminance is the mean of the bands, weighted by DaylightModel::band_weights().
  BandArray light{};
  /// Root mean square of what the sum leaves out, over vertices that the basis has not seen and all
  /// hours. It is relative to the light of the vertex (at least a quarter of the median of all) and
  /// of the hour.
  double error = 0.0;

  int term_count() const { return static_cast<int>(weight.cols()); }
};

/// Throws InputError for a mesh of more than `most_vertices`, or whose light of all hours takes
/// more than `most_memory`, and where no hour has daylight: before the long work of
/// find_year_basis().
void check_year_basis(const PatchMesh& mesh, int bands, std::span<const SkyHour> hours,
                      const YearBasisOptions& options = {});

/// Finds the terms by a truncated singular value decomposition of the light of sample vertices in
/// all hours, by a randomised range finder (Halko, Martinsson & Tropp 2011), and gathers the light
/// of the terms at all vertices. Vertices are gathered in blocks, so that memory holds patches x
/// hours and vertices x terms. The number of terms is the least multiple of 4 that reaches the
/// error, or the most that `most` and `most_bytes` allow.
///
/// Throws what check_year_basis() throws, InputError where no daylight reaches any vertex in any
/// hour, Interrupted when the model's progress says stop.
YearBasis find_year_basis(const DaylightModel& model, std::span<const SkyHour> hours,
                          double ground_reflectance, const YearBasisOptions& options = {});

/// Light of vertices in one hour by the basis, lx: vertices x bands.
BandArray light_of_hour(const YearBasis& basis, int hour, int bands);

}  // namespace lightwell
