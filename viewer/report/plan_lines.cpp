#include "viewer/report/plan_lines.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <utility>
#include <variant>

#include "scene/io/round_facets.h"
#include "scene/lamp_faces.h"
#include "scene/round_shape.h"

namespace lightwell {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Coordinates of a plan: u and v in the plane of the grid, and the height above it.
struct PlanFrame {
  const LuxGrid& grid;
  Vector3d normal;

  explicit PlanFrame(const LuxGrid& of) : grid(of), normal(of.u.cross(of.v)) {}
  Vector2d flat(const Vector3d& p) const {
    return {(p - grid.corner).dot(grid.u), (p - grid.corner).dot(grid.v)};
  }
  double height(const Vector3d& p) const { return (p - grid.corner).dot(normal); }
};

bool is_in(const PlanLines& plan, const Vector2d& p) {
  return (p.array() >= plan.low.array()).all() && (p.array() <= plan.high.array()).all();
}

bool may_show(const PlanLines& plan, const Vector2d& a, const Vector2d& b) {
  return (a.cwiseMax(b).array() >= plan.low.array()).all() &&
         (a.cwiseMin(b).array() <= plan.high.array()).all();
}

// The area over the grid and its margin, and some of what is behind the walls.
void set_area(const LuxGrid& grid, PlanLines& plan) {
  const Vector2d size(grid.columns * grid.step_u, grid.rows * grid.step_v);
  constexpr double wall = 0.5, share = 0.15;  // m; of the longer side, for small models
  const double border = grid.options.margin + std::min(wall, share * size.maxCoeff());
  plan.low = Vector2d::Constant(-border);
  plan.high = size + Vector2d::Constant(border);
}

// Median free height above the points, m; infinite in the open.
double free_height(const ElementCaster& caster, const LuxGrid& grid) {
  constexpr double off_the_surface = 1e-3;  // m
  std::vector<Ray> rays;
  for (const Probe& point : grid.points) {
    rays.push_back(
        {.origin = point.position + off_the_surface * point.normal, .direction = point.normal});
  }
  std::vector<ElementHit> hits(rays.size());
  caster.closest_hits(rays, hits);
  std::vector<double> heights;
  for (const ElementHit& hit : hits) {
    heights.push_back(hit.facet >= 0 ? hit.t : std::numeric_limits<double>::infinity());
  }
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  return heights.empty() ? std::numeric_limits<double>::infinity() : *middle;
}

template <class Visit>
void for_each_facet(const Scene& scene, Visit&& visit) {
  for (const Surface& surface : scene.surfaces) {
    if (std::holds_alternative<Sphere>(surface.shape)) continue;
    const auto* frustum = std::get_if<Frustum>(&surface.shape);
    const PolygonMesh cut = frustum ? facets_of(*frustum) : PolygonMesh();
    const PolygonMesh& mesh = frustum ? cut : std::get<PolygonMesh>(surface.shape);
    const Material& material = scene.materials[static_cast<std::size_t>(surface.material)];
    for (const Facet& facet : mesh.facets) visit(mesh, facet, material);
  }
}

template <class Visit>
void for_each_edge(const PolygonMesh& mesh, const Facet& facet, Visit&& visit) {
  const auto around = [&](const std::vector<int>& loop) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      visit(mesh.vertices[static_cast<std::size_t>(loop[i])],
            mesh.vertices[static_cast<std::size_t>(loop[(i + 1) % loop.size()])]);
    }
  };
  around(facet.boundary);
  for (const auto& hole : facet.holes) around(hole);
}

// Cuts a facet by the plane at plan.cut_height. The cut runs between the first and the second
// crossing of the facet's boundary along the line, between the third and the fourth, and so on.
void cut_facet(const PlanFrame& frame, const PolygonMesh& mesh, const Facet& facet, bool is_pane,
               PlanLines& plan) {
  const Vector3d along3 = facet_normal(mesh, facet).cross(frame.normal);
  const Vector2d along(along3.dot(frame.grid.u), along3.dot(frame.grid.v));
  std::vector<Vector2d> crossings;
  for_each_edge(mesh, facet, [&](const Vector3d& a, const Vector3d& b) {
    const double ha = frame.height(a) - plan.cut_height, hb = frame.height(b) - plan.cut_height;
    if ((ha >= 0.0) == (hb >= 0.0)) return;
    crossings.push_back(frame.flat(a + ha / (ha - hb) * (b - a)));
  });
  std::ranges::sort(crossings, {}, [&](const Vector2d& p) { return p.dot(along); });
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
    if (!may_show(plan, crossings[i], crossings[i + 1])) continue;
    (is_pane ? plan.panes : plan.walls).push_back({crossings[i], crossings[i + 1]});
  }
}

// The circle of a sphere.
std::vector<Vector2d> circle_of(const Vector2d& middle, double radius) {
  constexpr int sides = 48;
  std::vector<Vector2d> circle;
  for (int i = 0; i < sides; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / sides;
    circle.push_back(middle + radius * Vector2d(std::cos(turn), std::sin(turn)));
  }
  return circle;
}

