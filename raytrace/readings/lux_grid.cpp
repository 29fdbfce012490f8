#include "raytrace/readings/lux_grid.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "mesh/patches/mesh_bounds.h"
#include "raytrace/readings/cylinder.h"
#include "raytrace/readings/grid_outline.h"
#include "scene/errors.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

using Edge = std::pair<int, int>;
using Line = std::pair<Eigen::Vector3d, Eigen::Vector3d>;
using Loop = std::vector<Eigen::Vector3d>;

/// Facets that lie in one plane.
struct MeshPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double area = 0.0;
  std::vector<const Facet*> facets{};
};

std::vector<MeshPlane> planes_of(const PolygonMesh& mesh, double size) {
  constexpr double same_direction = 1.0 - 1e-6;  // 0.08 degrees
  const double same_place = 1e-5 * size;
  std::vector<MeshPlane> planes;
  for (const Facet& facet : mesh.facets) {
    const Eigen::Vector3d normal = facet_normal(mesh, facet);
    const Eigen::Vector3d point = mesh.vertices[static_cast<std::size_t>(facet.boundary.front())];
    auto at = std::ranges::find_if(planes, [&](const MeshPlane& plane) {
      return plane.normal.dot(normal) > same_direction &&
             std::abs(plane.normal.dot(point - plane.point)) <= same_place;
    });
    if (at == planes.end()) at = planes.insert(at, {.normal = normal, .point = point});
    at->area += facet_area(mesh, facet);
    at->facets.push_back(&facet);
  }
  return planes;
}

/// Returns the edges of the outline, each of which belongs to one facet alone.
std::vector<Line> outline_of(const PolygonMesh& mesh, const MeshPlane& plane) {
  std::set<Edge> edges;
  const auto add = [&](const std::vector<int>& loop) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Edge edge{loop[i], loop[(i + 1) % loop.size()]};
      if (edges.erase({edge.second, edge.first}) == 0) edges.insert(edge);
    }
  };
  for (const Facet* facet : plane.facets) {
    add(facet->boundary);
    for (const std::vector<int>& hole : facet->holes) add(hole);
  }
  std::vector<Line> lines;
  const auto place = [&](int v) { return mesh.vertices[static_cast<std::size_t>(v)]; };
  for (const auto& [a, b] : edges) lines.emplace_back(place(a), place(b));
  return lines;
}

/// Returns the edges of closed lines, moved onto the plane.
std::vector<Line> lines_of(const std::vector<Loop>& loops, const MeshPlane& plane) {
  std::vector<Line> lines;
  const auto place = [&](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(p - plane.normal.dot(p - plane.point) * plane.normal);
  };
  for (const Loop& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Line line(place(loop[i]), place(loop[(i + 1) % loop.size()]));
      if (line.first != line.second) lines.push_back(line);
    }
  }
  return lines;
}

const MeshPlane& largest(const std::vector<MeshPlane>& planes, const Eigen::Vector3d& up) {
  constexpr double alike = 1e-6;
  const MeshPlane* best = &planes.front();
  for (const MeshPlane& plane : planes) {
    const bool is_as_large = std::abs(plane.area - best->area) <= alike * best->area;
    const bool faces_up = plane.normal.dot(up) > best->normal.dot(up) + alike;
    if (is_as_large ? faces_up : plane.area > best->area) best = &plane;
  }
  return *best;
}

}  // namespace

double greatest_grid_spacing(double length) {
  constexpr double most = 10.0;
  return std::min(most, 0.2 * std::pow(5.0, std::log10(length)));
}

