#include "mesh/cleaning/planar_regions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "mesh/cleaning/crossing_polygons.h"
#include "mesh/cleaning/facet_loops.h"
#include "mesh/cleaning/hanging_points.h"
#include "mesh/cleaning/joined_surfaces.h"
#include "mesh/cleaning/plane_regions.h"
#include "mesh/cleaning/spread_power.h"
#include "mesh/cleaning/straighten.h"
#include "mesh/geometry/facet_plane.h"
#include "mesh/geometry/welded_points.h"
#include "mesh/patches/element_quality.h"
#include "scene/parallel.h"
#include "scene/scenery_box.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

constexpr double least_thickness = 1e-13;  // of the diagonal: the rounding of coordinates
constexpr double least_extent = 1e-9;      // of the diagonal; smaller facets are dust

FacetLoops without_facets(const FacetLoops& facets, const std::vector<char>& is_gone) {
  FacetLoops left;
  for (int f = 0; f < facets.count(); ++f) {
    if (is_gone[f]) continue;
    for (int l = facets.facet_begin[f]; l < facets.facet_begin[f + 1]; ++l) {
      left.add_loop(facets.loop(l));
    }
    left.end_facet(facets.maps[f]);
  }
  return left;
}

// The loops of a mesh over welded points. Equal neighbouring corners are joined, and holes left
// with fewer than three corners are dropped.
FacetLoops welded_loops(const PolygonMesh& mesh, const std::vector<int>& point, bool with_uv) {
  FacetLoops facets;
  std::vector<int> loop;
  const auto add = [&](const std::vector<int>& corners, bool is_boundary) {
    loop.clear();
    for (const int v : corners) {
      if (loop.empty() || loop.back() != point[v]) loop.push_back(point[v]);
    }
    while (loop.size() > 1 && loop.back() == loop.front()) loop.pop_back();
    if (loop.size() >= 3 || is_boundary) facets.add_loop(loop);
  };
  for (const Facet& facet : mesh.facets) {
    add(facet.boundary, true);
    for (const auto& hole : facet.holes) add(hole, false);
    facets.end_facet({.uv = with_uv ? facet.uv_map : -1, .normal = facet.normal_map});
  }
  return facets;
}

std::vector<char> find_degenerate(const FacetLoops& facets, const std::vector<Vector3d>& points,
                                  double diagonal) {
  std::vector<char> is_degenerate(static_cast<std::size_t>(facets.count()), 0);
  for (int f = 0; f < facets.count(); ++f) {
    Eigen::AlignedBox3d box;
    for (const int v : facets.loop(facets.facet_begin[f])) box.extend(points[v]);
    const double extent = box.diagonal().norm();
    const double area = area_vector(facets, f, points).norm();
    const bool has_area = facets.loop(facets.facet_begin[f]).size() >= 3 &&
                          extent > least_extent * diagonal &&
                          area > least_thickness * diagonal * extent;
    is_degenerate[f] = has_area ? 0 : 1;
  }
  return is_degenerate;
}

// Puts each region in the place of its first facet and keeps all other facets. Appends per facet to
// `is_new` whether it is a region.
FacetLoops merged(const FacetLoops& facets, const PlaneRegions& regions, std::vector<char>& is_new,
                  CleanUpReport& report) {
  std::vector<char> is_placed(regions.outlines.size(), 0);
  FacetLoops result;
  for (int f = 0; f < facets.count(); ++f) {
    const bool is_part = regions.is_merged(f);
    if (!is_part) {
      for (int l = facets.facet_begin[f]; l < facets.facet_begin[f + 1]; ++l) {
        result.add_loop(facets.loop(l));
      }
    } else {
      ++report.merged;
      const int r = regions.region[f];
      if (is_placed[r]) continue;
      is_placed[r] = 1;
      for (const auto& loop : regions.outlines[r]) result.add_loop(loop);
    }
    result.end_facet(facets.maps[f]);
    is_new.push_back(is_part ? 1 : 0);
  }
  return result;
}

PolygonMesh polygon_mesh(const FacetLoops& facets, const std::vector<Vector3d>& points) {
  PolygonMesh mesh;
  std::vector<int> number(points.size(), -1);
  for (int f = 0; f < facets.count(); ++f) {
    Facet& facet = mesh.facets.emplace_back();
    facet.uv_map = facets.maps[f].uv;
    facet.normal_map = facets.maps[f].normal;
    for (int l = facets.facet_begin[f]; l < facets.facet_begin[f + 1]; ++l) {
      std::vector<int>& loop =
          l == facets.facet_begin[f] ? facet.boundary : facet.holes.emplace_back();
      for (const int v : facets.loop(l)) {
        if (number[v] < 0) {
          number[v] = static_cast<int>(mesh.vertices.size());
          mesh.vertices.push_back(points[v]);
        }
        loop.push_back(number[v]);
      }
    }
  }
  return mesh;
}

