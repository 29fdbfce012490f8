#include "viewer/window/fine_spheres.h"

#include <algorithm>
#include <cmath>

#include "mesh/patches/sphere_grid.h"

namespace lightwell {
namespace {

/// Faces around a sphere. The sagitta of a chord of 1/128 of the circle is
/// r (1 - cos 1.4 degrees) = 3e-4 r, a tenth of a pixel where the sphere is 600 pixels wide.
constexpr int pieces_around = 128;
/// Bound on the faces of all spheres together; the spheres of a scene with very many are coarser.
constexpr double most_faces = 2e5;

// Faces around each of `spheres` spheres.
int pieces(std::size_t spheres) {
  // A sphere has n faces around and n / 2 from pole to pole, on two sides: n^2 in all.
  const double afforded = std::sqrt(most_faces / static_cast<double>(spheres));
  return std::min(pieces_around, static_cast<int>(afforded));
}

/// Splits elements of one sphere's grid into columns x rows of faces.
class Splitter {
 public:
  Splitter(const PatchMesh& mesh, const SphereGrid& grid, int pieces)
      : mesh_(mesh),
        grid_(grid),
        columns_(std::max(1, (pieces + grid.sectors - 1) / grid.sectors)),
        rows_(std::max(1, (pieces / 2 + grid.rings - 1) / grid.rings)) {}

  void split(int ring, int sector, bool is_outside, int element, FineSpheres& out) const {
    const int first = static_cast<int>(out.points.size());
    const auto at = [&](int column, int row) { return first + row * (columns_ + 1) + column; };
    const auto& c = mesh_.corners[element];
    // Corners of an inner element run in the opposite sense.
    const std::array<int, 4> vertices = is_outside ? c
                                        : mesh_.corner_count(element) < 4
                                            ? std::array{c[0], c[2], c[1], c[3]}
                                            : std::array{c[0], c[3], c[2], c[1]};
    for (int row = 0; row <= rows_; ++row) {
      for (int column = 0; column <= columns_; ++column) {
        const SphereGridPoint place{.ring = ring,
                                    .sector = sector,
                                    .u = static_cast<double>(column) / columns_,
                                    .v = static_cast<double>(row) / rows_};
        const Eigen::Vector3d direction = sphere_direction(grid_, place);
        out.points.push_back({.position = grid_.sphere.center + grid_.sphere.radius * direction,
                              .normal = is_outside ? direction : Eigen::Vector3d(-direction),
                              .vertex = vertices,
                              .weight = sphere_weights(grid_, place)});
      }
    }
    for (int row = 0; row < rows_; ++row) {
      const bool at_north = ring == 0 && row == rows_ - 1;
      const bool at_south = ring == grid_.rings - 1 && row == 0;
      for (int column = 0; column < columns_; ++column) {
        const int sw = at(column, row), se = at(column + 1, row), ne = at(column + 1, row + 1),
                  nw = at(column, row + 1);
        std::array<int, 4> corner = at_north   ? std::array{sw, se, ne, -1}
                                    : at_south ? std::array{sw, ne, nw, -1}
                                               : std::array{sw, se, ne, nw};
        if (!is_outside) std::reverse(corner.begin(), corner.begin() + (corner[3] < 0 ? 3 : 4));
        out.faces.push_back({element, corner});
      }
    }
    // Outlines of the southern and the western edge; neighbours draw the other two.
    for (int column = 0; column < columns_ && ring < grid_.rings - 1; ++column) {
      out.outlines.push_back({at(column, 0), at(column + 1, 0)});
    }
    for (int row = 0; row < rows_; ++row) out.outlines.push_back({at(0, row), at(0, row + 1)});
  }

 private:
  const PatchMesh& mesh_;
  const SphereGrid& grid_;
  int columns_, rows_;
};

}  // namespace

FineSpheres fine_spheres(const PatchMesh& mesh) {
  FineSpheres result;
  if (mesh.sphere_grids.empty()) return result;
  result.has_faces.assign(static_cast<std::size_t>(mesh.element_count()), 0);
  for (const SphereGrid& grid : mesh.sphere_grids) {
    const Splitter splitter(mesh, grid, pieces(mesh.sphere_grids.size()));
    for (int ring = 0; ring < grid.rings; ++ring) {
      for (int sector = 0; sector < grid.sectors; ++sector) {
        const int outside = grid.element[static_cast<std::size_t>(ring) * grid.sectors + sector];
        for (const int element : {outside, mesh.twin[outside]}) {
          if (element < 0) continue;
          result.has_faces[static_cast<std::size_t>(element)] = 1;
          splitter.split(ring, sector, element == outside, element, result);
        }
      }
    }
  }
  return result;
}

}  // namespace lightwell
