#include "mesh/cleaning/joined_surfaces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "mesh/cleaning/facet_loops.h"
#include "mesh/cleaning/hanging_points.h"
#include "mesh/cleaning/plane_regions.h"
#include "mesh/cleaning/straighten.h"
#include "mesh/geometry/box_tree.h"
#include "mesh/geometry/facet_plane.h"
#include "mesh/geometry/welded_points.h"
#include "scene/scenery_box.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

constexpr double reach_share = 1e-6;  // of the diagonal: a tolerance to which meshing may weld

Scene only(const Scene& scene, const std::vector<int>& numbers) {
  Scene part;
  for (const int s : numbers) part.surfaces.push_back(scene.surfaces[s]);
  return part;
}

std::vector<FacetPlane> planes_of(const Scene& scene, double tolerance) {
  WeldedPoints points(tolerance);
  return facet_planes(scene, points);
}

std::vector<BoxTree::Box> boxes_of(const std::vector<FacetPlane>& planes) {
  std::vector<BoxTree::Box> boxes;
  for (const FacetPlane& plane : planes) boxes.push_back(plane.box);
  return boxes;
}

/// The properties of a surface, except its shape, that determine its light; empty for a surface
/// that is not joined.
std::vector<double> light_key(const Surface& surface, const Material& material) {
  if (material.is_emitter() || material.dielectric || material.shows_picture()) return {};
  std::vector<double> key{static_cast<double>(surface.motion), material.one_sided ? 1.0 : 0.0,
                          static_cast<double>(material.specular_roughness),
                          material.coat ? double{material.coat->index_of_refraction} : 0.0};
  const Conductor metal = material.metal.value_or(Conductor{});
  for (const Spectrum* spectrum :
       {&material.reflectance, &material.specular, &material.transmittance,
        &material.regular_transmittance, &metal.eta, &metal.k}) {
    key.push_back(static_cast<double>(spectrum->size()));
    key.insert(key.end(), spectrum->begin(), spectrum->end());
  }
  return key;
}

std::vector<std::vector<int>> surfaces_alike(const Scene& scene) {
  std::map<std::vector<double>, std::vector<int>> alike;
  for (int s = 0; s < static_cast<int>(scene.surfaces.size()); ++s) {
    const Surface& surface = scene.surfaces[s];
    if (!std::holds_alternative<PolygonMesh>(surface.shape)) continue;
    const auto key = light_key(surface, scene.materials[surface.material]);
    if (!key.empty()) alike[key].push_back(s);
  }
  std::vector<std::vector<int>> groups;
  for (auto& [key, numbers] : alike) {
    if (numbers.size() > 1) groups.push_back(std::move(numbers));
  }
  std::ranges::sort(groups);
  return groups;
}

/// Polygons of similar surfaces over shared points.
struct Polygons {
  FacetLoops facets{};
  std::vector<FacetRef> from{};  ///< by facet
  WeldedPoints points;
};

Polygons polygons_of(const Scene& scene, const std::vector<int>& numbers, double tolerance) {
  Polygons all{.points = WeldedPoints(tolerance)};
  std::vector<int> loop;
  for (const int s : numbers) {
    const auto& mesh = std::get<PolygonMesh>(scene.surfaces[s].shape);
    const std::vector<double> radius = weld_radii(mesh, tolerance);
    const auto add = [&](const std::vector<int>& corners) {
      loop.clear();
      for (const int v : corners) loop.push_back(all.points.add(mesh.vertices[v], radius[v]));
      all.facets.add_loop(loop);
    };
    for (int f = 0; f < static_cast<int>(mesh.facets.size()); ++f) {
      const Facet& facet = mesh.facets[f];
      if (facet.normal_map >= 0) continue;
      add(facet.boundary);
      for (const auto& hole : facet.holes) add(hole);
      all.facets.end_facet();
      all.from.push_back({s, f});
    }
  }
  return all;
}

/// Marks the facets all of whose edges are shared with one other facet: each fills a hole of the
/// other.
std::vector<char> find_islands(const FacetLoops& facets) {
  constexpr int unknown = -1, none = -2;
  std::vector<int> around(static_cast<std::size_t>(facets.count()), unknown);
  for_each_edge_group(edge_uses(facets), [&](std::span<const EdgeUse> uses) {
    const bool is_pair = uses.size() == 2 && uses[0].facet != uses[1].facet;
    for (std::size_t i = 0; i < uses.size(); ++i) {
      int& mine = around[uses[i].facet];
      const int other = is_pair ? uses[1 - i].facet : none;
      mine = mine == unknown || mine == other ? other : none;
    }
  });
  std::vector<char> is_island;
  for (const int other : around) is_island.push_back(other >= 0 ? 1 : 0);
  return is_island;
}

