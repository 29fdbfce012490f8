#include "scene/picture_cells.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace lightwell {
namespace {

using Eigen::Vector2d;
using PlaneLoop = std::vector<Vector2d>;

// Twice the signed area of a loop.
double doubled_area(const PlaneLoop& loop) {
  double sum = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vector2d &a = loop[i], &b = loop[(i + 1) % loop.size()];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum;
}

// The part of a loop with sign * p[axis] >= sign * limit (Sutherland & Hodgman 1974). Parts of a
// loop that is not convex stay joined by edges of no area.
PlaneLoop clipped(const PlaneLoop& loop, int axis, double limit, double sign) {
  PlaneLoop inside;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vector2d &a = loop[i], &b = loop[(i + 1) % loop.size()];
    const double from = sign * (a[axis] - limit), to = sign * (b[axis] - limit);
    if (from >= 0.0) inside.push_back(a);
    if ((from > 0.0 && to < 0.0) || (from < 0.0 && to > 0.0)) {
      inside.push_back(a + from / (from - to) * (b - a));
    }
  }
  return inside;
}

PlaneLoop between(const PlaneLoop& loop, int axis, double low, double high) {
  return clipped(clipped(loop, axis, low, 1.0), axis, high, -1.0);
}

// Width of cells in texels, for a facet that is `extent` texels wide: one texel, or less where the
// picture is enlarged and its values vary within a texel.
double cell_width(double extent, int most) {
  constexpr double of_texel = 4.0, fewest = 4.0, enough = 16.0;
  const double across = std::max(extent, std::clamp(of_texel * extent, fewest, enough));
  return std::exp2(std::ceil(std::log2(extent / std::min<double>(across, most))));
}

// Areas of loops within the cells of a grid, in units of a cell.
std::vector<double> areas_in_cells(const std::vector<PlaneLoop>& loops, const PictureCells& grid) {
  std::vector<double> area(grid.index(0, grid.rows), 0.0);
  for (const PlaneLoop& loop : loops) {
    for (int row = 0; row < grid.rows; ++row) {
      const PlaneLoop strip = between(loop, 1, row, row + 1);
      if (strip.size() < 3) continue;
      for (int column = 0; column < grid.columns; ++column) {
        area[grid.index(column, row)] += 0.5 * doubled_area(between(strip, 0, column, column + 1));
      }
    }
  }
  return area;
}

PictureCells single_cell(const SurfaceTexture& image, const UvMap& uv, const PolygonMesh& mesh,
                         const Facet& facet) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const int v : facet.boundary) middle += mesh.vertices[static_cast<std::size_t>(v)];
  middle /= static_cast<double>(facet.boundary.size());
  PictureCells cell{.area = {facet_area(mesh, facet)}, .value = {image.at(uv.at(middle))}};
  cell.place.col(3).setConstant(0.5);
  return cell;
}

}  // namespace

PictureCells picture_cells(const SurfaceTexture& image, const UvMap& uv, const PolygonMesh& mesh,
                           const Facet& facet, int most_across) {
  const Eigen::DiagonalMatrix<double, 2> size(image.picture->width(), image.picture->height());
  const Eigen::Matrix2d linear = image.placement.leftCols<2>();
  Eigen::Matrix<double, 2, 4> texel;  // position in texels
  texel << size * linear * uv.gradient, size * (linear * uv.offset + image.placement.col(2));
  const auto in_texels = [&](int v) -> Vector2d {
    return texel.leftCols<3>() * mesh.vertices[static_cast<std::size_t>(v)] + texel.col(3);
  };
  std::vector<PlaneLoop> loops(1 + facet.holes.size());
  for (const int v : facet.boundary) loops[0].push_back(in_texels(v));
  for (std::size_t h = 0; h < facet.holes.size(); ++h) {
    for (const int v : facet.holes[h]) loops[h + 1].push_back(in_texels(v));
  }
  Eigen::AlignedBox2d box;
  for (const Vector2d& p : loops[0]) box.extend(p);
  double doubled = 0.0;
  for (const PlaneLoop& loop : loops) doubled += doubled_area(loop);
  const Vector2d extent = box.sizes();
  constexpr double flat = 1e-9;
  if (!(std::abs(doubled) > flat * extent.x() * extent.y()) || !extent.allFinite()) {
    return single_cell(image, uv, mesh, facet);
  }
  Vector2d width(cell_width(extent.x(), most_across), cell_width(extent.y(), most_across));
  // Filters of the mip map are exact over squares of texels.
  if (width.maxCoeff() > 1.0) width.setConstant(width.maxCoeff());
  const Vector2d low = (box.min().array() / width.array()).floor();
  const Vector2d high = (box.max().array() / width.array()).ceil();
  PictureCells cells{.columns = std::max(1, static_cast<int>(high.x() - low.x())),
                     .rows = std::max(1, static_cast<int>(high.y() - low.y()))};
  cells.place = width.cwiseInverse().asDiagonal() * texel;
  cells.place.col(3) -= low;
  for (PlaneLoop& loop : loops) {
    for (Vector2d& p : loop) p = (p.array() / width.array()).matrix() - low;
  }
  cells.area = areas_in_cells(loops, cells);
  double sum = 0.0;
  for (const double area : cells.area) sum += area;
  const double to_metres = facet_area(mesh, facet) / sum;
  for (double& area : cells.area) area = std::max(0.0, area * to_metres);

  // The filter itself reaches half a cell farther.
  const Eigen::Matrix2d to_uv = (size * linear).inverse();
  const Eigen::Matrix2d footprint = 0.5 * to_uv * width.asDiagonal();
  const Vector2d offset = size * image.placement.col(2);
  for (int row = 0; row < cells.rows; ++row) {
    for (int column = 0; column < cells.columns; ++column) {
      const Vector2d middle = (low + Vector2d(column + 0.5, row + 0.5)).cwiseProduct(width);
      cells.value.push_back(image.over(to_uv * (middle - offset), footprint));
    }
  }
  return cells;
}

int cells_across(std::size_t facets) {
  constexpr double most_cells = 4e6, most = 128.0, least = 8.0;
  const double each = most_cells / static_cast<double>(std::max<std::size_t>(1, facets));
  return static_cast<int>(std::clamp(std::sqrt(each), least, most));
}

Eigen::Array3d mean_of(const PictureCells& cells) {
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  double area = 0.0;
  for (std::size_t i = 0; i < cells.area.size(); ++i) {
    sum += cells.area[i] * cells.value[i].cast<double>();
    area += cells.area[i];
  }
  return sum / area;
}

Eigen::ArrayXd mean_exitance(const Scene& scene, const Surface& surface) {
  const Material& material = scene.materials[static_cast<std::size_t>(surface.material)];
  const auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
  const Eigen::ArrayXd even = material.emission.cast<double>();
  if (!mesh || !material.emission_texture) return even;
  const int most_across = cells_across(mesh->facets.size());
  Eigen::ArrayXd power = Eigen::ArrayXd::Zero(even.size());
  double area = 0.0;
  for (const Facet& facet : mesh->facets) {
    const double of_facet = facet_area(*mesh, facet);
    area += of_facet;
    if (facet.uv_map < 0) {
      power += of_facet * even;
      continue;
    }
    const auto& [image, factor] = *material.emission_texture;
    const UvMap& uv = mesh->uv_maps[static_cast<std::size_t>(facet.uv_map)];
    power += of_facet * factor.head<3>().cast<double>() *
             mean_of(picture_cells(image, uv, *mesh, facet, most_across));
  }
  return power / area;
}

}  // namespace lightwell
