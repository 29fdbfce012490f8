#include "mesh/planar_regions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "mesh/facet_loops.h"
#include "mesh/facet_plane.h"
#include "mesh/region_outline.h"
#include "mesh/welded_points.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

constexpr double weld_share = 1e-7;        // the precision of single-precision files, as in meshing
constexpr double least_thickness = 1e-13;  // of the diagonal: rounding of coordinates
constexpr double least_extent = 1e-9;      // of the diagonal: dust
constexpr double area_kept = 5e-10;        // what flattening may take of a region's area

// Facets of one surface that lie in one plane, grown from the largest.
class Regions {
 public:
  Regions(const FacetLoops& facets, const std::vector<Vector3d>& points, double tolerance)
      : facets_(facets),
        points_(points),
        tolerance_(tolerance),
        uses_(edge_uses(facets)),
        region_(static_cast<std::size_t>(facets.count()), -1) {
    index_edges();
    for (int f = 0; f < facets.count(); ++f) {
      const Vector3d vector = area_vector(facets, f, points);
      area_.push_back(vector.norm());
      normal_.push_back(area_.back() > 0.0 ? Vector3d(vector / area_.back()) : Vector3d::Zero());
    }
    std::vector<int> order(region_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return area_[a] > area_[b]; });
    for (const int seed : order) {
      if (region_[seed] < 0 && area_[seed] > 0.0) grow(seed);
    }
  }

  /// By facet: the region; -1 where nothing could be added to a facet.
  int region(int facet) const { return region_[facet]; }

  /// The loops of each region; empty if it cannot be one polygon.
  std::vector<std::vector<std::vector<int>>> outlines() const {
    std::vector<std::vector<RegionEdge>> edges(normal_of_region_.size());
    for_each_edge_group(uses_, [&](std::span<const EdgeUse> group) {
      const bool is_fan = group.size() > most_at_edge;  // nothing was joined over it
      for (std::size_t i = 0; i < group.size(); ++i) {
        const int r = region_[group[i].facet];
        if (r < 0) continue;
        const auto is_inside = [&](const EdgeUse& other) {
          return region_[other.facet] == r && other.forward != group[i].forward;
        };
        if (!is_fan && std::any_of(group.begin(), group.end(), is_inside)) continue;
        const auto [low, high] = std::pair(group[i].low, group[i].high);
        edges[r].push_back(group[i].forward ? RegionEdge{low, high} : RegionEdge{high, low});
      }
    });
    std::vector<std::vector<std::vector<int>>> outlines(edges.size());
    parallel_for(static_cast<int>(edges.size()), 16, [&](int begin, int end) {
      for (int r = begin; r < end; ++r) {
        auto loops = region_loops(std::move(edges[r]), points_, normal_of_region_[r]);
        if (loops && keeps_area(r, *loops)) outlines[r] = std::move(*loops);
      }
    });
    return outlines;
  }

 private:
  // Where in uses_ the edges of each facet's corners are.
  void index_edges() {
    group_begin_.resize(uses_.size());
    first_use_.assign(region_.size() + 1, 0);
    for (std::size_t begin = 0, end = 0; begin < uses_.size(); begin = end) {
      while (end < uses_.size() && uses_[end].same_edge(uses_[begin])) {
        group_begin_[end++] = static_cast<int>(begin);
      }
    }
    for (const EdgeUse& use : uses_) ++first_use_[use.facet + 1];
    std::partial_sum(first_use_.begin(), first_use_.end(), first_use_.begin());
    use_of_.resize(uses_.size());
    std::vector<int> next(first_use_.begin(), first_use_.end() - 1);
    for (std::size_t u = 0; u < uses_.size(); ++u) {
      use_of_[next[uses_[u].facet]++] = static_cast<int>(u);
    }
  }

  std::span<const EdgeUse> group_of(int use) const {
    const auto begin = static_cast<std::size_t>(group_begin_[use]);
    std::size_t end = begin;
    while (end < uses_.size() && end - begin <= most_at_edge &&
           uses_[end].same_edge(uses_[begin])) {
      ++end;
    }
    return std::span(uses_).subspan(begin, end - begin);
  }

  struct Growing {
    int number = 0;
    Vector3d normal, origin;
    double area = 0.0, lost = 0.0;
  };

  void grow(int seed) {
    Growing region{.number = static_cast<int>(normal_of_region_.size()),
                   .normal = normal_[seed],
                   .origin = points_[facets_.loop(facets_.facet_begin[seed])[0]],
                   .area = area_[seed]};
    std::vector<int> members{seed};
    region_[seed] = region.number;
    for (std::size_t m = 0; m < members.size(); ++m) {
      const int f = members[m];
      for (int k = first_use_[f]; k < first_use_[f + 1]; ++k) {
        const int next = across(use_of_[k], region);
        if (next < 0) continue;
        region.area += area_[next];
        region.lost += lost_by(next, region);
        region_[next] = region.number;
        members.push_back(next);
      }
    }
    if (members.size() == 1) {
      region_[seed] = -1;
      return;
    }
    normal_of_region_.push_back(region.normal);
    area_of_region_.push_back(region.area);
  }

  // The one facet that goes on in the region's plane over an edge of its; -1 if there is none, or
  // more than one.
  int across(int use, const Growing& region) const {
    const auto group = group_of(use);
    if (group.size() > most_at_edge) return -1;
    int found = -1;
    for (const EdgeUse& other : group) {
      if (other.facet == uses_[use].facet) {
        if (other.forward != uses_[use].forward) return -1;  // a bridge to a hole
        continue;
      }
      if (!lies_in(other.facet, region)) continue;
      if (other.forward == uses_[use].forward || found >= 0) return -1;
      found = other.facet;
    }
    if (found < 0 || region_[found] >= 0 || runs_along(found, region)) return -1;
    return found;
  }

  double lost_by(int facet, const Growing& region) const {
    return area_[facet] * (1.0 - normal_[facet].dot(region.normal));
  }

  bool lies_in(int facet, const Growing& region) const {
    const double lost = lost_by(facet, region);
    if (!(region.lost + lost <= area_kept * (region.area + area_[facet]))) return false;
    bool is_near = true;
    facets_.for_each_edge(facet, [&](int a, int) {
      is_near = is_near && std::abs(region.normal.dot(points_[a] - region.origin)) <= tolerance_;
    });
    return is_near;
  }

  // Whether the region has an edge of the facet's in the facet's direction: then they overlap.
  bool runs_along(int facet, const Growing& region) const {
    for (int k = first_use_[facet]; k < first_use_[facet + 1]; ++k) {
      const EdgeUse& mine = uses_[use_of_[k]];
      for (const EdgeUse& other : group_of(use_of_[k])) {
        if (other.facet != facet && region_[other.facet] == region.number &&
            other.forward == mine.forward) {
          return true;
        }
      }
    }
    return false;
  }

  bool keeps_area(int region, const std::vector<std::vector<int>>& loops) const {
    FacetLoops whole;
    for (const auto& loop : loops) whole.add_loop(loop);
    whole.end_facet();
    const double area = area_vector(whole, 0, points_).norm();
    return std::abs(area - area_of_region_[region]) <= 2.0 * area_kept * area;
  }

  static constexpr std::size_t most_at_edge = 8;  // facets; more is a fan whose sides nobody knows

  const FacetLoops& facets_;
  const std::vector<Vector3d>& points_;
  double tolerance_;
  std::vector<EdgeUse> uses_;
  std::vector<int> group_begin_;         // per use, in uses_
  std::vector<int> first_use_, use_of_;  // per facet, its uses
  std::vector<int> region_;
  std::vector<double> area_;
  std::vector<Vector3d> normal_;
  std::vector<Vector3d> normal_of_region_;
  std::vector<double> area_of_region_;
};

