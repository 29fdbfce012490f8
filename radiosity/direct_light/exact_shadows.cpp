#include "radiosity/direct_light/exact_shadows.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "radiosity/visibility/shadowed_polygon.h"
#include "scene/sampling.h"
#include "scene/specular.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;
using Plane = Eigen::Hyperplane<double, 3>;

// The bounding rectangle of points in a plane, counter-clockwise about `normal`.
std::vector<Vector3d> rectangle_about(std::span<const Vector3d> points, const Vector3d& normal) {
  Vector3d x, y;
  tangent_frame(normal, x, y);
  Eigen::AlignedBox2d box;
  for (const Vector3d& p : points) box.extend(Eigen::Vector2d(x.dot(p), y.dot(p)));
  const Vector3d at = normal.dot(points[0]) * normal;
  std::vector<Vector3d> corners;
  for (const auto& [u, v] : {std::pair(box.min().x(), box.min().y()),
                             {box.max().x(), box.min().y()},
                             {box.max().x(), box.max().y()},
                             {box.min().x(), box.max().y()}}) {
    corners.push_back(at + u * x + v * y);
  }
  if (x.cross(y).dot(normal) < 0.0) std::reverse(corners.begin(), corners.end());
  return corners;
}

ConvexPolygon reversed(ConvexPolygon polygon) {
  std::reverse(polygon.corner.begin(), polygon.corner.begin() + polygon.count);
  return polygon;
}

// Buffers of a thread, kept from one point to the next.
struct Scratch {
  std::vector<Plane> planes;
  std::vector<int> found;
  std::vector<Blocker> blockers;
  ShadowedPolygon view;
};

Scratch& scratch() {
  thread_local Scratch mine;
  return mine;
}

}  // namespace

ExactShadows::ExactShadows(const Scene& scene, const PatchMesh& mesh,
                           std::span<const Emitter> emitters) {
  const std::vector<FacetRef> facets = scene_facets(scene);
  const bool has_polygons = std::ranges::any_of(emitters, [](auto& e) { return !e.is_sphere; });
  if (facets.size() > most_facets || !has_polygons) return;
  occluders_.emplace(mesh);
  std::vector<char> is_pane(occluders_->sheet_of_facet.size(), 0);  // per sheet
  for (std::size_t f = 0; f < occluders_->sheet_of_facet.size(); ++f) {
    const int sheet = occluders_->sheet_of_facet[f];
    const Material& material = scene.materials[scene.surfaces[facets[f].surface].material];
    if (sheet >= 0 && is_clear_pane(material)) is_pane[static_cast<std::size_t>(sheet)] = 1;
  }
  std::vector<BoxTree::Box> boxes;
  for (const Occluder& piece : occluders_->pieces) {
    boxes.push_back(piece.box);
    const bool lets_through = piece.has_holes || is_pane[static_cast<std::size_t>(piece.sheet)];
    needs_rays_.push_back(lets_through ? 1 : 0);
  }
  for (const RoundShape& shape : occluders_->round_shapes) boxes.push_back(bounds(shape));
  tree_.emplace(std::move(boxes));
  for (const Emitter& emitter : emitters) targets_.push_back(target_of(emitter));
}

ExactShadows::Target ExactShadows::target_of(const Emitter& emitter) const {
  Target target;
  if (emitter.is_sphere) return target;
  target.front.parts = convex_pieces(emitter.loops, emitter.normal);
  double area = 0.0;
  for (const ConvexPolygon& part : target.front.parts) area += part.area();
  constexpr double all_of_it = 1e-6;
  if (!(std::abs(area - emitter.area) <= all_of_it * emitter.area)) return target;
  for (const Loop& loop : emitter.loops) {
    target.corners.insert(target.corners.end(), loop.begin(), loop.end());
  }
  const ConvexPolygon hull = convex_hull(target.corners, emitter.normal);
  target.front.hull = {hull.corners().begin(), hull.corners().end()};
  constexpr std::size_t few = 8;  // more planes cost more than they save
  if (target.front.hull.empty() || target.front.hull.size() > few) {
    target.front.hull = rectangle_about(target.corners, emitter.normal);
  }
  target.front.plane = {emitter.normal, emitter.normal.dot(emitter.loops[0][0])};
  target.back.plane = target.front.plane.opposite();
  for (const ConvexPolygon& part : target.front.parts) target.back.parts.push_back(reversed(part));
  target.back.hull = {target.front.hull.rbegin(), target.front.hull.rend()};
  const int sheet = occluders_->sheet_of_facet[static_cast<std::size_t>(emitter.facet)];
  target.is_exact = !is_covered(target, sheet) &&
                    std::ranges::none_of(target.front.parts, [&](const ConvexPolygon& part) {
                      Vector3d sum = Vector3d::Zero();
                      for (const Vector3d& corner : part.corners()) sum += corner;
                      return is_covered(Vector3d(sum / part.count), sheet);
                    });
  return target;
}

// True if another sheet lies in the target's plane and overlaps its bounding box.
bool ExactShadows::is_covered(const Target& target, int sheet) const {
  const double tolerance = occluders_->tolerance;
  BoxTree::Box box;
  for (const Vector3d& corner : target.corners) box.extend(corner);
  std::vector<int> found;
  tree_->find_overlaps(box, found);
  return std::ranges::any_of(found, [&](int k) {
    if (k >= static_cast<int>(occluders_->pieces.size())) return false;
    const Occluder& piece = occluders_->pieces[static_cast<std::size_t>(k)];
    const auto corners = piece.polygon.corners();
    return piece.sheet != sheet && all_below(corners, target.front.plane, tolerance) &&
           all_above(corners, target.front.plane, -tolerance);
  });
}

