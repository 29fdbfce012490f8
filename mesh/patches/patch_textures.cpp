#include "mesh/patches/patch_textures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "scene/facet_textures.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

constexpr int fewest_points = 4, most_points = 16;  // per direction of an element
constexpr double least_cover = 1e-3;

// A piece of an element under the bilinear map of the unit square; a triangle repeats its last
// corner.
struct TextureCell {
  Vector3d middle;
  Eigen::Matrix<double, 3, 2> sides;
  double area = 0.0;
};

TextureCell texture_cell(const std::array<Vector3d, 4>& corner, int points, int i, int j) {
  const double s = (i + 0.5) / points, t = (j + 0.5) / points;
  const Vector3d along = (1.0 - t) * (corner[1] - corner[0]) + t * (corner[2] - corner[3]);
  const Vector3d across = (1.0 - s) * (corner[3] - corner[0]) + s * (corner[2] - corner[1]);
  TextureCell cell{.middle = (1.0 - t) * ((1.0 - s) * corner[0] + s * corner[1]) +
                             t * ((1.0 - s) * corner[3] + s * corner[2])};
  cell.sides << along / points, across / points;
  cell.area = cell.sides.col(0).cross(cell.sides.col(1)).norm();
  return cell;
}

std::array<Vector3d, 4> corners_of(const PatchMesh& mesh, int element) {
  const auto& c = mesh.corners[element];
  const Vector3d last = mesh.position(c[2]);
  if (c[3] < 0) return {mesh.position(c[0]), mesh.position(c[1]), last, last};
  return {mesh.position(c[0]), mesh.position(c[1]), last, mesh.position(c[3])};
}

// Sums over the part of an element that is no hole.
struct Covered {
  double area = 0.0, cover = 0.0;  // m^2: the element, and the part that is no hole
  Eigen::ArrayXd reflected{};      // sum of reflectance times area, m^2
};

Covered covered_light(const PatchMesh& mesh, const FacetTextures& textures, int element,
                      int bands) {
  const int facet = mesh.facet[element];
  const auto corner = corners_of(mesh, element);
  const bool has_holes = textures.has_holes(facet), is_textured = textures.is_textured(facet);
  int points = most_points;
  if (!has_holes) {
    double longest = 0.0;
    for (int i = 0; i < 4; ++i) {
      const Vector3d edge = corner[(i + 1) % 4] - corner[i];
      longest = std::max(longest, textures.texels_along(facet, edge));
    }
    points = static_cast<int>(std::clamp<double>(std::ceil(longest), fewest_points, most_points));
  }
  // The filter itself reaches half a cell farther, so that texels beside the element stay out.
  constexpr double reach = 0.5;
  Covered sum{.reflected = Eigen::ArrayXd::Zero(bands)};
  for (int i = 0; i < points; ++i) {
    for (int j = 0; j < points; ++j) {
      const TextureCell cell = texture_cell(corner, points, i, j);
      sum.area += cell.area;
      if (has_holes && textures.is_hole(facet, cell.middle)) continue;
      sum.cover += cell.area;
      if (!is_textured) continue;
      const Eigen::Matrix<double, 3, 2> footprint = reach * cell.sides;
      sum.reflected +=
          cell.area * textures.reflectance(facet, cell.middle, footprint).cast<double>();
    }
  }
  return sum;
}

void lay_on_patch(const Scene& scene, const FacetTextures& textures, int patch, PatchMesh& mesh) {
  const int bands = scene.bands.count();
  const Material& material = scene.materials[static_cast<std::size_t>(mesh.material[patch])];
  Eigen::ArrayXd reflected = Eigen::ArrayXd::Zero(bands);
  double area = 0.0, cover = 0.0;
  for (int e = mesh.first_element[patch]; e < mesh.first_element[patch + 1]; ++e) {
    const int facet = mesh.facet[e];
    double share = 1.0;
    const bool is_textured = textures.is_textured(facet);
    if (is_textured || textures.has_holes(facet)) {
      const Covered sum = covered_light(mesh, textures, e, bands);
      share = sum.cover / sum.area;
      if (is_textured) reflected += mesh.element_area[e] / sum.area * sum.reflected;
    }
    if (!is_textured) {
      reflected += mesh.element_area[e] * share * material.reflectance.cast<double>();
    }
    cover += mesh.element_area[e] * share;
    mesh.element_area[e] *= std::max(share, least_cover);
    area += mesh.element_area[e];
  }
  mesh.area[patch] = area;
  if (!(cover > 0.0) || (mesh.is_back[patch] != 0 && material.one_sided)) return;
  mesh.reflectance.row(patch) = (reflected / cover).cast<float>().min(1.0f).transpose();
}

}  // namespace

void lay_on_textures(const Scene& scene, PatchMesh& mesh) {
  attach_textures(scene, mesh);
  if (!mesh.textures) return;
  const auto varies = [&](int patch) {
    for (int e = mesh.first_element[patch]; e < mesh.first_element[patch + 1]; ++e) {
      const int facet = mesh.facet[e];
      if (mesh.textures->is_textured(facet) || mesh.textures->has_holes(facet)) return true;
    }
    return false;
  };
  parallel_for(mesh.patch_count(), 16, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) {
      if (varies(p)) lay_on_patch(scene, *mesh.textures, p, mesh);
    }
  });
}

void attach_textures(const Scene& scene, PatchMesh& mesh) {
  auto textures = std::make_shared<const FacetTextures>(scene);
  mesh.textures = textures->is_empty() ? nullptr : std::move(textures);
}

BandArray vertex_reflectance(const PatchMesh& mesh) {
  const Eigen::Index bands = mesh.reflectance.cols();
  BandArray rho = BandArray::Zero(mesh.vertex_count(), bands);
  std::vector<int> patch(static_cast<std::size_t>(mesh.vertex_count()), -1);
  std::vector<char> differs(patch.size(), 0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      const auto v = static_cast<std::size_t>(mesh.corners[e][c]);
      const int first = patch[v] < 0 ? mesh.patch[e] : patch[v];
      patch[v] = first;
      differs[v] |= (mesh.reflectance.row(first) != mesh.reflectance.row(mesh.patch[e])).any();
    }
  }
  std::vector<double> area;
  if (std::ranges::find(differs, 1) != differs.end()) area.resize(patch.size(), 0.0);
  for (int e = 0; e < mesh.element_count() && !area.empty(); ++e) {
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      const int v = mesh.corners[e][c];
      if (!differs[static_cast<std::size_t>(v)]) continue;
      area[static_cast<std::size_t>(v)] += mesh.element_area[e];
      rho.row(v) += static_cast<float>(mesh.element_area[e]) * mesh.reflectance.row(mesh.patch[e]);
    }
  }
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const auto at = static_cast<std::size_t>(v);
    if (patch[at] < 0) continue;
    if (differs[at]) {
      rho.row(v) /= static_cast<float>(area[at]);
    } else {
      rho.row(v) = mesh.reflectance.row(patch[at]);
    }
  }
  return rho;
}

}  // namespace lightwell
