#include "viewer/window/fine_round_shapes.h"

#include <algorithm>
#include <cmath>

#include "mesh/patches/round_grid.h"

namespace lightwell {
namespace {

/// Faces around a shape. The sagitta of a chord of 1/128 of the circle is
/// r (1 - cos 1.4 degrees) = 3e-4 r, a tenth of a pixel where the shape is 600 pixels wide.
constexpr int pieces_around = 128;
/// Bound on the faces of all shapes together; the shapes of a scene with very many are coarser.
constexpr double most_faces = 2e5;

// Faces around each of `shapes` shapes.
int pieces(std::size_t shapes) {
  // A sphere has n faces around and n / 2 from pole to pole, on two sides: n^2 in all.
  const double afforded = std::sqrt(most_faces / static_cast<double>(shapes));
  return std::min(pieces_around, static_cast<int>(afforded));
}

/// True if the shape is curved from ring to ring.
bool is_curved(const RoundShape& shape) {
  return std::holds_alternative<Sphere>(shape);
}

/// Splits elements of one shape's grid into columns x rows of faces.
class Splitter {
 public:
  Splitter(const PatchMesh& mesh, const RoundGrid& grid, int pieces)
      : mesh_(mesh),
        grid_(grid),
        columns_(std::max(1, (pieces + grid.sectors - 1) / grid.sectors)),
        rows_(is_curved(grid.shape) ? std::max(1, (pieces / 2 + grid.rings - 1) / grid.rings) : 1) {
  }

  void split(int ring, int sector, bool is_front, int element, FineRoundShapes& out) const {
    const int first = static_cast<int>(out.points.size());
    const auto at = [&](int column, int row) { return first + row * (columns_ + 1) + column; };
    const auto& c = mesh_.corners[element];
    // Corners of an element of the back run in the opposite sense.
    const std::array<int, 4> vertices = is_front ? c
                                        : mesh_.corner_count(element) < 4
                                            ? std::array{c[0], c[2], c[1], c[3]}
                                            : std::array{c[0], c[3], c[2], c[1]};
    for (int row = 0; row <= rows_; ++row) {
      for (int column = 0; column <= columns_; ++column) {
        const RoundGridPoint place{.ring = ring,
                                   .sector = sector,
                                   .u = static_cast<double>(column) / columns_,
                                   .v = static_cast<double>(row) / rows_};
        const Eigen::Vector3d position = point_at(grid_, place);
        const Eigen::Vector3d normal = front_normal(grid_.shape, position);
        out.points.push_back({.position = position,
                              .normal = is_front ? normal : Eigen::Vector3d(-normal),
                              .vertex = vertices,
                              .weight = round_weights(grid_, place)});
      }
    }
    for (int row = 0; row < rows_; ++row) {
      const bool at_north = ends_north(grid_, ring) && row == rows_ - 1;
      const bool at_south = ends_south(grid_, ring) && row == 0;
      for (int column = 0; column < columns_; ++column) {
        const int sw = at(column, row), se = at(column + 1, row), ne = at(column + 1, row + 1),
                  nw = at(column, row + 1);
        std::array<int, 4> corner = at_north   ? std::array{sw, se, ne, -1}
                                    : at_south ? std::array{sw, ne, nw, -1}
                                               : std::array{sw, se, ne, nw};
        if (!is_front) std::reverse(corner.begin(), corner.begin() + (corner[3] < 0 ? 3 : 4));
        out.faces.push_back({element, corner});
      }
    }
    // Outlines of the southern and the western edge; neighbours draw the other two.
    for (int column = 0; column < columns_ && !ends_south(grid_, ring); ++column) {
      out.outlines.push_back({at(column, 0), at(column + 1, 0)});
    }
    for (int row = 0; row < rows_; ++row) out.outlines.push_back({at(0, row), at(0, row + 1)});
    // The open end of a frustum has no neighbour in the north.
    for (int column = 0; column < columns_ && ring == 0 && !ends_north(grid_, ring); ++column) {
      out.outlines.push_back({at(column, rows_), at(column + 1, rows_)});
    }
  }

 private:
  const PatchMesh& mesh_;
  const RoundGrid& grid_;
  int columns_, rows_;
};

}  // namespace

FineRoundShapes fine_round_shapes(const PatchMesh& mesh) {
  FineRoundShapes result;
  if (mesh.round_grids.empty()) return result;
  result.has_faces.assign(static_cast<std::size_t>(mesh.element_count()), 0);
  for (const RoundGrid& grid : mesh.round_grids) {
    const Splitter splitter(mesh, grid, pieces(mesh.round_grids.size()));
    for (int ring = 0; ring < grid.rings; ++ring) {
      for (int sector = 0; sector < grid.sectors; ++sector) {
        const int front = grid.element[static_cast<std::size_t>(ring) * grid.sectors + sector];
        for (const int element : {front, mesh.twin[front]}) {
          if (element < 0) continue;
          result.has_faces[static_cast<std::size_t>(element)] = 1;
          splitter.split(ring, sector, element == front, element, result);
        }
      }
    }
  }
  return result;
}

}  // namespace lightwell
