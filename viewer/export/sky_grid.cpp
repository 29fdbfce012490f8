#include "viewer/export/sky_grid.h"

#include <algorithm>

#include "scene/parallel.h"

namespace lightwell {

std::optional<Sky> effective_sky(const Scene& scene, const PatchMesh& mesh) {
  std::optional<Sky> sky = scene.sky;
  if (!sky || mesh.source_scale.rows() == 0) return sky;
  // Order of free sources: lamps, dome, sun.
  auto source = static_cast<Eigen::Index>(scene.lamps.size());
  if (has_dome(*sky)) {
    const Spectrum scale = mesh.source_scale.row(source++).transpose();
    sky->scale *= scale;
    if (sky->ground.size() > 0) sky->ground *= scale;
  }
  if (sky->sun) sky->sun->irradiance *= mesh.source_scale.row(source).transpose();
  return sky;
}

double row_altitude(const SkyGrid& grid, int row) {
  constexpr double zenith = 90.0;
  if (row < grid.rows_above)
    return zenith * (1.0 - static_cast<double>(row) / (grid.rows_above - 1));
  return -zenith * (row - grid.rows_above) / (grid.rows_below - 1);
}

SkyGrid sky_grid(const Sky& sky, int columns) {
  SkyGrid grid{.columns = columns, .rows_above = std::max(2, columns / 4), .rows_below = 2};
  if (sky.kind == SkyKind::map) grid.rows_below = grid.rows_above;
  grid.radiance = BandArray::Zero(Eigen::Index{grid.rows()} * columns, sky.scale.size());
  parallel_for(grid.rows(), 1, [&](int begin, int end) {
    for (int row = begin; row < end; ++row) {
      // The rows at the horizon stay on their own side, dome or ground, by a tiny angle.
      constexpr double hair = 1e-4;  // degrees
      const double altitude = row < grid.rows_above ? std::max(row_altitude(grid, row), hair)
                                                    : std::min(row_altitude(grid, row), -hair);
      for (int c = 0; c < columns; ++c) {
        const double azimuth = 360.0 * c / (columns - 1);
        grid.radiance.row(Eigen::Index{row} * columns + c) =
            sky_radiance(sky, sky_direction(sky, azimuth, altitude)).transpose();
      }
    }
  });
  return grid;
}

}  // namespace lightwell
