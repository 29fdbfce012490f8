#include "mesh/patches/patch_textures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mesh/patches/patch_patterns.h"
#include "mesh/patches/texture_cells.h"
#include "scene/facet_textures.h"
#include "scene/parallel.h"
#include "scene/picture_cells.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

constexpr double least_cover = 1e-3;

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
  const CellGrid grid = has_holes ? finest_cells : cells_over(textures, facet, corner);
  Covered sum{.reflected = Eigen::ArrayXd::Zero(bands)};
  for (int i = 0; i < grid.along; ++i) {
    for (int j = 0; j < grid.across; ++j) {
      const TextureCell cell = texture_cell(corner, grid, i, j);
      sum.area += cell.area;
      if (has_holes && textures.is_hole(facet, cell.middle)) continue;
      sum.cover += cell.area;
      if (!is_textured) continue;
      sum.reflected +=
          cell.area * textures.reflectance(facet, cell.middle, filter_of(cell)).cast<double>();
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
  if (!(cover > 0.0)) return;
  mesh.reflectance.row(patch) = (reflected / cover).cast<float>().min(1.0f).transpose();
}

// Sets the emission of a patch that shines to the mean of its picture.
void shine_on_patch(const FacetTextures& textures, int patch, PatchMesh& mesh) {
  Eigen::ArrayXd power = Eigen::ArrayXd::Zero(mesh.emission.cols());
  double area = 0.0;
  for (int e = mesh.first_element[patch]; e < mesh.first_element[patch + 1]; ++e) {
    power += mesh.element_area[e] * mean_emission(mesh, textures, e).cast<double>();
    area += mesh.element_area[e];
  }
  if (area > 0.0) mesh.emission.row(patch) = (power / area).cast<float>().transpose();
}

// The patch on the other side of a front patch; -1: none.
int back_of(const PatchMesh& mesh, int front) {
  const int twin = mesh.twin[mesh.first_element[front]];
  return twin < 0 ? -1 : mesh.patch[twin];
}

// The back shows what the front shows, element by element.
void copy_to_back(const Scene& scene, int front, int back, PatchMesh& mesh) {
  const int first = mesh.first_element[front], count = mesh.first_element[front + 1] - first;
  mesh.element_area.segment(mesh.first_element[back], count) =
      mesh.element_area.segment(first, count);
  mesh.area[back] = mesh.area[front];
  const Material& material = scene.materials[static_cast<std::size_t>(mesh.material[front])];
  if (!material.one_sided) mesh.reflectance.row(back) = mesh.reflectance.row(front);
  if (material.emits_both_sides) mesh.emission.row(back) = mesh.emission.row(front);
}

// Mean of the picture by which each facet shines; empty for other facets.
std::vector<Eigen::ArrayXd> pictured_means(const Scene& scene, const FacetTextures& textures) {
  const std::vector<FacetRef> facets = scene_facets(scene);
  std::vector<Eigen::ArrayXd> mean(facets.size());
  std::size_t count = 0;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    count += textures.has_emission(static_cast<int>(f)) ? 1 : 0;
  }
  const int across = cells_across(count);
  parallel_for(static_cast<int>(facets.size()), 16, [&](int begin, int end) {
    for (int f = begin; f < end; ++f) {
      if (!textures.has_emission(f)) continue;
      const FacetRef& ref = facets[static_cast<std::size_t>(f)];
      const auto& polygons =
          std::get<PolygonMesh>(scene.surfaces[static_cast<std::size_t>(ref.surface)].shape);
      const auto& [image, factor] = textures.emission_texture(f);
      const PictureCells cells =
          picture_cells(image, textures.uv_map(f), polygons,
                        polygons.facets[static_cast<std::size_t>(ref.facet)], across);
      mean[static_cast<std::size_t>(f)] = factor.cast<double>();
      mean[static_cast<std::size_t>(f)].head<3>() *= mean_of(cells);
    }
  });
  return mean;
}

// Scales the emission of patches so that each facet sends the integral of its picture. The points
// of an element are too few for the texels that a large element may have.
void keep_integrals(const Scene& scene, const FacetTextures& textures, PatchMesh& mesh) {
  const std::vector<Eigen::ArrayXd> mean = pictured_means(scene, textures);
  std::vector<Eigen::ArrayXd> power(mean.size());
  std::vector<double> area(mean.size(), 0.0);
  const auto may_shine = [&](int patch) {
    const Material& m = scene.materials[static_cast<std::size_t>(mesh.material[patch])];
    return textures.has_emission(mesh.facet[mesh.first_element[patch]]) &&
           (mesh.is_back[patch] == 0 || m.emits_both_sides);
  };
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (!may_shine(p)) continue;
    const auto f = static_cast<std::size_t>(mesh.facet[mesh.first_element[p]]);
    if (power[f].size() == 0) power[f].setZero(mesh.emission.cols());
    power[f] += mesh.area[p] * mesh.emission.row(p).transpose().cast<double>();
    area[f] += mesh.area[p];
  }
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (!may_shine(p)) continue;
    const auto f = static_cast<std::size_t>(mesh.facet[mesh.first_element[p]]);
    const Eigen::ArrayXd scale =
        (power[f] > 0.0).select(area[f] * mean[f] / power[f].max(1e-300), 0.0);
    mesh.emission.row(p) *= scale.cast<float>().transpose();
  }
}

}  // namespace

Spectrum mean_emission(const PatchMesh& mesh, const FacetTextures& textures, int element) {
  const int facet = mesh.facet[element];
  const auto corner = corners_of(mesh, element);
  const CellGrid grid = cells_over(textures, facet, corner);
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(mesh.emission.cols());
  double area = 0.0;
  for (int i = 0; i < grid.along; ++i) {
    for (int j = 0; j < grid.across; ++j) {
      const TextureCell cell = texture_cell(corner, grid, i, j);
      sum += cell.area * textures.emission(facet, cell.middle, filter_of(cell)).cast<double>();
      area += cell.area;
    }
  }
  return (sum / area).cast<float>();
}

void lay_on_textures(const Scene& scene, PatchMesh& mesh) {
  attach_textures(scene, mesh);
  if (!mesh.textures) return;
  if (mesh.patterns) mesh.patterns->set_transmittance(mesh);
  const auto varies = [&](int patch) {
    for (int e = mesh.first_element[patch]; e < mesh.first_element[patch + 1]; ++e) {
      const int facet = mesh.facet[e];
      if (mesh.textures->is_textured(facet) || mesh.textures->has_holes(facet)) return true;
    }
    return false;
  };
  parallel_for(mesh.patch_count(), 16, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) {
      if (mesh.is_back[p] != 0) continue;
      if (varies(p)) lay_on_patch(scene, *mesh.textures, p, mesh);
      const int facet = mesh.facet[mesh.first_element[p]];  // emitters' patches lie on one facet
      if (mesh.textures->has_emission(facet) && (mesh.emission.row(p) > 0.0f).any()) {
        shine_on_patch(*mesh.textures, p, mesh);
      }
      if (const int back = back_of(mesh, p); back >= 0) copy_to_back(scene, p, back, mesh);
    }
  });
  if (mesh.textures->has_emission()) keep_integrals(scene, *mesh.textures, mesh);
}

void attach_textures(const Scene& scene, PatchMesh& mesh) {
  auto textures = std::make_shared<const FacetTextures>(scene);
  mesh.textures = textures->is_empty() ? nullptr : std::move(textures);
  mesh.patterns = mesh.textures && mesh.textures->has_patterns()
                      ? std::make_shared<const PatchPatterns>(scene, mesh)
                      : nullptr;
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
