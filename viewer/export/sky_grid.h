#pragma once

#include <Eigen/Core>
#include <optional>

#include "mesh/patches/patch_mesh.h"
#include "scene/scene.h"

namespace lightwell {

/// The scene's sky times the source scales of `mesh`: channels dim sky and sun like other lamps. A
/// ray of the second pass that leaves the scene has radiance_outside() of the effective sky. Empty
/// without a sky.
std::optional<Sky> effective_sky(const Scene& scene, const PatchMesh& mesh);

/// Radiance of a sky, without the sun, by azimuth and altitude, for graphics hardware to
/// interpolate. Samples include zenith, horizon and nadir. The horizon has two rows, one of the
/// dome and one of the ground, so that the edge between dome and ground stays sharp.
struct SkyGrid {
  int columns = 0;       ///< even steps of azimuth, clockwise; the first and the last are north
  int rows_above = 0;    ///< even steps of altitude from zenith to horizon
  int rows_below = 0;    ///< from horizon to nadir; 2 where the ground is uniform
  BandArray radiance{};  ///< W/(m^2 sr), rows * columns x bands, the zenith's row first

  int rows() const { return rows_above + rows_below; }
};

/// Samples a sky at `columns` azimuths, > 1, and a quarter as many altitudes above the horizon, at
/// least 2.
SkyGrid sky_grid(const Sky& sky, int columns);

/// Altitude of a row, degrees.
double row_altitude(const SkyGrid& grid, int row);

}  // namespace lightwell
