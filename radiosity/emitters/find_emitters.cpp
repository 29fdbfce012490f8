#include "radiosity/emitters/find_emitters.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>

#include "mesh/patches/pictured_emission.h"
#include "radiosity/emitters/emission_tree.h"
#include "scene/limits.h"
#include "scene/picture_cells.h"

namespace lightwell {
namespace {

constexpr double largest_direct_area = 0.25;    // share of the scene's area that counts as "small"
constexpr std::size_t most_large_emitters = 1;  // facets that are emitters whatever their area

struct EmittingFacet {
  int facet = 0;
  double area = 0.0;
  float exitance = 0.0f;  // all bands
  std::shared_ptr<const EmissionTree> picture{};
};

Loop loop_points(const PolygonMesh& mesh, const std::vector<int>& loop) {
  Loop points;
  for (int v : loop) points.push_back(mesh.vertices[v]);
  return points;
}

// True for a convex polygon: a fan of triangles keeps samples better stratified than the many
// elements of the mesh.
bool is_convex_emitter(const Loop& loop, const Eigen::Vector3d& normal) {
  const std::size_t n = loop.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d a = loop[(i + 1) % n] - loop[i];
    const Eigen::Vector3d b = loop[(i + 2) % n] - loop[(i + 1) % n];
    if (a.cross(b).dot(normal) < 0.0) return false;
  }
  return true;
}

void tile(const PatchMesh& mesh, Emitter& emitter) {
  if (emitter.loops.size() == 1 && is_convex_emitter(emitter.loops[0], emitter.normal)) {
    const Loop& loop = emitter.loops[0];
    for (std::size_t i = 2; i < loop.size(); ++i) {
      emitter.triangles.push_back({loop[0], loop[i - 1], loop[i]});
    }
  } else {
    for (int e = 0; e < mesh.element_count(); ++e) {
      const int p = mesh.patch[e];
      if (mesh.facet[e] != emitter.facet || mesh.is_back[p]) continue;
      const auto& c = mesh.corners[e];
      emitter.triangles.push_back({mesh.position(c[0]), mesh.position(c[1]), mesh.position(c[2])});
      if (c[3] >= 0) {
        emitter.triangles.push_back(
            {mesh.position(c[0]), mesh.position(c[2]), mesh.position(c[3])});
      }
    }
  }
  double sum = 0.0;
  for (const auto& t : emitter.triangles) {
    sum += 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
    emitter.area_cdf.push_back(sum);
  }
  for (double& share : emitter.area_cdf) share /= sum;
}

void measure(Emitter& emitter) {
  if (emitter.is_sphere) {
    emitter.center = emitter.sphere.center;
    emitter.radius = emitter.sphere.radius;
    return;
  }
  double before = 0.0;
  for (std::size_t t = 0; t < emitter.triangles.size(); ++t) {
    const auto& [a, b, c] = emitter.triangles[t];
    emitter.center += (emitter.area_cdf[t] - before) / 3.0 * (a + b + c);
    before = emitter.area_cdf[t];
  }
  for (const Eigen::Vector3d& corner : emitter.loops[0]) {
    emitter.radius = std::max(emitter.radius, (corner - emitter.center).norm());
  }
}

// The picture by which a facet shines; null: none.
std::shared_ptr<const EmissionTree> picture_of(const Scene& scene, const FacetRef& ref,
                                               int most_across) {
  const Surface& surface = scene.surfaces[ref.surface];
  const auto& texture = scene.materials[surface.material].emission_texture;
  const auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
  if (!texture || !mesh || mesh->facets[ref.facet].uv_map < 0) return nullptr;
  const Facet& facet = mesh->facets[ref.facet];
  const UvMap& uv = mesh->uv_maps[facet.uv_map];
  auto tree = std::make_shared<const EmissionTree>(
      *texture, uv, picture_cells(texture->image, uv, *mesh, facet, most_across),
      facet_loops(*mesh, facet), facet_normal(*mesh, facet));
  return tree->is_empty() ? nullptr : tree;
}

// Facets that shine, in order. Pictures of `known` emitters are shared instead of made again.
std::vector<EmittingFacet> emitting_facets(const Scene& scene, const std::vector<FacetRef>& facets,
                                           std::span<const Emitter> known, double& scene_area) {
  const auto is_pictured = [&](const FacetRef& ref) {
    return scene.materials[scene.surfaces[ref.surface].material].emission_texture.has_value();
  };
  const int across =
      cells_across(static_cast<std::size_t>(std::ranges::count_if(facets, is_pictured)));
  std::vector<EmittingFacet> emitting;
  for (int f = 0; f < static_cast<int>(facets.size()); ++f) {
    const Surface& surface = scene.surfaces[facets[f].surface];
    const auto* polygons = std::get_if<PolygonMesh>(&surface.shape);
    double area = 0.0;
    if (polygons) {
      area = facet_area(*polygons, polygons->facets[facets[f].facet]);
    } else {
      area = surface_area(surface);
    }
    scene_area += area;
    const Material& material = scene.materials[surface.material];
    // Hemisphere rays find the light of frustums.
    if (!material.is_emitter() || std::holds_alternative<Frustum>(surface.shape)) continue;
    EmittingFacet facet{f, area, material.emission.sum()};
    if (material.emission_texture) {
      const auto before = std::ranges::find(known, f, &Emitter::facet);
      facet.picture =
          before != known.end() ? before->picture : picture_of(scene, facets[f], across);
    }
    if (facet.picture) facet.exitance = facet.picture->mean().sum();
    if (facet.exitance > 0.0f) emitting.push_back(std::move(facet));
  }
  std::stable_sort(emitting.begin(), emitting.end(),
                   [](const auto& a, const auto& b) { return a.exitance > b.exitance; });
  return emitting;
}

// A patch on the front of each facet; -1: the mesh has none.
std::vector<int> front_patches(const PatchMesh& mesh, std::size_t facet_count) {
  std::vector<int> front(facet_count, -1);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int p = mesh.patch[e];
    const auto facet = static_cast<std::size_t>(mesh.facet[e]);
    if (!mesh.is_back[p] && facet < facet_count) front[facet] = p;
  }
  return front;
}

