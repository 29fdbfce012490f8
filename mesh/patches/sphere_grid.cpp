#include "mesh/patches/sphere_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace lightwell {
namespace {

using std::numbers::pi;

// First of n cells in block c of m even blocks.
int block(int c, int m, int n) {
  return static_cast<int>((static_cast<std::int64_t>(c) * n + m - 1) / m);
}

double polar_angle(int ring, int rings) {
  return pi * ring / rings;
}

}  // namespace

SphereElements sphere_elements(const Sphere& sphere, const CutSize& size) {
  SphereElements s;
  // At least two patches from pole to pole and four around; fewer do not resemble a sphere.
  const int patch_rows = std::max(2, size.patches(pi * sphere.radius));
  s.rings = std::max(patch_rows, size.pieces(pi * sphere.radius));
  s.sectors = std::max(4, size.pieces(2.0 * pi * sphere.radius));

  const auto at = [&](int ring, int sector) -> Eigen::Vector3d {
    const double theta = polar_angle(ring, s.rings), phi = 2.0 * pi * sector / s.sectors;
    return sphere.center + sphere.radius * Eigen::Vector3d(std::sin(theta) * std::cos(phi),
                                                           std::sin(theta) * std::sin(phi),
                                                           std::cos(theta));
  };
  s.position.push_back(sphere.center + Eigen::Vector3d(0, 0, sphere.radius));
  s.position.push_back(sphere.center - Eigen::Vector3d(0, 0, sphere.radius));
  for (int ring = 1; ring < s.rings; ++ring) {
    for (int sector = 0; sector < s.sectors; ++sector) s.position.push_back(at(ring, sector));
  }
  const auto vertex = [&](int ring, int sector) {
    return ring == 0 ? 0 : ring == s.rings ? 1 : 2 + (ring - 1) * s.sectors + sector % s.sectors;
  };
  const double r2 = sphere.radius * sphere.radius, dphi = 2.0 * pi / s.sectors;
  s.element.resize(static_cast<std::size_t>(s.rings) * s.sectors);
  for (int row = 0; row < patch_rows; ++row) {
    const int north = block(row, patch_rows, s.rings), south = block(row + 1, patch_rows, s.rings);
    const double widest = 2.0 * north < s.rings && 2.0 * south > s.rings
                              ? 1.0
                              : std::max(std::sin(polar_angle(north, s.rings)),
                                         std::sin(polar_angle(south, s.rings)));
    // As many whole sectors as fit into the width of a patch, but no fewer than elements along a
    // patch edge.
    const double sector_width = dphi * sphere.radius * widest;
    const int fit = std::max(size.elements_per_edge,
                             static_cast<int>(size.patch_size / sector_width * (1.0 + 1e-9)));
    const int columns = std::max(4, (s.sectors + fit - 1) / fit);
    for (int column = 0; column < columns; ++column) {
      const int west = block(column, columns, s.sectors);
      const int east = block(column + 1, columns, s.sectors);
      for (int ring = north; ring < south; ++ring) {
        const double dcos =
            std::cos(polar_angle(ring, s.rings)) - std::cos(polar_angle(ring + 1, s.rings));
        for (int sector = west; sector < east; ++sector) {
          s.element[static_cast<std::size_t>(ring) * s.sectors + sector] =
              static_cast<int>(s.corners.size());
          const int sw = vertex(ring + 1, sector), se = vertex(ring + 1, sector + 1);
          const int ne = vertex(ring, sector + 1), nw = vertex(ring, sector);
          if (ring == 0) {
            s.corners.push_back({sw, se, ne, -1});
          } else if (ring == s.rings - 1) {
            s.corners.push_back({sw, ne, nw, -1});
          } else {
            s.corners.push_back({sw, se, ne, nw});
          }
          s.area.push_back(r2 * dphi * dcos);
        }
      }
      s.first_element.push_back(static_cast<int>(s.corners.size()));
    }
  }
  return s;
}

SphereGridPoint sphere_grid_point(const SphereGrid& grid, const Eigen::Vector3d& direction) {
  const double across = std::hypot(direction.x(), direction.y());
  double phi = std::atan2(direction.y(), direction.x());
  if (phi < 0.0) phi += 2.0 * pi;
  // Rounding may carry x or y to the end of its range, which is the last cell's far edge.
  const double x = phi / (2.0 * pi) * grid.sectors;
  const double y = std::atan2(across, direction.z()) / pi * grid.rings;
  SphereGridPoint grid_point;
  grid_point.sector = std::clamp(static_cast<int>(x), 0, grid.sectors - 1);
  grid_point.ring = std::clamp(static_cast<int>(y), 0, grid.rings - 1);
  grid_point.u = std::clamp(x - grid_point.sector, 0.0, 1.0);
  grid_point.v = std::clamp(1.0 - (y - grid_point.ring), 0.0, 1.0);
  return grid_point;
}

Eigen::Vector3d sphere_direction(const SphereGrid& grid, const SphereGridPoint& grid_point) {
  const double phi = 2.0 * pi * (grid_point.sector + grid_point.u) / grid.sectors;
  const double theta = pi * (grid_point.ring + 1.0 - grid_point.v) / grid.rings;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

Eigen::Array4f sphere_weights(const SphereGrid& grid, const SphereGridPoint& grid_point) {
  const auto u = static_cast<float>(grid_point.u), v = static_cast<float>(grid_point.v);
  const float sw = (1 - u) * (1 - v), se = u * (1 - v), ne = u * v, nw = (1 - u) * v;
  if (grid_point.ring == 0) return {sw, se, v, 0.0f};
  if (grid_point.ring == grid.rings - 1) return {1 - v, ne, nw, 0.0f};
  return {sw, se, ne, nw};
}

const SphereGrid* sphere_grid_of(const PatchMesh& mesh, int facet) {
  const auto& grids = mesh.sphere_grids;  // in ascending order of facets
  const auto grid = std::lower_bound(grids.begin(), grids.end(), facet,
                                     [](const SphereGrid& g, int f) { return g.facet < f; });
  return grid != grids.end() && grid->facet == facet ? &*grid : nullptr;
}

}  // namespace lightwell