FacetLoops without(const FacetLoops& facets, const std::vector<char>& is_gone) {
  FacetLoops left;
  for (int f = 0; f < facets.count(); ++f) {
    if (is_gone[f]) continue;
    for (int l = facets.facet_begin[f]; l < facets.facet_begin[f + 1]; ++l) {
      left.add_loop(facets.loop(l));
    }
    left.end_facet();
  }
  return left;
}

// Corners that became one are one corner; loops that lose themselves so go.
FacetLoops welded_loops(const PolygonMesh& mesh, const std::vector<int>& point) {
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
    facets.end_facet();
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

// A region in the place of its first facet, the others as they are. `is_new` gets which are
// regions.
FacetLoops merged(const FacetLoops& facets, const std::vector<Vector3d>& points, double tolerance,
                  std::vector<char>& is_new, CleanUpReport& report) {
  const Regions regions(facets, points, tolerance);
  const auto outlines = regions.outlines();
  std::vector<char> is_placed(outlines.size(), 0);
  FacetLoops result;
  for (int f = 0; f < facets.count(); ++f) {
    const int r = regions.region(f);
    const bool is_part = r >= 0 && !outlines[r].empty();
    if (!is_part) {
      for (int l = facets.facet_begin[f]; l < facets.facet_begin[f + 1]; ++l) {
        result.add_loop(facets.loop(l));
      }
    } else {
      ++report.merged;
      if (is_placed[r]) continue;
      is_placed[r] = 1;
      for (const auto& loop : outlines[r]) result.add_loop(loop);
    }
    result.end_facet();
    is_new.push_back(is_part ? 1 : 0);
  }
  return result;
}

PolygonMesh polygon_mesh(const FacetLoops& facets, const std::vector<Vector3d>& points) {
  PolygonMesh mesh;
  std::vector<int> number(points.size(), -1);
  for (int f = 0; f < facets.count(); ++f) {
    Facet& facet = mesh.facets.emplace_back();
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

// One surface; `global` are its vertices' numbers in the scene's welded points.
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
  FacetLoops facets = welded_loops(mesh, point);

  const std::vector<char> is_degenerate = find_degenerate(facets, points, diagonal);
  found.degenerate = std::count(is_degenerate.begin(), is_degenerate.end(), 1);
  if (found.degenerate > 0) facets = without(facets, is_degenerate);
  if (facets.count() == 0) return {};
  const bool sides_are_alike =
      !material.one_sided && !material.dielectric && !material.is_emitter();
  const std::vector<char> is_duplicate = find_duplicates(facets, points, sides_are_alike);
  found.duplicates = std::count(is_duplicate.begin(), is_duplicate.end(), 1);
  if (found.duplicates > 0) facets = without(facets, is_duplicate);

  const std::vector<char> is_reversed = find_reversed(facets, points);
  for (int f = 0; f < facets.count(); ++f) {
    if (!is_reversed[f]) continue;
    facets.turn_over(f);
    ++found.flipped;
  }
  std::vector<char> is_new;
  facets = merged(facets, points, weld_share * diagonal, is_new, found);
  if (found.is_clean()) return {};
  straighten(facets, is_new, points);
  report = found;
  return polygon_mesh(facets, points);
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
  return fmt::format("{} facets became {}: {}", report.facets_before, report.facets_after,
                     fmt::join(what, ", "));
}

Scene merge_planar_regions(const Scene& scene, CleanUpReport* report) {
  Scene result = scene;
  CleanUpReport total;
  total.facets_before = static_cast<std::int64_t>(scene_facets(scene).size());
  total.facets_after = total.facets_before;
  const int count = static_cast<int>(scene.surfaces.size());
  if (total.facets_before > 0) {
    const double diagonal = scene_bounds(scene).diagonal();
    WeldedPoints welded(weld_share * diagonal);
    std::vector<std::vector<int>> point(scene.surfaces.size());
    for (int s = 0; s < count; ++s) {
      const auto* mesh = std::get_if<PolygonMesh>(&scene.surfaces[s].shape);
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
        const auto* mesh = std::get_if<PolygonMesh>(&scene.surfaces[s].shape);
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
    }
    total.facets_after = static_cast<std::int64_t>(scene_facets(result).size());
  }
  if (report) *report = total;
  return result;
}

}  // namespace lightwell