/// The polygons of similar surfaces after joining.
struct Joined {
  std::vector<int> polygon{};  ///< per facet, its polygon in `whole`; -1: the facet stays
  /// Facets that stay, and each joined polygon in the place of its first facet.
  FacetLoops whole{};
  std::vector<char> is_new{};  ///< per facet of `whole`
};

std::optional<Joined> joined(const Polygons& all, double tolerance) {
  std::int64_t hanging = 0;
  FacetLoops whole_edged = with_hanging_points(all.facets, all.points.all(), tolerance, hanging);
  const std::vector<char> is_island = find_islands(whole_edged);
  for (int f = 0; f < whole_edged.count(); ++f) {
    // A map of its own, so the facet is merged with no other.
    if (is_island[f]) whole_edged.maps[f].uv = f;
  }
  const PlaneRegions regions = find_plane_regions(whole_edged, all.points.all(), tolerance);
  std::vector<int> first_surface(regions.outlines.size(), -1);
  std::vector<char> is_of_many(regions.outlines.size(), 0);
  for (int f = 0; f < all.facets.count(); ++f) {
    if (!regions.is_merged(f)) continue;
    int& first = first_surface[regions.region[f]];
    if (first < 0) first = all.from[f].surface;
    if (first != all.from[f].surface) is_of_many[regions.region[f]] = 1;
  }
  if (std::ranges::count(is_of_many, 1) == 0) return std::nullopt;
  Joined result;
  std::vector<int> place(regions.outlines.size(), -1);
  for (int f = 0; f < all.facets.count(); ++f) {
    const int r = regions.is_merged(f) ? regions.region[f] : -1;
    const bool is_part = r >= 0 && is_of_many[r];
    result.polygon.push_back(is_part ? place[r] : -1);
    if (is_part && place[r] >= 0) continue;
    if (is_part) {
      result.polygon.back() = place[r] = result.whole.count();
      for (const auto& loop : regions.outlines[r]) result.whole.add_loop(loop);
    } else {
      for (int l = all.facets.facet_begin[f]; l < all.facets.facet_begin[f + 1]; ++l) {
        result.whole.add_loop(all.facets.loop(l));
      }
    }
    result.whole.end_facet();
    result.is_new.push_back(is_part ? 1 : 0);
  }
  straighten(result.whole, result.is_new, all.points.all(), tolerance);
  return result;
}

/// Builds the polygons of a surface anew, without vertices that none uses.
class NewShape {
 public:
  explicit NewShape(const PolygonMesh& before) : before_(before) {
    mesh_.uv_maps = before.uv_maps;
    mesh_.normal_maps = before.normal_maps;
  }
  void keep(const Facet& facet) {
    Facet& copy = mesh_.facets.emplace_back(facet);
    const auto renumber = [&](std::vector<int>& loop) {
      for (int& v : loop) v = vertex(kept_, v, before_.vertices[v]);
    };
    renumber(copy.boundary);
    for (auto& hole : copy.holes) renumber(hole);
  }
  void add(const FacetLoops& facets, int f, const WeldedPoints& points) {
    Facet& facet = mesh_.facets.emplace_back();
    for (int l = facets.facet_begin[f]; l < facets.facet_begin[f + 1]; ++l) {
      auto& loop = l == facets.facet_begin[f] ? facet.boundary : facet.holes.emplace_back();
      for (const int p : facets.loop(l)) loop.push_back(vertex(added_, p, points[p]));
    }
  }
  PolygonMesh take() { return std::move(mesh_); }

 private:
  int vertex(std::map<int, int>& numbers, int old, const Vector3d& position) {
    const auto [at, is_new] = numbers.try_emplace(old, static_cast<int>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.push_back(position);
    return at->second;
  }

  const PolygonMesh& before_;
  PolygonMesh mesh_;
  std::map<int, int> kept_, added_;
};

/// Puts the joined polygons into the scene; appends the surfaces that had a part of one to
/// `changed`.
void take_over(const Polygons& all, const Joined& joined, Scene& scene, std::vector<int>& changed) {
  std::vector<char> is_placed(static_cast<std::size_t>(joined.whole.count()), 0);
  for (std::size_t begin = 0, end = 0; begin < all.from.size(); begin = end) {
    const int s = all.from[begin].surface;
    while (end < all.from.size() && all.from[end].surface == s) ++end;
    const auto is_part = [](int polygon) { return polygon >= 0; };
    if (std::none_of(joined.polygon.begin() + static_cast<std::ptrdiff_t>(begin),
                     joined.polygon.begin() + static_cast<std::ptrdiff_t>(end), is_part)) {
      continue;
    }
    changed.push_back(s);
    auto& mesh = std::get<PolygonMesh>(scene.surfaces[s].shape);
    NewShape shape(mesh);
    std::size_t next = begin;
    for (int f = 0; f < static_cast<int>(mesh.facets.size()); ++f) {
      const bool is_known = next < end && all.from[next].facet == f;
      const int polygon = is_known ? joined.polygon[next++] : -1;
      if (polygon < 0) {
        shape.keep(mesh.facets[f]);
      } else if (!is_placed[polygon]) {
        is_placed[polygon] = 1;
        shape.add(joined.whole, polygon, all.points);
      }
    }
    mesh = shape.take();
  }
}

}  // namespace

