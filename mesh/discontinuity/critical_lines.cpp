#include "mesh/discontinuity/critical_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <tuple>

#include "mesh/discontinuity/critical_features.h"
#include "mesh/discontinuity/vertex_silhouette.h"
#include "mesh/discontinuity/wedge.h"
#include "mesh/geometry/box_tree.h"
#include "scene/parallel.h"
#include "scene/scenery_box.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

// A corner of an emitter with an edge of an occluder (VE), or an edge of an emitter with a corner
// of an occluder (EV).
struct Pairing {
  double weight = 0.0;  // see weight_of(), W/m
  int emitter = 0;
  bool is_vertex_edge = true;
  int emitter_feature = 0;   // corner or edge of the emitter
  int occluder_feature = 0;  // edge or vertex of the occluders
};

// Unoccluded irradiance at `at` on a surface with the unit vector `normal`, W/m^2: E = Phi cos_i
// cos_j / (pi d^2 + A). The emitter is a point in its centre; its area A bounds E at small
// distances.
double unshaded(const EmittingPolygon& emitter, const Vector3d& at, const Vector3d& normal) {
  const Vector3d d = at - emitter.center;
  const double cos_i = emitter.normal.dot(d.normalized());
  const double cos_j = std::abs(normal.dot(d.normalized()));
  if (!(cos_i > 0.0)) return 0.0;
  return emitter.power * cos_i * cos_j / (std::numbers::pi * d.squaredNorm() + emitter.area);
}

// Sorts by falling weight. Weights equal to rounding count as equal, so the order does not depend
// on the unit of length.
template <class Item>
void sort_by_weight(std::vector<Item>& items) {
  double most = 0.0;
  for (const Item& item : items) most = std::max(most, item.weight);
  if (!(most > 0.0)) return;
  constexpr double step = 1e-6, least = 1e-100;  // natural logarithms
  std::vector<std::pair<double, std::size_t>> order(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    order[i] = {-std::round(std::log(std::max(items[i].weight / most, least)) / step), i};
  }
  std::sort(order.begin(), order.end());
  std::vector<Item> sorted;
  sorted.reserve(items.size());
  for (const auto& [key, i] : order) sorted.push_back(std::move(items[i]));
  items = std::move(sorted);
}

class LineFinder {
 public:
  LineFinder(const Scene& scene, const std::vector<FacetPlane>& planes,
             const CriticalLineOptions& options, const Progress& progress)
      : scene_(scene),
        planes_(planes),
        options_(options),
        progress_(progress),
        features_(occluder_features(scene, planes)),
        emitters_(emitting_polygons(scene, planes)) {
    for (const FacetPlane& plane : planes) bounds_.extend(plane.box);
    tolerance_ = planes.empty() ? 0.0 : planes.front().weld_tolerance;
    std::vector<BoxTree::Box> boxes;
    for (const FacetPlane& plane : planes) {
      const bool is_clear =
          scene.materials[scene.surfaces[plane.surface].material].dielectric.has_value();
      boxes.push_back(is_clear ? BoxTree::Box() : grown(plane.box));
    }
    tree_ = std::make_unique<BoxTree>(std::move(boxes));
  }

  CriticalLines find() {
    CriticalLines result;
    limit_emitters(result);
    std::vector<Pairing> pairings = candidates();
    limit_pairings(pairings, result);
    std::vector<std::vector<CriticalLine>> found(pairings.size());
    const int count = static_cast<int>(pairings.size());
    constexpr int batch = 1024;  // wedges between two checks of the stop request
    for (int begin = 0; begin < count; begin += batch) {
      report(progress_, "mesh", 0.2 * begin / count);
      parallel_for(std::min(batch, count - begin), 8, [&](int from, int to) {
        for (int i = begin + from; i < begin + to; ++i) found[i] = lines_of(pairings[i]);
      });
    }
    collect(found, result);
    return result;
  }

 private:
  BoxTree::Box grown(const Eigen::AlignedBox3d& box) const {
    const Vector3d d = Vector3d::Constant(tolerance_);
    return {box.min() - d, box.max() + d};
  }

  void limit_emitters(CriticalLines& result) {
    // Every corner of an emitter is paired with every edge; more pairings than this take seconds.
    constexpr double most_pairings = 2e7;
    const double edges = static_cast<double>(features_.edges.size() + features_.vertices.size());
    double pairings = 0.0;
    int kept = 0;
    for (const EmittingPolygon& emitter : emitters_) {
      pairings += edges * static_cast<double>(emitter.corners.size());
      if (kept == options_.most_emitters || (kept > 0 && pairings > most_pairings)) break;
      ++kept;
    }
    result.emitters = kept;
    result.emitters_left_out = static_cast<int>(emitters_.size()) - kept;
    emitters_.resize(kept);
  }

  void limit_pairings(std::vector<Pairing>& pairings, CriticalLines& result) const {
    const auto most = static_cast<std::size_t>(std::max(0, options_.most_wedges));
    if (pairings.size() > most) {
      sort_by_weight(pairings);
      result.wedges_left_out = static_cast<std::int64_t>(pairings.size() - most);
      pairings.resize(most);
    }
    result.wedges = static_cast<int>(pairings.size());
  }