// Cleans one surface; empty if nothing was found. `global` are the numbers of its vertices in the
// scene's welded points.
std::optional<PolygonMesh> cleaned(const PolygonMesh& mesh, const std::vector<int>& global,
                                   const WeldedPoints& welded, const Material& material,
                                   double diagonal, CleanUpReport& report) {
  std::vector<int> sorted = global, point;
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  if (!sorted.empty() && sorted.front() < 0) sorted.erase(sorted.begin());  // used by no facet
  std::vector<Vector3d> points;
  for (const int g : sorted) points.push_back(welded[g]);
  int used = 0;
  for (const int g : global) {
    used += g >= 0 ? 1 : 0;
    point.push_back(
        static_cast<int>(std::lower_bound(sorted.begin(), sorted.end(), g) - sorted.begin()));
  }
  CleanUpReport found;
  found.welded_vertices = used - static_cast<int>(points.size());
  const bool shows_picture = material.shows_picture();
  FacetLoops facets = welded_loops(mesh, point, shows_picture);

  const std::vector<char> is_degenerate = find_degenerate(facets, points, diagonal);
  found.degenerate = std::count(is_degenerate.begin(), is_degenerate.end(), 1);
  if (found.degenerate > 0) facets = without_facets(facets, is_degenerate);
  if (facets.count() == 0) return {};
  const bool emits_alike = !material.is_emitter() || material.emits_both_sides;
  const bool sides_are_alike = !material.one_sided && !material.dielectric && emits_alike;
  const std::vector<char> is_duplicate = find_duplicates(facets, points, sides_are_alike);
  found.duplicates = std::count(is_duplicate.begin(), is_duplicate.end(), 1);
  if (found.duplicates > 0) facets = without_facets(facets, is_duplicate);

  const double tolerance = weld_share * diagonal;
  FacetLoops whole_edged = with_hanging_points(facets, points, tolerance, found.hanging);
  const std::vector<char> is_reversed = find_reversed(whole_edged, points);
  for (int f = 0; f < facets.count(); ++f) {
    if (!is_reversed[f]) continue;
    facets.turn_over(f);
    whole_edged.turn_over(f);
    ++found.flipped;
  }
  std::vector<char> is_new;
  facets = merged(facets, find_plane_regions(whole_edged, points, tolerance), is_new, found);
  report = found;
  if (found.is_clean()) return {};
  straighten(facets, is_new, points, tolerance);
  PolygonMesh clean = polygon_mesh(facets, points);
  if (shows_picture) clean.uv_maps = mesh.uv_maps;
  clean.normal_maps = mesh.normal_maps;
  return clean;
}

}  // namespace

std::string sentence(const CleanUpReport& report) {
  if (report.is_clean()) return fmt::format("{} facets, nothing to clean up", report.facets_before);
  std::vector<std::string> what;
  const auto add = [&what](std::int64_t count, const char* words) {
    if (count > 0) what.push_back(fmt::format("{} {}", count, words));
  };
  add(report.welded_vertices, "vertices welded");
  add(report.degenerate, "facets without area dropped");
  add(report.duplicates, "duplicates dropped");
  add(report.flipped, "turned over");
  add(report.merged, "merged into larger polygons");
  add(report.joined, "joined with those of other surfaces");
  add(report.hanging, "vertices inside edges of their neighbours");
  return fmt::format("{} facets became {}: {}; area changed by {:.1e} of it", report.facets_before,
                     report.facets_after, fmt::join(what, ", "), std::abs(report.area_change()));
}

Scene merge_planar_regions(const Scene& scene, CleanUpReport* report) {
  Scene result = scene;
  CleanUpReport total;
  total.facets_before = static_cast<std::int64_t>(scene_facets(scene).size());
  total.facets_after = total.facets_before;
  cut_crossing_polygons(result);
  total.area_before = total.facets_before > 0 ? scene_area(result) : 0.0;
  const int count = static_cast<int>(scene.surfaces.size());
  if (total.facets_before > 0) {
    const double diagonal = coordinate_length(scene);
    WeldedPoints welded(weld_share * diagonal);
    std::vector<std::vector<int>> point(scene.surfaces.size());
    for (int s = 0; s < count; ++s) {
      const auto* mesh = std::get_if<PolygonMesh>(&result.surfaces[s].shape);
      if (!mesh) continue;
      const std::vector<double> radius = weld_radii(*mesh, welded.tolerance());
      point[s].assign(mesh->vertices.size(), -1);
      const auto add = [&](const std::vector<int>& loop) {
        for (const int v : loop) {
          if (point[s][v] < 0) point[s][v] = welded.add(mesh->vertices[v], radius[v]);
        }
      };
      for (const Facet& facet : mesh->facets) {
        add(facet.boundary);
        for (const auto& hole : facet.holes) add(hole);
      }
    }
    std::vector<CleanUpReport> found(scene.surfaces.size());
    parallel_for(count, 1, [&](int begin, int end) {
      for (int s = begin; s < end; ++s) {
        const auto* mesh = std::get_if<PolygonMesh>(&result.surfaces[s].shape);
        if (!mesh) continue;
        auto clean = cleaned(*mesh, point[s], welded, scene.materials[scene.surfaces[s].material],
                             diagonal, found[s]);
        if (clean) result.surfaces[s].shape = std::move(*clean);
      }
    });
    for (const CleanUpReport& r : found) {
      total.welded_vertices += r.welded_vertices;
      total.degenerate += r.degenerate;
      total.duplicates += r.duplicates;
      total.flipped += r.flipped;
      total.merged += r.merged;
      total.hanging += r.hanging;
    }
    total.duplicates += drop_shared_duplicates(result);
    const auto apart = static_cast<std::int64_t>(scene_facets(result).size());
    total.names = join_surfaces(result);
    total.facets_after = static_cast<std::int64_t>(scene_facets(result).size());
    if (total.names) total.joined = apart - total.facets_after;
    keep_stated_power(scene, result);
    total.area_after = scene_area(result);
  }
  if (report) *report = total;
  return result;
}

}  // namespace lightwell