struct JoinedSurfaces::Planes {
  // Polygons of surfaces_; FacetPlane::surface is an index into surfaces_.
  std::vector<FacetPlane> all;
  BoxTree boxes;  // of the planes

  explicit Planes(std::vector<FacetPlane> planes) : all(std::move(planes)), boxes(boxes_of(all)) {}
};

JoinedSurfaces::JoinedSurfaces(const Scene& before, std::vector<int> numbers)
    : numbers_(std::move(numbers)),
      surfaces_(only(before, numbers_).surfaces),
      reach_(reach_share * coordinate_length(before)),
      planes_(std::make_shared<const Planes>(
          planes_of(only(before, numbers_), weld_share * coordinate_length(before)))) {}

int JoinedSurfaces::surface_at(const Vector3d& point, const Vector3d& front) const {
  const Vector3d reach = Vector3d::Constant(reach_);
  std::vector<int> found;
  planes_->boxes.find_overlaps({point - reach, point + reach}, found);
  constexpr double about_alike = 0.5;  // cosine; distinguishes the two sides
  int at_border = -1;
  for (const int i : found) {
    const FacetPlane& plane = planes_->all[i];
    if (plane.normal.dot(front) < about_alike || std::abs(plane.height(point)) > reach_) continue;
    const Eigen::Vector2d q = plane.project(point);
    if (plane.contains(q, 0.0)) return numbers_[plane.surface];
    if (at_border < 0 && plane.contains(q, reach_)) at_border = numbers_[plane.surface];
  }
  return at_border;
}

int JoinedSurfaces::surface_of(const PatchMesh& mesh, int element, const Vector3d& point) const {
  const int patch = mesh.patch[element], own = mesh.surface[patch];
  if (!std::ranges::binary_search(numbers_, own)) return own;
  const Vector3d normal = element_center(mesh, element).normal;
  const int found = surface_at(point, mesh.is_back[patch] ? Vector3d(-normal) : normal);
  return found >= 0 ? found : own;
}

Scene JoinedSurfaces::apart(Scene joined) const {
  for (std::size_t i = 0; i < numbers_.size(); ++i) joined.surfaces[numbers_[i]] = surfaces_[i];
  return joined;
}

std::int64_t drop_shared_duplicates(Scene& scene) {
  const double tolerance = weld_share * coordinate_length(scene);
  std::int64_t dropped = 0;
  for (const std::vector<int>& numbers : surfaces_alike(scene)) {
    const Polygons all = polygons_of(scene, numbers, tolerance);
    const std::vector<char> is_duplicate = find_duplicates(all.facets, all.points.all(), false);
    std::map<int, std::vector<char>> drop;  // by surface, per facet
    for (std::size_t i = 0; i < is_duplicate.size(); ++i) {
      if (is_duplicate[i] == 0) continue;
      const auto& [surface, facet] = all.from[i];
      auto& mesh = std::get<PolygonMesh>(scene.surfaces[surface].shape);
      drop.try_emplace(surface, mesh.facets.size(), 0).first->second[facet] = 1;
      ++dropped;
    }
    for (const auto& [surface, is_dropped] : drop) {
      auto& mesh = std::get<PolygonMesh>(scene.surfaces[surface].shape);
      NewShape shape(mesh);
      for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
        if (is_dropped[f] == 0) shape.keep(mesh.facets[f]);
      }
      mesh = shape.take();
    }
  }
  return dropped;
}

std::shared_ptr<const JoinedSurfaces> join_surfaces(Scene& scene) {
  const std::vector<std::vector<int>> groups = surfaces_alike(scene);
  if (groups.empty()) return nullptr;
  const double tolerance = weld_share * coordinate_length(scene);
  Scene before;
  std::vector<int> changed;
  for (const std::vector<int>& numbers : groups) {
    const Polygons all = polygons_of(scene, numbers, tolerance);
    const auto result = joined(all, tolerance);
    if (!result) continue;
    if (changed.empty()) before.surfaces = scene.surfaces;
    take_over(all, *result, scene, changed);
  }
  if (changed.empty()) return nullptr;
  std::ranges::sort(changed);
  return std::make_shared<const JoinedSurfaces>(before, std::move(changed));
}

}  // namespace lightwell