// True if a point of a sheet lies in another sheet as well, or in two pieces of its own sheet
// (facets that cover each other and share an edge are one sheet).
bool ExactShadows::is_covered(const Vector3d& point, int sheet) const {
  const double tolerance = occluders_->tolerance;
  const Vector3d margin = Vector3d::Constant(tolerance);
  std::vector<int>& found = scratch().found;
  tree_->find_overlaps({point - margin, point + margin}, found);
  int of_its_own = 0;
  for (const int k : found) {
    if (k >= static_cast<int>(occluders_->pieces.size())) continue;
    const Occluder& piece = occluders_->pieces[static_cast<std::size_t>(k)];
    if (std::abs(piece.plane.height(point)) > tolerance) continue;
    const double least = piece.sheet == sheet ? tolerance : -tolerance;
    const auto corners = piece.polygon.corners();
    bool is_inside = true;
    for (std::size_t i = 0; i < corners.size() && is_inside; ++i) {
      const Vector3d& a = corners[i];
      const Vector3d edge = corners[i + 1 < corners.size() ? i + 1 : 0] - a;
      is_inside = piece.plane.normal.cross(edge).dot(point - a) > least * edge.norm();
    }
    if (!is_inside) continue;
    if (piece.sheet != sheet || ++of_its_own > 1) return true;
  }
  return false;
}

std::optional<double> ExactShadows::share(int emitter, const SurfacePoint& at,
                                          int most_pieces) const {
  if (targets_.empty() || most_pieces < 0) return std::nullopt;
  const auto& [point, normal, facet] = at;
  const Target& target = targets_[static_cast<std::size_t>(emitter)];
  if (!target.is_exact) return std::nullopt;
  const double tolerance = occluders_->tolerance, height = target.front.plane.height(point);
  if (!(std::abs(height) > tolerance)) return std::nullopt;
  const Face& face = height > 0.0 ? target.front : target.back;
  const int sheet = facet >= 0 ? occluders_->sheet_of_facet[static_cast<std::size_t>(facet)] : -1;
  if (sheet >= 0 && is_covered(point, sheet)) return std::nullopt;

  auto& [planes, found, blockers, view] = scratch();
  planes.clear();
  planes.emplace_back(normal, point);
  planes.emplace_back(face.plane.normal, -face.plane.offset);
  for (std::size_t k = 0; k < face.hull.size(); ++k) {
    const Vector3d a = face.hull[k] - point,
                   b = face.hull[k + 1 < face.hull.size() ? k + 1 : 0] - point;
    const Vector3d inwards = b.cross(a);
    const double length = inwards.norm();
    constexpr double flat = 1e-12;
    if (length > flat * a.norm() * b.norm()) planes.emplace_back(inwards / length, point);
  }
  constexpr std::int64_t visits_for_a_piece = 16, least_visits = 64;
  std::int64_t visits = least_visits + visits_for_a_piece * most_pieces;
  if (!tree_->find_before(planes, tolerance, visits, found)) return std::nullopt;
  std::sort(found.begin(), found.end());

  const HalfSpace horizon{normal, normal.dot(point)};
  const auto is_outside = [&](std::span<const Vector3d> corners) {
    return std::ranges::any_of(planes, [&](const Plane& plane) {
      return std::ranges::none_of(
          corners, [&](const Vector3d& p) { return plane.signedDistance(p) > tolerance; });
    });
  };
  std::size_t count = 0;
  const auto most = static_cast<std::size_t>(std::min(most_pieces, ShadowedPolygon::most_blockers));
  for (const int k : found) {
    if (k >= static_cast<int>(occluders_->pieces.size())) {
      const RoundShape& shape =
          occluders_->round_shapes[static_cast<std::size_t>(k) - occluders_->pieces.size()];
      const bool is_past = std::ranges::any_of(planes, [&](const Plane& plane) {
        return reach(shape, plane.normal()) + plane.offset() <= tolerance;
      });
      if (is_past) continue;
      return std::nullopt;
    }
    const Occluder& piece = occluders_->pieces[static_cast<std::size_t>(k)];
    const double over = piece.plane.height(point);
    if (!(std::abs(over) > tolerance)) continue;  // edge-on
    const int side = over > 0.0 ? 1 : -1;
    const HalfSpace before{side * piece.plane.normal, side * piece.plane.offset};
    if (all_above(target.corners, before, -tolerance) || is_outside(piece.polygon.corners())) {
      continue;
    }
    if (needs_rays_[static_cast<std::size_t>(k)] || count == most) return std::nullopt;
    if (blockers.size() == count) blockers.emplace_back();
    if (make_point_blocker(piece, side, horizon, face.plane, target.corners, tolerance,
                           blockers[count])) {
      ++count;
    }
  }
  if (count == 0) return 1.0;
  view.set(face.parts, {blockers.data(), count});
  const ShadowedPolygon::View seen = view.view_from(point, normal);
  if (!(seen.all > 0.0)) return std::nullopt;
  constexpr double rounding = 1e-9;
  const double share = 1.0 - seen.hidden / seen.all;
  return share < rounding ? 0.0 : share > 1.0 - rounding ? 1.0 : share;
}

}  // namespace lightwell