void cut_spheres(const Scene& scene, const PlanFrame& frame, PlanLines& plan) {
  for (const Surface& surface : scene.surfaces) {
    const auto* sphere = std::get_if<Sphere>(&surface.shape);
    if (!sphere) continue;
    const double height = frame.height(sphere->center);
    const double lowest = height - sphere->radius;
    if (lowest > plan.cut_height || height < -frame.grid.options.height - sphere->radius) continue;
    const double off = std::max(0.0, height - plan.cut_height);  // cut below the middle
    const double radius = std::sqrt(std::max(0.0, sphere->radius * sphere->radius - off * off));
    const std::vector<Vector2d> circle = circle_of(frame.flat(sphere->center), radius);
    for (std::size_t i = 0; i < circle.size(); ++i) {
      const Vector2d &from = circle[i], &to = circle[(i + 1) % circle.size()];
      if (may_show(plan, from, to)) plan.edges.push_back({from, to});
    }
  }
}

// An edge of facets below the cutting plane.
struct Edge3 {
  Vector3d from, to;
  Vector3d normal;      // of the first facet
  bool is_kept = true;  // false: between two facets that lie nearly in one plane
};

// Coordinates on a raster of 10 micrometres, so that facets of different surfaces share edges.
using RasterPoint = std::array<std::int64_t, 3>;
RasterPoint raster(const Vector3d& p) {
  constexpr double per_metre = 1e5;
  return {std::llround(p.x() * per_metre), std::llround(p.y() * per_metre),
          std::llround(p.z() * per_metre)};
}

std::vector<Edge3> edges_below(const Scene& scene, const PlanFrame& frame, const PlanLines& plan) {
  const double floor = -frame.grid.options.height;
  constexpr double slack = 0.02;  // m, for floors that are not quite level
  constexpr double flat = 0.9;    // cosine of 26 degrees; tessellated bodies bend less at an edge
  std::map<std::pair<RasterPoint, RasterPoint>, Edge3> edges;
  for_each_facet(scene, [&](const PolygonMesh& mesh, const Facet& facet, const Material&) {
    const Vector3d normal = facet_normal(mesh, facet);
    for_each_edge(mesh, facet, [&](Vector3d a, Vector3d b) {
      const double ha = frame.height(a), hb = frame.height(b);
      if (std::max(ha, hb) < floor - slack || std::min(ha, hb) > plan.cut_height) return;
      if (!may_show(plan, frame.flat(a), frame.flat(b))) return;
      const std::pair<RasterPoint, RasterPoint> key = std::minmax(raster(a), raster(b));
      if (ha > plan.cut_height) a += (ha - plan.cut_height) / (ha - hb) * (b - a);
      if (hb > plan.cut_height) b += (hb - plan.cut_height) / (hb - ha) * (a - b);
      const auto [at, is_new] = edges.try_emplace(key, Edge3{a, b, normal});
      if (!is_new) at->second.is_kept = std::abs(at->second.normal.dot(normal)) < flat;
    });
  });
  std::vector<Edge3> kept;
  constexpr double shortest = 0.005;  // m in the plan; upright edges are points
  for (const auto& [key, edge] : edges) {
    const double length = (frame.flat(edge.to) - frame.flat(edge.from)).norm();
    if (edge.is_kept && length > shortest) kept.push_back(edge);
  }
  constexpr std::size_t most = 5000;
  std::ranges::stable_sort(kept, std::greater{},
                           [](const Edge3& edge) { return (edge.to - edge.from).norm(); });
  if (kept.size() > most) kept.resize(most);
  return kept;
}

// Adds the pieces of edges that nothing below the cutting plane hides from above.
void add_seen(const ElementCaster& caster, const PlanFrame& frame, const std::vector<Edge3>& edges,
              PlanLines& plan) {
  constexpr double piece_length = 0.1, aside = 1e-3;  // m
  constexpr int most_pieces = 64;
  for (const Edge3& edge : edges) {
    const Vector3d way = edge.to - edge.from;
    const int pieces =
        std::clamp(static_cast<int>(std::ceil(way.norm() / piece_length)), 1, most_pieces);
    const Vector3d side = aside * way.cross(frame.normal).normalized();
    std::vector<Ray> rays;  // two for each piece, on either side of the edge
    for (int i = 0; i < pieces; ++i) {
      const Vector3d middle = edge.from + (i + 0.5) / pieces * way;
      const double up = plan.cut_height - frame.height(middle);
      for (const double sign : {1.0, -1.0}) {
        rays.push_back({.origin = middle + sign * side + aside * frame.normal,
                        .direction = frame.normal,
                        .t_max = std::max(up - aside, 0.0)});
      }
    }
    std::vector<std::uint8_t> blocked(rays.size());
    caster.occluded(rays, blocked);
    int first = -1;
    for (int i = 0; i <= pieces; ++i) {
      const auto at = static_cast<std::size_t>(2 * i);
      const bool is_seen = i < pieces && (blocked[at] == 0 || blocked[at + 1] == 0);
      if (is_seen && first < 0) first = i;
      if (is_seen || first < 0) continue;
      plan.edges.push_back({frame.flat(edge.from + double(first) / pieces * way),
                            frame.flat(edge.from + double(i) / pieces * way)});
      first = -1;
    }
  }
}

