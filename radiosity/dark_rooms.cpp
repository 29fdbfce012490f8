#include "radiosity/dark_rooms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "mesh/patches/patch_sampler.h"
#include "mesh/patches/translucency.h"
#include "scene/parallel.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr int rays_of_a_side = 32;

bool is_dark(const PatchMesh& mesh, const BandArray& irradiance, int element) {
  for (int c = 0; c < mesh.corner_count(element); ++c) {
    if ((irradiance.row(mesh.corners[element][c]) > 0.0f).any()) return false;
  }
  return true;
}

// Returns whether a place is at least `width` wide in every direction of the plane of a and b.
bool is_wide(const ElementCaster& caster, const Eigen::Vector3d& place, const Eigen::Vector3d& a,
             const Eigen::Vector3d& b, double width) {
  constexpr int axes = 4;
  for (int i = 0; i < axes; ++i) {
    const double angle = i * std::numbers::pi / axes;
    const Eigen::Vector3d along = std::cos(angle) * a + std::sin(angle) * b;
    const std::array<Ray, 2> rays = {Ray{.origin = place, .direction = along},
                                     Ray{.origin = place, .direction = -along}};
    std::array<ElementHit, 2> hits;
    caster.closest_elements(rays, hits);
    const bool ends = hits[0].facet >= 0 && hits[1].facet >= 0;
    if (ends && hits[0].t + hits[1].t < width) return false;
  }
  return true;
}

// `view` are cosine-distributed directions about +z.
bool faces_a_room(const ElementCaster& caster, int element, double clearance,
                  const std::array<Eigen::Vector3d, rays_of_a_side>& view) {
  const PatchMesh& mesh = caster.mesh();
  const bool is_back = mesh.is_back[mesh.patch[element]] != 0;
  const int front = is_back && mesh.twin[element] >= 0 ? mesh.twin[element] : element;
  if (caster.is_hidden(front, is_back)) return false;
  const PatchPoint at = element_center(mesh, element);
  const int facet = mesh.facet[element];
  const Ray ahead{.origin = at.position,
                  .direction = clearance * at.normal,
                  .t_max = 1.0,
                  .origin_group = facet};
  std::uint8_t blocked = 0;
  caster.occluded({&ahead, 1}, {&blocked, 1});
  if (blocked != 0) return false;
  Eigen::Vector3d a, b;
  tangent_frame(at.normal, a, b);
  std::array<Ray, rays_of_a_side> ray;
  std::array<ElementHit, rays_of_a_side> hit;
  for (std::size_t i = 0; i < view.size(); ++i) {
    ray[i] = {.origin = at.position,
              .direction = view[i].x() * a + view[i].y() * b + view[i].z() * at.normal,
              .origin_group = facet};
  }
  caster.closest_elements(ray, hit);
  constexpr double touching = 1e-3, least_shown = 0.75;  // nearer surfaces lie on the element
  const auto shown = std::ranges::count_if(
      hit, [&](const ElementHit& h) { return h.element >= 0 && h.t > touching * clearance; });
  return static_cast<double>(shown) >= least_shown * rays_of_a_side &&
         is_wide(caster, at.position + 0.5 * clearance * at.normal, a, b, 0.5 * clearance);
}

}  // namespace

DarkRooms find_dark_rooms(const Scene& scene, const PatchMesh& mesh,
                          const RadiositySolution& solution) {
  const BandArray E = solution.irradiance();
  double all = 0.0;
  std::vector<int> dark;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int p = mesh.patch[e];
    if (!scatters(mesh, p)) continue;
    if (!mesh.is_back[p]) all += mesh.element_area[e];
    if (is_dark(mesh, E, e)) dark.push_back(e);
  }
  if (dark.empty()) return {};
  const ElementCaster caster(mesh);
  constexpr double headroom = 1.2;  // m
  const double clearance = std::min(headroom, 0.25 * scene_bounds(scene).diagonal());
  std::array<Eigen::Vector3d, rays_of_a_side> view;
  const SobolPoints sobol(rays_of_a_side);
  for (int i = 0; i < rays_of_a_side; ++i) {
    const Eigen::Array4f u = sobol.point(i, 0);
    view[static_cast<std::size_t>(i)] = cosine_direction(u[0], u[1]);
  }
  constexpr std::size_t most = 4096;
  const std::size_t step = dark.size() / most + 1;
  const int looked_at = static_cast<int>((dark.size() + step - 1) / step);
  std::vector<char> counts(static_cast<std::size_t>(looked_at), 0);
  parallel_for(looked_at, 16, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const int e = dark[static_cast<std::size_t>(i) * step];
      counts[static_cast<std::size_t>(i)] = faces_a_room(caster, e, clearance, view) ? 1 : 0;
    }
  });
  std::vector<double> of_surface(scene.surfaces.size(), 0.0);
  double sampled = 0.0, every = 0.0;
  for (const int e : dark) every += mesh.element_area[e];
  for (int i = 0; i < looked_at; ++i) {
    const int e = dark[static_cast<std::size_t>(i) * step];
    sampled += mesh.element_area[e];
    if (counts[static_cast<std::size_t>(i)] == 0) continue;
    of_surface[static_cast<std::size_t>(mesh.surface[mesh.patch[e]])] += mesh.element_area[e];
  }
  const double area = std::accumulate(of_surface.begin(), of_surface.end(), 0.0);
  if (!(area > 0.0)) return {};
  const auto largest = std::ranges::max_element(of_surface);
  return {.area = area * every / sampled,
          .share = all > 0.0 ? area * every / sampled / all : 0.0,
          .surface = static_cast<int>(largest - of_surface.begin())};
}

}  // namespace lightwell