// The exitance of an emitter's front as the mesh has it: of a picture its mean over the facet.
struct FrontExitance {
  explicit FrontExitance(const PatchMesh& of, std::size_t facet_count, bool any_picture)
      : mesh(of), patch(front_patches(of, facet_count)) {
    if (any_picture) mean_of_facet = facet_emission(of);
  }

  void set(Emitter& emitter) const {
    if (const int p = patch[emitter.facet]; p >= 0) {
      emitter.exitance = emitter.picture ? Spectrum(mean_of_facet.row(emitter.facet).transpose())
                                         : Spectrum(mesh.emission.row(p).transpose());
    }
    if (!emitter.picture) return;
    const Spectrum mean = emitter.picture->mean();
    emitter.picture_scale = (mean > 0.0f).select(emitter.exitance / mean.max(least_light), 0.0f);
  }

  const PatchMesh& mesh;
  std::vector<int> patch;
  BandArray mean_of_facet{};
};

Emitter emitter_of(const Scene& scene, const FacetRef& ref, const EmittingFacet& emitting,
                   const FrontExitance& exitance) {
  const Surface& surface = scene.surfaces[ref.surface];
  const Material& material = scene.materials[surface.material];
  Emitter emitter{.facet = emitting.facet,
                  .exitance = material.emission,
                  .picture = emitting.picture,
                  .area = emitting.area,
                  .emits_both_sides = material.emits_both_sides};
  exitance.set(emitter);
  if (const auto* polygons = std::get_if<PolygonMesh>(&surface.shape)) {
    const Facet& facet = polygons->facets[ref.facet];
    emitter.normal = facet_normal(*polygons, facet);
    emitter.loops = facet_loops(*polygons, facet);
    tile(exitance.mesh, emitter);
  } else {
    emitter.is_sphere = true;
    emitter.sphere = std::get<Sphere>(surface.shape);
  }
  measure(emitter);
  return emitter;
}

// The number of the facets of `emitting`, brightest first, whose light is direct light.
std::size_t direct_count(const std::vector<EmittingFacet>& emitting, double scene_area,
                         bool has_mirrors) {
  double taken = 0.0;
  std::size_t large = 0, count = 0;
  while (count < emitting.size()) {
    std::size_t end = count;
    double area = 0.0;
    constexpr float alike = 1.0f - 1e-6f;
    while (end < emitting.size() && emitting[end].exitance >= emitting[count].exitance * alike) {
      area += emitting[end++].area;
    }
    if (taken + area > largest_direct_area * scene_area) {
      large += end - count;
      // Rays over the hemisphere find a large emitter in mirrors with less noise than rays of its
      // own that meet the mirrors.
      if (has_mirrors || large > most_large_emitters) break;
    } else {
      taken += area;
    }
    count = end;
  }
  return count;
}

}  // namespace

std::vector<Loop> facet_loops(const PolygonMesh& mesh, const Facet& facet) {
  std::vector<Loop> loops = {loop_points(mesh, facet.boundary)};
  for (const auto& hole : facet.holes) loops.push_back(loop_points(mesh, hole));
  return loops;
}

std::vector<Emitter> find_emitters(const Scene& scene, const std::vector<FacetRef>& facets,
                                   const PatchMesh& mesh, std::span<const Emitter> known) {
  double scene_area = 0.0;
  const std::vector<EmittingFacet> emitting = emitting_facets(scene, facets, known, scene_area);
  const FrontExitance exitance(mesh, facets.size(),
                               std::ranges::any_of(emitting, [](auto& e) { return !!e.picture; }));
  // Coats mirror little.
  const bool has_mirrors = std::ranges::any_of(scene.materials, [](const Material& material) {
    return material.is_specular() && !material.mirrors_by_coat();
  });
  const std::size_t count = direct_count(emitting, scene_area, has_mirrors);
  std::vector<Emitter> emitters;
  for (std::size_t i = 0; i < count; ++i) {
    emitters.push_back(emitter_of(scene, facets[emitting[i].facet], emitting[i], exitance));
  }
  return emitters;
}

}  // namespace lightwell