  bool is_lit(const EmittingPolygon& emitter, const Vector3d& p) const {
    return emitter.normal.dot(p - emitter.center) > tolerance_;
  }

  std::vector<Pairing> candidates() const {
    std::vector<Pairing> pairings;
    for (int k = 0; k < static_cast<int>(emitters_.size()); ++k) {
      const EmittingPolygon& emitter = emitters_[k];
      for (int e = 0; e < static_cast<int>(features_.edges.size()); ++e) {
        const OccluderEdge& edge = features_.edges[e];
        if (!is_lit(emitter, edge.from) && !is_lit(emitter, edge.to)) continue;
        const double weight = weight_of(emitter, 0.5 * (edge.from + edge.to), edge.from, edge.to);
        for (int c = 0; c < static_cast<int>(emitter.corners.size()); ++c) {
          if (!is_silhouette(edge, emitter.corners[c].position)) continue;
          pairings.push_back({weight, k, true, c, e});
        }
      }
      for (int v = 0; v < static_cast<int>(features_.vertices.size()); ++v) {
        const OccluderVertex& vertex = features_.vertices[v];
        if (!is_lit(emitter, vertex.position)) continue;
        for (int e = 0; e < static_cast<int>(emitter.edges.size()); ++e) {
          const auto& [a, b] = emitter.edges[e];
          pairings.push_back({weight_of(emitter, vertex.position, a, b), k, false, e, v});
        }
      }
    }
    return pairings;
  }

  // Unoccluded irradiance at `at`, facing the emitter, times the length of the wedge's edge, W/m.
  static double weight_of(const EmittingPolygon& emitter, const Vector3d& at, const Vector3d& from,
                          const Vector3d& to) {
    return unshaded(emitter, at, (at - emitter.center).normalized()) * (to - from).norm();
  }

  // True if a point light at v could make the edge a bound of a shadow: the edge's facets do not
  // lie on both sides of the plane through v and the edge.
  bool is_silhouette(const OccluderEdge& edge, const Vector3d& v) const {
    const Vector3d normal = (edge.from - v).cross(edge.to - edge.from);
    // in tolerances; the plane of a narrower wedge is undefined
    constexpr double least_width = 10.0;
    const double length = (edge.to - edge.from).norm();
    if (!(normal.norm() > least_width * tolerance_ * length)) return false;
    bool front = false, back = false;
    for (const Vector3d& inwards : edge.inwards) {
      const double side = inwards.dot(normal) / normal.norm();
      constexpr double in_plane = 1e-9;
      front |= side > in_plane;
      back |= side < -in_plane;
    }
    return !(front && back);
  }

  std::vector<CriticalLine> lines_of(const Pairing& pairing) const {
    const EmittingPolygon& emitter = emitters_[pairing.emitter];
    if (pairing.is_vertex_edge) {
      const OccluderEdge& edge = features_.edges[pairing.occluder_feature];
      const auto& corner = emitter.corners[pairing.emitter_feature];
      // Only the part of the edge in front of the emitter is lit.
      Vector3d p = edge.from, q = edge.to;
      const double hp = emitter.normal.dot(p - emitter.center) - tolerance_;
      const double hq = emitter.normal.dot(q - emitter.center) - tolerance_;
      if (hp < 0.0) p += hp / (hp - hq) * (edge.to - edge.from);
      if (hq < 0.0) q += hq / (hq - hp) * (edge.from - edge.to);
      if (!((q - p).norm() > tolerance_)) return {};
      const Wedge wedge = vertex_edge_wedge(corner.position, p, q);
      const LineDegree degree = in_plane(wedge, corner.edges) ? LineDegree::d1 : LineDegree::d2;
      return follow(wedge, {WedgeRange{}}, degree, emitter);
    }
    const auto& [a, b] = emitter.edges[pairing.emitter_feature];
    const OccluderVertex& vertex = features_.vertices[pairing.occluder_feature];
    const Wedge wedge = edge_vertex_wedge(a, b, vertex.position);
    if (!(wedge.along.cross(wedge.across).norm() > 10.0 * tolerance_ * wedge.across.norm()))
      return {};
    std::vector<FacetSector> sectors;
    std::vector<int> near;
    tree_->find_overlaps({vertex.position, vertex.position}, near);
    for (const int i : near) add_sectors(planes_[i], vertex.position, tolerance_, sectors);
    const LineDegree degree = in_plane(wedge, vertex.edges) ? LineDegree::d1 : LineDegree::d2;
    return follow(wedge, silhouette_ranges(wedge, sectors), degree, emitter);
  }

  static bool in_plane(const Wedge& wedge, const std::vector<Vector3d>& edges) {
    constexpr double rounding = 1e-7;
    return std::any_of(edges.begin(), edges.end(),
                       [&](const Vector3d& d) { return std::abs(wedge.normal.dot(d)) < rounding; });
  }