namespace {

/// The plane that a grid covers, and its outline in the grid's coordinates from `plane.point`.
struct GridPlane {
  MeshPlane plane{};
  GridOutline outline{};
  Eigen::Vector2d low{}, high{};  ///< corners of the rectangle of the grid, margin left out
};

// Turns the axes of the plan of a wall, so that the plan stands upright.
void stand_upright(const Eigen::Vector3d& up, LuxGrid& grid) {
  constexpr double level = 0.1;  // sine of the slope of a plane that counts as level
  if (std::max(std::abs(grid.u.dot(up)), std::abs(grid.v.dot(up))) <= level) return;
  if (std::abs(grid.u.dot(up)) > std::abs(grid.v.dot(up))) {
    grid.u = std::exchange(grid.v, Eigen::Vector3d(grid.u));
    grid.u = -grid.u;
  }
  if (grid.v.dot(up) < 0.0) {
    grid.u = -grid.u;
    grid.v = -grid.v;
  }
}

// Sets the axes of a grid over the edges of an outline: u follows the longest edge.
void set_axes(const std::vector<Line>& edges, const MeshPlane& plane, const Eigen::Vector3d& up,
              LuxGrid& grid) {
  double longest = 0.0;
  for (const auto& [a, b] : edges) {
    const Eigen::Vector3d along = b - a;
    // The first of equally long edges is kept, in spite of rounding.
    if (along.norm() <= longest * (1.0 + 1e-9)) continue;
    longest = along.norm();
    grid.u = along.normalized();
  }
  grid.v = plane.normal.cross(grid.u);
  stand_upright(up, grid);
}

// A point in the axes of a grid, from `origin`.
Eigen::Vector2d flat_point(const LuxGrid& grid, const Eigen::Vector3d& origin,
                           const Eigen::Vector3d& p) {
  return {grid.u.dot(p - origin), grid.v.dot(p - origin)};
}

// Cuts the rectangle of the grid down to that of a box.
void keep_part(const Eigen::AlignedBox3d& part, const LuxGrid& grid, GridPlane& found) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector2d at = flat_point(
        grid, found.plane.point, part.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  found.low = found.low.cwiseMax(low);
  found.high = found.high.cwiseMin(high);
}

// Finds the plane and the rectangle of a grid over a surface, and sets its axes.
GridPlane plane_of_grid(const Scene& scene, const PolygonMesh& mesh, const Eigen::Vector3d& up,
                        LuxGrid& grid) {
  GridPlane found{.plane = largest(planes_of(mesh, scene_bounds(scene).diagonal()), up)};
  MeshPlane& plane = found.plane;
  const std::vector<Line> edges = grid.options.outline.empty()
                                      ? outline_of(mesh, plane)
                                      : lines_of(grid.options.outline, plane);
  if (grid.options.towards && plane.normal.dot(*grid.options.towards - plane.point) < 0.0) {
    plane.normal = -plane.normal;
  }
  set_axes(edges, plane, up, grid);
  found.low.setConstant(std::numeric_limits<double>::infinity());
  found.high = -found.low;
  const auto flat = [&](const Eigen::Vector3d& p) { return flat_point(grid, plane.point, p); };
  for (const auto& [a, b] : edges) {
    found.outline.edges.emplace_back(flat(a), flat(b));
    found.low = found.low.cwiseMin(flat(a));
    found.high = found.high.cwiseMax(flat(a));
  }
  found.low.array() += grid.options.margin;
  found.high.array() -= grid.options.margin;
  if (grid.options.part) keep_part(*grid.options.part, grid, found);
  if (!((found.high - found.low).minCoeff() > 0.0)) {
    throw InputError(fmt::format("nothing is left of surface '{}' within a margin of {:g} m{}",
                                 grid.name, grid.options.margin,
                                 grid.options.part ? " and the part that is asked for; check both"
                                                   : "; give a smaller one"));
  }
  return found;
}

// Divides the rectangle of a grid into cells.
void set_cells(const Eigen::Vector2d& size, LuxGrid& grid) {
  const double longer = size.maxCoeff(), shorter = size.minCoeff();
  const double step = grid.options.spacing > 0.0
                          ? grid.options.spacing
                          : greatest_grid_spacing(longer > 2.0 * shorter ? shorter : longer);
  grid.options.spacing = step;
  const auto count = [&](double length) {
    constexpr int most = 1000;
    const double cells = std::ceil(length / step * (1.0 - 1e-9));
    if (!(cells <= most)) {
      throw InputError(
          fmt::format("a spacing of {:g} m is too fine for surface '{}', which is {:.4g} m long: "
                      "a grid has at most {} points a side",
                      step, grid.name, longer, most));
    }
    return std::max(1, static_cast<int>(cells));
  };
  grid.columns = count(size.x());
  grid.rows = count(size.y());
  grid.step_u = size.x() / grid.columns;
  grid.step_v = size.y() / grid.rows;
}

}  // namespace

namespace {

// Area that a grid stands for, m^2.
double area_of(const LuxGrid& grid, const GridPlane& found) {
  if (grid.options.part) return (found.high - found.low).prod();
  if (grid.options.outline.empty()) return found.plane.area;
  std::vector<std::vector<Eigen::Vector2d>> loops;
  for (const Loop& loop : grid.options.outline) {
    auto& flat = loops.emplace_back();
    for (const Eigen::Vector3d& p : loop) flat.push_back(flat_point(grid, found.plane.point, p));
  }
  return area_within(loops);
}

}  // namespace

