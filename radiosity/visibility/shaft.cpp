#include "radiosity/visibility/shaft.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "scene/parallel.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

bool has_on_both_sides(const PatchMesh& mesh, const HalfSpace& plane, double tolerance) {
  bool before = false, behind = false;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double height = plane.height(mesh.position(v));
    before = before || height > tolerance;
    behind = behind || height < -tolerance;
    if (before && behind) return true;
  }
  return false;
}

// Adds faces of the hull of both ends through an edge of `a` and a corner of `b`. Heights are
// positive outside the hull.
void add_hull_faces(const ShaftEnd& a, const ShaftEnd& b, double slack,
                    std::vector<HalfSpace>& faces) {
  constexpr double flat = 1e-12;
  for (const ConvexPolygon& part : a.parts) {
    for (int k = 0; k < part.count; ++k) {
      const Vector3d& from = part.corner[k];
      const Vector3d edge = part.corner[k + 1 < part.count ? k + 1 : 0] - from;
      for (const Vector3d& corner : b.corners) {
        const Vector3d across = edge.cross(corner - from);
        const double length = across.norm();
        if (!(length > flat * edge.norm() * (corner - from).norm())) continue;
        HalfSpace face{across / length, 0.0};
        face.offset = face.normal.dot(from);
        if (!all_below(a.corners, face, slack)) face = face.opposite();
        if (all_below(a.corners, face, slack) && all_below(b.corners, face, slack)) {
          faces.push_back(face);
        }
      }
    }
  }
}

// True if two coplanar convex polygons share more than a strip of width `tolerance`.
bool overlap(std::span<const Vector3d> a, std::span<const Vector3d> b, const Vector3d& normal,
             double tolerance) {
  const auto is_apart = [&](std::span<const Vector3d> p, std::span<const Vector3d> q) {
    if (p.size() < 3) return false;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Vector3d out = (p[(i + 1) % p.size()] - p[i]).cross(normal).normalized();
      const HalfSpace side{out, out.dot(p[i])};
      // `p` may run either way about the normal.
      if (all_above(q, side, -tolerance) && all_below(p, side, tolerance)) return true;
      if (all_below(q, side, tolerance) && all_above(p, side, -tolerance)) return true;
    }
    return false;
  };
  return !is_apart(a, b) && !is_apart(b, a);
}

}  // namespace

Shafts::Shafts(const PatchMesh& mesh) : occluders_(mesh) {
  const int count = static_cast<int>(occluders_.pieces.size());
  std::vector<char> is_inner(occluders_.pieces.size());
  parallel_for(count, 16, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) {
      is_inner[p] = has_on_both_sides(mesh, occluders_.pieces[p].plane, occluders_.tolerance);
    }
  });
  for (const bool inner : {true, false}) {
    Group& group = inner ? inner_ : outer_;
    std::vector<BoxTree::Box> boxes;
    for (int p = 0; p < count; ++p) {
      if ((is_inner[p] != 0) != inner) continue;
      group.pieces.push_back(p);
      boxes.push_back(occluders_.pieces[p].box);
    }
    group.tree = BoxTree(std::move(boxes));
  }
}

ShaftEnd Shafts::end(const PatchOutline& outline, int facet) const {
  ShaftEnd end{.sheet = facet >= 0 ? occluders_.sheet_of_facet[facet] : -1};
  if (!outline.is_polygon()) return end;
  end.parts = convex_pieces(outline.loops, outline.normal);
  end.plane = {outline.normal, outline.normal.dot(outline.loops[0][0])};
  for (const auto& loop : outline.loops) {
    end.corners.insert(end.corners.end(), loop.begin(), loop.end());
  }
  for (const Vector3d& v : end.corners) end.box.extend(v);
  return end;
}

ShaftEnd Shafts::end(const SurfacePoint& at) const {
  const auto& [point, normal, facet] = at;
  ShaftEnd end{.corners = {point},
               .plane = {normal, normal.dot(point)},
               .box = Eigen::AlignedBox3d(point, point)};
  if (facet >= 0) end.sheet = occluders_.sheet_of_facet[facet];
  return end;
}