// The outline of an opening; a lamp without one has a sign in its place.
PlanLuminaire luminaire_of(const PlanFrame& frame, Lamp lamp) {
  constexpr double sign = 0.12;  // m
  if (lamp.opening.is_point())
    lamp.opening = {.along_c0 = sign, .along_c90 = sign, .is_round = true};
  PlanLuminaire luminaire{.outlines = {{}}, .middle = frame.flat(lamp.position)};
  for (const Vector3d& p : opening_outline(lamp)) luminaire.outlines[0].push_back(frame.flat(p));
  return luminaire;
}

// One luminaire for all facets of a surface that emits.
PlanLuminaire luminaire_of(const PlanFrame& frame, const PolygonMesh& mesh, Vector3d& middle) {
  PlanLuminaire luminaire;
  double area = 0.0;
  middle.setZero();
  for (const Facet& facet : mesh.facets) {
    std::vector<Vector2d>& outline = luminaire.outlines.emplace_back();
    Vector3d mean = Vector3d::Zero();
    for (const int v : facet.boundary) {
      const Vector3d& p = mesh.vertices[static_cast<std::size_t>(v)];
      mean += p / static_cast<double>(facet.boundary.size());
      outline.push_back(frame.flat(p));
    }
    const double here = facet_area(mesh, facet);
    middle += here * mean;
    area += here;
  }
  if (area > 0.0) middle /= area;
  luminaire.middle = frame.flat(middle);
  return luminaire;
}

// Luminaires and eyes between the grid and a little above what is over it: not those of another
// storey.
class OverTheGrid {
 public:
  OverTheGrid(const PlanFrame& frame, double free_height) : frame_(frame), top_(free_height) {}

  bool holds(const PlanLines& plan, const Vector3d& p, double below) const {
    constexpr double ceiling_void = 0.3;  // m
    const double height = frame_.height(p);
    return height > -below && height < top_ + ceiling_void && is_in(plan, frame_.flat(p));
  }

 private:
  const PlanFrame& frame_;
  double top_;
};

void add_luminaires(const Scene& scene, const PlanFrame& frame, const OverTheGrid& over,
                    PlanLines& plan) {
  for (const Lamp& lamp : scene.lamps) {
    if (over.holds(plan, lamp.position, 0.0)) plan.luminaires.push_back(luminaire_of(frame, lamp));
  }
  for (const Surface& surface : scene.surfaces) {
    if (!scene.materials[static_cast<std::size_t>(surface.material)].is_emitter()) continue;
    if (const auto* sphere = std::get_if<Sphere>(&surface.shape)) {
      if (!over.holds(plan, sphere->center, 0.0)) continue;
      const Vector2d middle = frame.flat(sphere->center);
      plan.luminaires.push_back(
          {.outlines = {circle_of(middle, sphere->radius)}, .middle = middle});
      continue;
    }
    Vector3d middle;
    const auto* frustum = std::get_if<Frustum>(&surface.shape);
    PlanLuminaire luminaire = luminaire_of(
        frame, frustum ? facets_of(*frustum) : std::get<PolygonMesh>(surface.shape), middle);
    if (over.holds(plan, middle, 0.0)) plan.luminaires.push_back(std::move(luminaire));
  }
}

void add_eyes(std::span<const Camera> eyes, const PlanFrame& frame, const OverTheGrid& over,
              PlanLines& plan) {
  int number = 0;
  for (const Camera& eye : eyes) {
    ++number;
    if (!over.holds(plan, eye.position, frame.grid.options.height)) continue;
    Vector2d direction(eye.direction.dot(frame.grid.u), eye.direction.dot(frame.grid.v));
    constexpr double upright = 0.1;
    direction = direction.norm() > upright ? Vector2d(direction.normalized()) : Vector2d::Zero();
    plan.eyes.push_back({frame.flat(eye.position), direction, number});
  }
}

}  // namespace

PlanLines plan_lines(const Scene& scene, const ElementCaster& caster, const LuxGrid& grid,
                     std::span<const Camera> eyes) {
  const PlanFrame frame(grid);
  PlanLines plan;
  set_area(grid, plan);
  constexpr double cut_of_plans = 1.2;  // m above the floor, through windows and doors
  const double above = free_height(caster, grid);
  plan.cut_height = std::min(cut_of_plans - grid.options.height, 0.5 * above);
  for_each_facet(scene, [&](const PolygonMesh& mesh, const Facet& facet, const Material& material) {
    cut_facet(frame, mesh, facet, material.dielectric.has_value(), plan);
  });
  cut_spheres(scene, frame, plan);
  add_seen(caster, frame, edges_below(scene, frame, plan), plan);
  const OverTheGrid over(frame, above);
  add_luminaires(scene, frame, over, plan);
  add_eyes(eyes, frame, over, plan);
  return plan;
}

}  // namespace lightwell
