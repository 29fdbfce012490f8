#include "mesh/chosen_sizes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/errors.h"
#include "scene/round_shape.h"
#include "scene/scenery_box.h"

namespace lightwell {
namespace {

int side_count(const Material& material) {
  return material.one_sided || material.dielectric ? 1 : 2;
}

double boundary_length(const PolygonMesh& mesh, const Facet& facet) {
  double length = 0.0;
  const auto add = [&](const std::vector<int>& loop) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      length += (mesh.vertices[loop[i]] - mesh.vertices[loop[(i + 1) % loop.size()]]).norm();
    }
  };
  add(facet.boundary);
  for (const auto& hole : facet.holes) add(hole);
  return length;
}

// The area, m^2, of the facets of a surface that are near; moves `is_near` behind them.
double near_area(const Surface& surface, std::vector<char>::const_iterator& is_near) {
  if (round_shape(surface)) return *is_near++ ? surface_area(surface) : 0.0;
  const auto& mesh = std::get<PolygonMesh>(surface.shape);
  double area = 0.0;
  for (const Facet& facet : mesh.facets) area += *is_near++ ? facet_area(mesh, facet) : 0.0;
  return area;
}

// The area of what is near that the patch size is chosen by, m^2. Mirrors and glass need no patches
// but are cut as well: a large mirror in a scene with few diffuse surfaces must not make millions
// of elements.
double area_to_mesh(const Scene& scene, const Scenery& scenery) {
  double diffuse = 0.0, all = 0.0;
  auto is_near = scenery.is_near.begin();
  for (const Surface& surface : scene.surfaces) {
    const Material& material = scene.materials[surface.material];
    const double area = side_count(material) * near_area(surface, is_near);
    all += area;
    if (!material.is_specular() || material.mirrors_by_coat() || material.passes_straight() ||
        material.pattern) {
      diffuse += area;
    }
  }
  constexpr double most_of_all = 16.0;
  return std::max(diffuse, all / most_of_all);
}

// Patch size of `count` patches of even size in what is near, or of up to 2.5 times as many in a
// scene with much area in little space, such as a house of furnished rooms. There patches must not
// be large beside the mean free path of light from surface to surface, 4 V / A (Cauchy) for the
// area A within the box of that. The box's own surface does not count, since an empty room has no
// other. Both limits were set with a staircase of 257 000 facets in view: four times as many
// patches took a quarter more time and gained nothing.
double even_patch_size(const Scene& scene, const Scenery& scenery, int count) {
  constexpr double largest = 0.25, usual_count = 1600.0, most_times = 2.5;
  const double area = area_to_mesh(scene, scenery), size = std::sqrt(area / count);
  const Eigen::Vector3d extent = scenery.box.sizes();
  const double of_box =
      2.0 * (extent.x() * extent.y() + extent.y() * extent.z() + extent.z() * extent.x());
  if (!(area > of_box)) return size;
  const double free_path = 4.0 * extent.prod() / (area - of_box);
  return std::clamp(largest * std::sqrt(usual_count / count) * free_path,
                    size / std::sqrt(most_times), size);
}

void check(const Scene& scene, const MeshOptions& options) {
  if (scene_facets(scene).empty()) {
    throw InputError(fmt::format("{}{}the scene has no surfaces; there is nothing to mesh",
                                 scene.file.string(), scene.file.empty() ? "" : ": "));
  }
  if (!(options.max_patch_size >= 0.0) || !std::isfinite(options.max_patch_size)) {
    throw InputError(fmt::format(
        "the largest patch size is {} m; give a positive length, or 0 to have it chosen",
        options.max_patch_size));
  }
  for (const int count : {options.auto_patch_count, options.most_patches}) {
    if (count >= 1) continue;
    throw InputError(fmt::format("{} patches are asked for; give at least 1", count));
  }
  if (!(options.discontinuity_growth >= 0.0)) {
    throw InputError(fmt::format(
        "discontinuity lines may add {} times the elements; give a number that is not negative",
        options.discontinuity_growth));
  }
  if (!(options.max_element_size >= 0.0) || !std::isfinite(options.max_element_size)) {
    throw InputError(fmt::format(
        "the largest element size is {} m; give a positive length, or 0 to have it chosen",
        options.max_element_size));
  }
  if (options.max_element_size > 0.0 && options.max_patch_size > 0.0 &&
      options.max_element_size > options.max_patch_size) {
    throw InputError(fmt::format(
        "elements of {:.6g} m do not fit into patches of {:.6g} m; give elements that are smaller",
        options.max_element_size, options.max_patch_size));
  }
  constexpr int most_per_edge = 1000;
  if (options.elements_per_patch_edge < 1 || options.elements_per_patch_edge > most_per_edge) {
    throw InputError(fmt::format("{} elements along a patch edge are asked for; give 1 to {}",
                                 options.elements_per_patch_edge, most_per_edge));
  }
}

}  // namespace

double predicted_elements(const Scene& scene, const PatchSizes& sizes) {
  double count = 0.0;
  int number = 0;
  for (const Surface& surface : scene.surfaces) {
    const int sides = side_count(scene.materials[surface.material]);
    if (const auto* mesh = std::get_if<PolygonMesh>(&surface.shape)) {
      for (const Facet& facet : mesh->facets) {
        Eigen::AlignedBox3d box;
        for (const int v : facet.boundary) box.extend(mesh->vertices[static_cast<std::size_t>(v)]);
        count += sides * sizes.elements(sizes.of_facet(number++, box), facet_area(*mesh, facet),
                                        boundary_length(*mesh, facet));
      }
    } else {
      const double element = sizes.of_round_shape(number++).element_size();
      count += sides * surface_area(surface) / (element * element);
    }
  }
  return count;
}

CutSize cut_size(const Scene& scene, const MeshOptions& options) {
  check(scene, options);
  if (!(options.max_element_size > 0.0)) {
    return {.patch_size = options.max_patch_size > 0.0 ? options.max_patch_size
                                                       : even_patch_size(scene, near_scenery(scene),
                                                                         options.auto_patch_count),
            .elements_per_edge = options.elements_per_patch_edge};
  }
  const double element = options.max_element_size;
  if (options.max_patch_size > 0.0) {
    constexpr double rounding = 1e-5;  // relative rounding of lengths in a text file
    const double along = std::floor(options.max_patch_size / element + rounding);
    const auto count = static_cast<int>(std::clamp(along, 1.0, 1e3));
    return {.patch_size = std::min(options.max_patch_size, count * element),
            .elements_per_edge = count};
  }
  const double along =
      std::ceil(std::sqrt(area_to_mesh(scene, all_near(scene)) / options.most_patches) / element);
  const auto count = static_cast<int>(std::clamp(along, 2.0, 1e3));
  return {.patch_size = count * element, .elements_per_edge = count};
}

PatchSizes patch_sizes(const Scene& scene, const MeshOptions& options) {
  const CutSize near = cut_size(scene, options);
  if (options.max_patch_size > 0.0 || options.max_element_size > 0.0) return PatchSizes(near);
  Scenery scenery = near_scenery(scene);
  if (!scenery.has_surroundings) return PatchSizes(near);
  CutSize even = near;
  even.patch_size = even_patch_size(scene, all_near(scene), options.auto_patch_count);
  PatchSizes sizes(near, even.patch_size, std::move(scenery));
  constexpr double most_times = 64.0;  // the elements of even sizes
  const double most = most_times * predicted_elements(scene, PatchSizes(even));
  return predicted_elements(scene, sizes) <= most ? sizes : PatchSizes(even);
}

}  // namespace lightwell
