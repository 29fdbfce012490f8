#include "viewer/report/requested_grids.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <variant>

#include "scene/errors.h"
#include "scene/io/matches_glob.h"
#include "scene/io/nearest_name.h"
#include "scene/io/polygon.h"
#include "scene/name_in_messages.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// The middle of a facet's first ear, a point that lies on the facet also if that is an L.
Eigen::Vector3d point_on(const PolygonMesh& mesh, const Facet& facet) {
  Loop loop;
  for (const int v : facet.boundary) loop.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
  const auto triangles = split_into_triangles(loop);
  const std::array<int, 3> corners = triangles.empty() ? std::array<int, 3>{0, 1, 2} : triangles[0];
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const int corner : corners) middle += loop[static_cast<std::size_t>(corner)] / 3.0;
  return middle;
}

// Share of the cosine-distributed rays from a level surface, in the hemisphere about `axis`, that
// meet a surface, but none before they have risen by `height`.
double enclosed_share(const ElementCaster& caster, const PolygonMesh& mesh,
                      const Eigen::Vector3d& axis, double height, double offset) {
  // Shares that differ by a quarter are told apart by a standard error of 1/16 at most.
  constexpr int ray_count = 64;
  constexpr std::size_t most_facets = 8;  // of a floor of many tiles
  const SobolPoints sobol(ray_count);
  Eigen::Vector3d first, second;
  tangent_frame(axis, first, second);
  std::vector<Ray> rays;
  const std::size_t step = 1 + (mesh.facets.size() - 1) / most_facets;
  for (std::size_t f = 0; f < mesh.facets.size(); f += step) {
    const Eigen::Vector3d from = point_on(mesh, mesh.facets[f]) + offset * axis;
    for (int i = 0; i < ray_count; ++i) {
      const Eigen::Array4f u = sobol.point(i, f);
      const Eigen::Vector3d d = cosine_direction(u[0], u[1]);
      rays.push_back({.origin = from, .direction = d.x() * first + d.y() * second + d.z() * axis});
    }
  }
  std::vector<ElementHit> hits(rays.size());
  caster.closest_hits(rays, hits);
  std::size_t met = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].facet >= 0 && hits[i].t * rays[i].direction.dot(axis) > height) ++met;
  }
  return static_cast<double>(met) / static_cast<double>(rays.size());
}

// A point that grids of a level surface face, where its front faces down: many files have floors
// whose fronts face out of the rooms. Empty for other surfaces, and for ceilings, below which far
// more is around than above: their grids lie before their fronts. What is nearer than the grid is
// high, as a slab under the paving of a court, makes no ceiling.
std::optional<Eigen::Vector3d> above(const Scene& scene, const ElementCaster& caster, int surface,
                                     double height, const Eigen::Vector3d& up) {
  const Surface& of = scene.surfaces[static_cast<std::size_t>(surface)];
  const auto* mesh = std::get_if<PolygonMesh>(&of.shape);
  const Material& material = scene.materials[static_cast<std::size_t>(of.material)];
  if (!mesh || mesh->facets.empty() || material.one_sided) return std::nullopt;
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  for (const Facet& facet : mesh->facets) {
    area += facet_area(*mesh, facet) * facet_normal(*mesh, facet);
  }
  constexpr double level = 0.9;  // cosine of the steepest ramp that counts as level, 26 degrees
  if (!(area.dot(up) < -level * area.norm())) return std::nullopt;
  const Bounds bounds = scene_bounds(scene);
  // Rays begin far above the rounding of coordinates, and far below the height of furniture.
  // Windows and rooflights take less than a quarter of what is around a room's floor.
  constexpr double share_of_scene = 1e-5, far_more = 0.25, least_height = 0.1;  // m
  const double offset = share_of_scene * bounds.diagonal();
  const double clear = std::max(height, least_height);
  if (enclosed_share(caster, *mesh, -up, clear, offset) >
      enclosed_share(caster, *mesh, up, clear, offset) + far_more) {
    return std::nullopt;
  }
  return bounds.high + 2.0 * bounds.diagonal() * up;
}

// The grids over the surfaces of a name.
void add_grids(const Scene& scene, const ElementCaster& caster, const std::string& name,
               const Eigen::Vector3d& up, LuxGridOptions options, std::vector<LuxGrid>& grids) {
  for (const int surface : surfaces_named(scene, name)) {
    options.towards = above(scene, caster, surface, options.height, up);
    grids.push_back(lux_grid(scene, surface, up, options));
  }
}

}  // namespace

std::vector<int> surfaces_named(const Scene& scene, const std::string& name) {
  std::vector<int> fitting;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    const Surface& surface = scene.surfaces[i];
    if (surface.name == name) return {static_cast<int>(i)};
    const std::string& material = scene.materials[static_cast<std::size_t>(surface.material)].name;
    if (matches_glob(name, surface.name) || matches_glob(name, material)) {
      fitting.push_back(static_cast<int>(i));
    }
    names.push_back(surface.name);
  }
  if (!fitting.empty()) return fitting;
  const std::string list =
      scene.file.empty()
          ? ""
          : fmt::format(" 'lightwell info {} --surfaces' lists all.", scene.file.string());
  throw InputError(fmt::format("{}: there is no surface '{}'.{}{}", name_in_messages(scene), name,
                               did_you_mean(name, names), list));
}

void require_surfaces(const GridRequest& asked, const Scene& scene) {
  for (const std::string& name : asked.surfaces) surfaces_named(scene, name);
  for (const NamedNumber& plane : asked.planes) surfaces_named(scene, plane.name);
}

std::vector<LuxGrid> requested_grids(const GridRequest& asked,
                                     std::span<const CalculationGrid> of_file, const Scene& scene,
                                     const ElementCaster& caster, const Eigen::Vector3d& up) {
  std::vector<LuxGrid> grids;
  const double spacing = asked.spacing;
  constexpr double strip = 0.5;  // m
  const double margin = asked.margin.value_or(strip);
  for (const CalculationGrid& grid : of_file) {
    const double usual = grid.height > 0.0 ? margin : 0.0;
    LuxGrid made = lux_grid(scene, grid.surface, up,
                            {.height = grid.height,
                             .margin = grid.margin.value_or(usual),
                             .spacing = grid.spacing > 0.0 ? grid.spacing : spacing,
                             .part = grid.part,
                             .outline = grid.outline,
                             .towards = above(scene, caster, grid.surface, grid.height, up)});
    made.name = grid.name;
    for (const int other : grid.leaves_out) {
      made = without_points_over(grids[static_cast<std::size_t>(other)], std::move(made));
    }
    if (made.points.empty()) {
      throw InputError(fmt::format(
          "{}: grid '{}' has no points beside those of the grids that it leaves out; give it a "
          "larger part, or a smaller spacing",
          scene.file.string(), grid.name));
    }
    measure_as(grid.quantity, up, grid.facing, made);
    grids.push_back(std::move(made));
  }
  for (const std::string& name : asked.surfaces) {
    add_grids(scene, caster, name, up, {.spacing = spacing}, grids);
  }
  for (const NamedNumber& plane : asked.planes) {
    const std::size_t first = grids.size();
    add_grids(scene, caster, plane.name, up,
              {.height = plane.value, .margin = margin, .spacing = spacing}, grids);
    for (std::size_t g = first; g < grids.size(); ++g) {
      const Surface& surface = scene.surfaces[static_cast<std::size_t>(grids[g].surface)];
      grids[g].name = fmt::format("{} + {:g} {}", surface.name, plane.value / scene.metres_per_unit,
                                  scene.unit_name);
    }
  }
  return grids;
}

}  // namespace lightwell
