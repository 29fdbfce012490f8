#include "mesh/patches/element_grid.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lightwell {
namespace {

using Eigen::Vector2i;
using Eigen::Vector3d;

// The points origin + i step + j rise.
class Lattice {
 public:
  Lattice(const Vector3d& origin, const Vector3d& step, const Vector3d& rise)
      : origin_(origin),
        step_(step),
        rise_(rise),
        tolerance_(rounding * (step.norm() + rise.norm())) {
    const double xx = step.squaredNorm(), xy = step.dot(rise), yy = rise.squaredNorm();
    const double determinant = xx * yy - xy * xy;
    first_dual_ = (yy * step - xy * rise) / determinant;
    second_dual_ = (xx * rise - xy * step) / determinant;
  }

  // Returns (i, j) if the element's corners go once around that cell, counter-clockwise from `step`
  // to `rise`.
  std::optional<Vector2i> cell(const PatchMesh& mesh, int element) const {
    if (mesh.corner_count(element) != 4) return {};
    std::array<Vector2i, 4> at;
    for (int i = 0; i < 4; ++i) {
      const std::optional<Vector2i> place = node(mesh.position(mesh.corners[element][i]));
      if (!place) return {};
      at[i] = *place;
    }
    const Vector2i low = at[0].cwiseMin(at[1]).cwiseMin(at[2]).cwiseMin(at[3]);
    const std::array<Vector2i, 4> around{Vector2i(0, 0), Vector2i(1, 0), Vector2i(1, 1),
                                         Vector2i(0, 1)};
    for (int turn = 0; turn < 4; ++turn) {
      bool is_cell = true;
      for (int i = 0; i < 4; ++i) is_cell = is_cell && at[(turn + i) % 4] - low == around[i];
      if (is_cell) return low;
    }
    return {};
  }

 private:
  std::optional<Vector2i> node(const Vector3d& point) const {
    constexpr double most_cells = 1e6;
    const Vector3d way = point - origin_;
    const Eigen::Vector2d place(std::round(way.dot(first_dual_)),
                                std::round(way.dot(second_dual_)));
    if (!(place.cwiseAbs().maxCoeff() < most_cells)) return {};
    const Vector3d missed = way - place.x() * step_ - place.y() * rise_;
    if (!(missed.cwiseAbs().maxCoeff() <= tolerance_)) return {};
    return Vector2i(place.cast<int>());
  }

  static constexpr double rounding = 1e-9;
  Vector3d origin_, step_, rise_;
  double tolerance_;
  Vector3d first_dual_, second_dual_;
};

}  // namespace

std::optional<ElementGrid> element_grid(const PatchMesh& mesh, int patch) {
  const int first = mesh.first_element[patch];
  const int count = mesh.first_element[patch + 1] - first;
  const auto& c = mesh.corners[first];
  if (c[3] < 0) return {};
  const Vector3d origin = mesh.position(c[0]);
  const Vector3d step = mesh.position(c[1]) - origin, rise = mesh.position(c[3]) - origin;
  const Lattice lattice(origin, step, rise);

  std::vector<Vector2i> cells;
  for (int e = first; e < first + count; ++e) {
    const std::optional<Vector2i> cell = lattice.cell(mesh, e);
    if (!cell) return {};
    cells.push_back(*cell);
  }
  Vector2i low = cells[0], high = cells[0];
  for (const Vector2i& cell : cells) {
    low = low.cwiseMin(cell);
    high = high.cwiseMax(cell);
  }
  ElementGrid grid{.columns = high.x() - low.x() + 1,
                   .rows = high.y() - low.y() + 1,
                   .origin = origin + low.x() * step + low.y() * rise,
                   .step = step,
                   .rise = rise};
  if (static_cast<std::int64_t>(grid.columns) * grid.rows != count) return {};
  grid.element.assign(cells.size(), -1);
  for (int e = 0; e < count; ++e) {
    const Vector2i at = cells[e] - low;
    grid.element[at.y() * grid.columns + at.x()] = first + e;
  }
  if (std::find(grid.element.begin(), grid.element.end(), -1) != grid.element.end()) return {};
  return grid;
}

}  // namespace lightwell