bool Shafts::is_covered(const ShaftEnd& end) const {
  const double tolerance = occluders_.tolerance;
  const Vector3d margin = Vector3d::Constant(tolerance);
  const BoxTree::Box box(end.box.min() - margin, end.box.max() + margin);
  std::vector<int> found;
  for (const Group* group : {&inner_, &outer_}) {
    group->tree.find_overlaps(box, found);
    for (const int k : found) {
      const Occluder& piece = occluders_.pieces[group->pieces[k]];
      const auto corners = piece.polygon.corners();
      if (piece.sheet == end.sheet || !(piece.plane.normal.dot(end.plane.normal) < 0.0)) continue;
      if (!all_below(end.corners, piece.plane, tolerance) ||
          !all_above(end.corners, piece.plane, -tolerance)) {
        continue;
      }
      const auto on = [&](std::span<const Vector3d> part) {
        return overlap(part, corners, piece.plane.normal, tolerance);
      };
      if (end.parts.empty() && on(end.corners)) return true;
      for (const ConvexPolygon& part : end.parts) {
        if (on(part.corners())) return true;
      }
    }
  }
  return false;
}

void Shafts::find_in(const Group& group, const ShaftEnd& a, const ShaftEnd& b,
                     Between& between) const {
  const double tolerance = occluders_.tolerance;
  std::vector<int> found;
  group.tree.find_overlaps(a.box.merged(b.box), found);
  for (const int k : found) {
    const Occluder& piece = occluders_.pieces[group.pieces[k]];
    const auto corners = piece.polygon.corners();
    const HalfSpace& plane = piece.plane;
    const bool is_outside =
        all_below(corners, a.plane, tolerance) || all_below(corners, b.plane, tolerance) ||
        (all_below(a.corners, plane, tolerance) && all_below(b.corners, plane, tolerance)) ||
        (all_above(a.corners, plane, -tolerance) && all_above(b.corners, plane, -tolerance));
    if (!is_outside) between.pieces.push_back(group.pieces[k]);
  }
}

void Shafts::find(const ShaftEnd& a, const ShaftEnd& b, Between& between) const {
  between = {};
  find_in(inner_, a, b, between);
  // All that a patch, or a point on a facet, can see lies on one side of each outer piece's plane.
  if (a.sheet < 0 || b.sheet < 0) find_in(outer_, a, b, between);
  if (between.pieces.empty() && occluders_.round_shapes.empty()) return;
  const double tolerance = occluders_.tolerance;
  constexpr double rounding = 1e-3;  // relative to the tolerance
  std::vector<HalfSpace> faces = {a.plane.opposite(), b.plane.opposite()};
  add_hull_faces(a, b, rounding * tolerance, faces);
  add_hull_faces(b, a, rounding * tolerance, faces);
  std::erase_if(between.pieces, [&](int p) {
    return std::any_of(faces.begin(), faces.end(), [&](const HalfSpace& face) {
      return all_above(occluders_.pieces[p].polygon.corners(), face, -tolerance);
    });
  });
  std::sort(between.pieces.begin(), between.pieces.end());
  between.may_be_round =
      std::ranges::any_of(between.pieces, [&](int p) { return occluders_.pieces[p].has_holes; });
  const Eigen::AlignedBox3d box = a.box.merged(b.box);
  for (const RoundShape& shape : occluders_.round_shapes) {
    const Sphere ball = ball_around(shape);
    const bool is_outside = box.squaredExteriorDistance(ball.center) >= ball.radius * ball.radius ||
                            std::any_of(faces.begin(), faces.end(), [&](const HalfSpace& face) {
                              return -reach(shape, -face.normal) - face.offset >= -tolerance;
                            });
    if (!is_outside) {
      between.may_be_round = true;
      break;
    }
  }
}

}  // namespace lightwell