LuxGrid lux_grid(const Scene& scene, int surface, const Eigen::Vector3d& up,
                 const LuxGridOptions& options) {
  const Surface& named = scene.surfaces[static_cast<std::size_t>(surface)];
  const auto* mesh = std::get_if<PolygonMesh>(&named.shape);
  if (!mesh || mesh->facets.empty()) {
    throw InputError(fmt::format(
        "surface '{}' is round; over it there is no plane grid; name a plane surface", named.name));
  }
  LuxGrid grid{.name = named.name, .surface = surface, .options = options};
  const GridPlane found = plane_of_grid(scene, *mesh, up, grid);
  const auto& [plane, outline, low, high] = found;
  grid.area = area_of(grid, found);
  set_cells(high - low, grid);
  grid.corner = plane.point + low.x() * grid.u + low.y() * grid.v + options.height * plane.normal;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const Eigen::Vector2d at(grid.step_u * (column + 0.5), grid.step_v * (row + 0.5));
      if (!outline.holds(low + at, options.margin)) continue;
      grid.cell.push_back(row * grid.columns + column);
      grid.points.push_back(
          {.position = grid.corner + at.x() * grid.u + at.y() * grid.v, .normal = plane.normal});
    }
  }
  if (grid.points.empty()) {
    throw InputError(fmt::format(
        "no point of the grid lies on surface '{}'; give a smaller margin or spacing", named.name));
  }
  return grid;
}

namespace {

// Returns the grid with those of its points alone for which `stays` is true.
LuxGrid with_points(const LuxGrid& grid, const std::function<bool(const Probe&)>& stays) {
  LuxGrid some = grid;
  some.cell.clear();
  some.points.clear();
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    if (!stays(grid.points[i])) continue;
    some.cell.push_back(grid.cell[i]);
    some.points.push_back(grid.points[i]);
  }
  return some;
}

}  // namespace

LuxGrid without_points_over(const LuxGrid& other, LuxGrid grid) {
  GridOutline outline;
  for (const auto& [a, b] : lines_of(other.options.outline, {.normal = other.u.cross(other.v)})) {
    outline.edges.emplace_back(flat_point(other, other.corner, a),
                               flat_point(other, other.corner, b));
  }
  return with_points(grid, [&](const Probe& point) {
    if (!outline.edges.empty()) {
      return !outline.holds(flat_point(other, other.corner, point.position), 0.0);
    }
    const Eigen::Vector3d p = point.position - other.corner;
    const double u = p.dot(other.u), v = p.dot(other.v);
    return u < 0.0 || v < 0.0 || u > other.columns * other.step_u || v > other.rows * other.step_v;
  });
}

LuxGrid points_seen_from(const ElementCaster& caster, const LuxGrid& eyes, const LuxGrid& grid) {
  constexpr std::size_t most = 64;
  constexpr double before = 1.0 - 1e-4;  // rays end before the surface of the point
  const std::size_t count = std::min(most, eyes.points.size());
  std::vector<Ray> rays(count);
  std::vector<std::uint8_t> blocked(count);
  const LuxGrid seen = with_points(grid, [&](const Probe& point) {
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d& eye = eyes.points[i * eyes.points.size() / count].position;
      rays[i] = {.origin = eye, .direction = point.position - eye, .t_max = before};
    }
    caster.occluded(rays, blocked);
    return std::ranges::any_of(blocked, [](std::uint8_t is_blocked) { return is_blocked == 0; });
  });
  return seen.points.empty() ? grid : seen;
}

void measure_as(GridQuantity quantity, const Eigen::Vector3d& up, const Eigen::Vector3d& facing,
                LuxGrid& grid) {
  grid.quantity = quantity;
  grid.upright = up;
  if (quantity == GridQuantity::planar || quantity == GridQuantity::cylindrical) return;
  const Eigen::Vector3d level = facing - facing.dot(up) * up;
  constexpr double upright = 1e-3;  // sine of the least slope that still says where to look
  if (!(level.norm() > upright)) {
    throw InputError(fmt::format(
        "grid '{}' measures upright planes, and faces straight up or down; give 'facing' a level "
        "direction, such as [1, 0, 0]",
        grid.name));
  }
  grid.facing = level.normalized();
  if (quantity != GridQuantity::vertical) return;
  for (Probe& point : grid.points) point.normal = grid.facing;
}

