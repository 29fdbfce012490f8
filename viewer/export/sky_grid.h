#pragma once

#include <Eigen/Core>
#include <optional>

#include "mesh/patches/patch_mesh.h"
#include "scene/scene.h"

namespace lightwell {

/// The scene's sky as bright as the solution on this mesh has it: channels dim sky and sun like
/// other lamps. radiance_outside() of it is what the second pass shows where rays leave the scene.
std::optional<Sky> effective_sky(const Scene& scene, const PatchMesh& mesh);

/// Radiance of a sky, without the sun, by azimuth and altitude, for graphics hardware to blend.
/// Samples lie on zenith, horizon and nadir themselves; the horizon has two rows, one of the dome
/// and one of the ground, so that the edge between them stays sharp.
struct SkyGrid {
  int columns = 0;       ///< even steps of azimuth, clockwise; the first and the last are north
  int rows_above = 0;    ///< even steps of altitude from zenith to horizon
  int rows_below = 0;    ///< from horizon to nadir; 2 where the ground is even
  BandArray radiance{};  ///< W/(m^2 sr), rows * columns x bands, the zenith's row first

  int rows() const { return rows_above + rows_below; }
};

/// `columns` azimuths, > 1, and a quarter as many altitudes above the horizon.
SkyGrid sky_grid(const Sky& sky, int columns);

/// Altitude of a row, degrees.
double row_altitude(const SkyGrid& grid, int row);

}  // namespace lightwell