  std::vector<CriticalLine> follow(const Wedge& wedge, const std::vector<WedgeRange>& ranges,
                                   LineDegree degree, const EmittingPolygon& emitter) const {
    if (ranges.empty()) return {};
    std::vector<int> near;
    tree_->find_on_plane(reach_of(wedge), {wedge.normal, wedge.apex}, near);
    std::erase_if(near, [&](int i) {
      return std::binary_search(emitter.planes.begin(), emitter.planes.end(), i);
    });
    std::vector<CriticalLine> lines;
    for (const WedgeTrace& trace : trace_wedge(wedge, ranges, planes_, near, tolerance_)) {
      const double length = (trace.to - trace.from).norm();
      const FacetPlane& plane = planes_[trace.facet];
      const Material& material = scene_.materials[scene_.surfaces[plane.surface].material];
      const bool from_behind = plane.height(emitter.center) < 0.0;
      if (!(length > tolerance_) || (material.one_sided && from_behind)) continue;
      const LineDegree of_trace = trace.is_contact ? LineDegree::d0 : degree;
      constexpr double d2_share = 0.25;
      const double share = of_trace == LineDegree::d2 ? d2_share : 1.0;
      lines.push_back({.plane = trace.facet,
                       .facet = plane.facet,
                       .ends = {trace.from, trace.to},
                       .degree = of_trace,
                       .is_vertex_edge = wedge.is_vertex_edge,
                       .emitter = planes_[emitter.planes.front()].facet,
                       .penumbra = {penumbra_width(wedge, emitter, plane, trace.from),
                                    penumbra_width(wedge, emitter, plane, trace.to)},
                       .weight = share * length *
                                 unshaded(emitter, 0.5 * (trace.from + trace.to), plane.normal)});
    }
    return lines;
  }

  // Width of the penumbra at `at`, metres: the emitter's extent across the wedge, projected through
  // the occluder onto the receiver.
  static double penumbra_width(const Wedge& wedge, const EmittingPolygon& emitter,
                               const FacetPlane& plane, const Vector3d& at) {
    double low = 0.0, high = 0.0;  // the wedge's plane touches the emitter at height 0
    for (const auto& corner : emitter.corners) {
      const double height = wedge.normal.dot(corner.position - wedge.apex);
      low = std::min(low, height);
      high = std::max(high, height);
    }
    // The ray through `at` has alpha = dual . (at - apex) / (dual . along), with `dual`
    // perpendicular to `across`.
    const Vector3d dual = wedge.across.cross(wedge.normal);
    const double alpha = dual.dot(at - wedge.apex) / dual.dot(wedge.along);
    const double beyond = wedge.is_vertex_edge ? alpha - 1.0 : alpha;
    const double sine = wedge.normal.cross(plane.normal).norm();
    return (high - low) * beyond / sine;
  }

  // The bounding box of the wedge within the bounds of the scene.
  BoxTree::Box reach_of(const Wedge& wedge) const {
    BoxTree::Box box(wedge.apex);
    for (const double s : {0.0, 1.0}) {
      box.extend(wedge.at(s, wedge.is_vertex_edge ? 1.0 : -1.0));
      for (int axis = 0; axis < 3; ++axis) {
        const double d = wedge.direction(s)[axis];
        if (d > 0.0) box.max()[axis] = bounds_.max()[axis];
        if (d < 0.0) box.min()[axis] = bounds_.min()[axis];
      }
    }
    return box;
  }

  // The contact line of an edge is found from every corner of every emitter; only the first is
  // kept.
  static void collect(const std::vector<std::vector<CriticalLine>>& found, CriticalLines& result) {
    std::set<std::array<double, 7>> contacts;
    for (const auto& lines : found) {
      for (const CriticalLine& line : lines) {
        const auto& [a, b] = line.ends;
        if (line.degree == LineDegree::d0 && !contacts
                                                  .insert({static_cast<double>(line.plane), a.x(),
                                                           a.y(), a.z(), b.x(), b.y(), b.z()})
                                                  .second) {
          continue;
        }
        result.lines.push_back(line);
      }
    }
    sort_by_weight(result.lines);
  }

  const Scene& scene_;
  const std::vector<FacetPlane>& planes_;
  const CriticalLineOptions& options_;
  const Progress& progress_;
  OccluderFeatures features_;
  std::vector<EmittingPolygon> emitters_;
  Eigen::AlignedBox3d bounds_{};
  double tolerance_ = 0.0;
  std::unique_ptr<BoxTree> tree_;
};

}  // namespace

CriticalLines critical_lines(const Scene& scene, const std::vector<FacetPlane>& planes,
                             const CriticalLineOptions& options, const Progress& progress) {
  return LineFinder(scene, planes, options, progress).find();
}

CriticalLines critical_lines(const Scene& scene, const CriticalLineOptions& options) {
  WeldedPoints points(weld_share * coordinate_length(scene));
  const std::vector<FacetPlane> planes = facet_planes(scene, points);
  return critical_lines(scene, planes, options);
}

}  // namespace lightwell