LuxGrid without_buried_points(const ElementCaster& caster, LuxGrid grid) {
  constexpr int ray_count = 64;
  const SobolPoints sobol(ray_count);
  // Rounding decides on which side of a face a point in its plane lies, so points beside it are
  // tested too. Light inside a body is not light of the plane.
  constexpr double beside = 1e-5;  // share of the scenery's diagonal
  const double aside = beside * scenery_bounds(caster.mesh()).diagonal();
  const auto is_inside = [&](const Eigen::Vector3d& position, const Eigen::Vector3d& normal) {
    Eigen::Vector3d a, b;
    tangent_frame(normal, a, b);
    std::array<Ray, ray_count> rays;
    std::array<ElementHit, ray_count> hits;
    for (int i = 0; i < ray_count; ++i) {
      const Eigen::Array4f u = sobol.point(i, 0);
      const Eigen::Vector3d d = cosine_direction(u[0], u[1]);
      rays[static_cast<std::size_t>(i)] = {.origin = position,
                                           .direction = d.x() * a + d.y() * b + d.z() * normal};
    }
    caster.closest_hits(rays, hits);
    return std::ranges::all_of(
        hits, [](const ElementHit& hit) { return hit.facet >= 0 && hit.from_back; });
  };
  const auto is_buried = [&](const Probe& point) {
    // Rays from within a surface would meet the surface itself.
    const Eigen::Vector3d above = point.position + aside * point.normal;
    const std::array<Eigen::Vector3d, 5> places = {above, above + aside * grid.u,
                                                   above - aside * grid.u, above + aside * grid.v,
                                                   above - aside * grid.v};
    return std::ranges::any_of(
        places, [&](const Eigen::Vector3d& place) { return is_inside(place, point.normal); });
  };
  LuxGrid open = with_points(grid, [&](const Probe& point) { return !is_buried(point); });
  return open.points.empty() ? grid : open;
}

namespace {

// Sets the mean, the extremes and the uniformity of a field from its points.
void summarise(LuxField& field) {
  field.mean = field.lux.mean();
  field.least = field.lux.minCoeff();
  field.greatest = field.lux.maxCoeff();
  field.uniformity = field.mean > 0.0 ? field.least / field.mean : 0.0;
}

// Root mean square of the relative bounds of points. In near darkness the relative error would
// reach 100 %, so 0.1 of the mean is the least divisor.
double relative_bound(const LuxField& field) {
  const Eigen::ArrayXd within = field.lux_within.isNaN().select(0.0, field.lux_within);
  return std::sqrt((within / field.lux.max(0.1 * field.mean)).square().mean());
}

}  // namespace

LuxField field_of(const Eigen::ArrayXd& lux) {
  LuxField field{
      .lux = lux,
      .lux_within = Eigen::ArrayXd::Constant(lux.size(), std::numeric_limits<double>::quiet_NaN())};
  summarise(field);
  return field;
}

double bound_at(const LuxField& field, double lux) {
  Eigen::Index at = 0;
  (field.lux - lux).abs().minCoeff(&at);
  return field.lux_within[at];
}

LuxField sum_of(const LuxField& a, const LuxField& b) {
  // No bound is known where there is no light; then the bound is that of the other part.
  const auto bound = [](const LuxField& part) {
    return (part.lux == 0.0).select(0.0, part.lux_within).eval();
  };
  LuxField sum{.lux = a.lux + b.lux, .lux_within = bound(a) + bound(b)};
  sum.lux_within =
      (sum.lux == 0.0).select(std::numeric_limits<double>::quiet_NaN(), sum.lux_within);
  summarise(sum);
  if (!(sum.mean > 0.0)) return sum;
  sum.point_within = relative_bound(sum);
  sum.mean_within = (a.mean_within * a.mean + b.mean_within * b.mean) / sum.mean;
  return sum;
}

LuxField measure_grid(const Scene& scene, const ElementCaster& caster,
                      const DirectLight& direct_light, const RadiositySolution& solution,
                      const LuxGrid& grid, double factor, const GatherOptions& options) {
  const auto count = static_cast<Eigen::Index>(grid.points.size());
  const LuxReadings read = read_grid({scene, caster, direct_light}, solution, grid, options);
  LuxField field{.lux = factor * read.lux, .lux_within = factor * read.lux_within};
  summarise(field);
  if (!(field.mean > 0.0)) return field;
  field.point_within = relative_bound(field);
  const Eigen::ArrayXd within = field.lux_within.isNaN().select(0.0, field.lux_within);
  const Eigen::ArrayXd shared = factor * read.read_within;
  const double noise = (within.square() - shared.square()).max(0.0).sum();
  field.mean_within =
      std::hypot(std::sqrt(noise) / static_cast<double>(count), shared.mean()) / field.mean;
  return field;
}

}  // namespace lightwell
