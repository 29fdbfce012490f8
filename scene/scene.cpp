#include "scene/scene.h"

#include <Eigen/Geometry>
#include <stdexcept>
#include "scene/round_shape.h"

namespace lightwell {
namespace {

Eigen::Vector3d loop_area_vector(const PolygonMesh& mesh, const std::vector<int>& loop) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const Eigen::Vector3d& origin = mesh.vertices[loop.front()];  // relative: keeps digits far from 0
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Eigen::Vector3d a = mesh.vertices[loop[i]] - origin;
    const Eigen::Vector3d b = mesh.vertices[loop[(i + 1) % loop.size()]] - origin;
    sum += a.cross(b);
  }
  return 0.5 * sum;
}

Eigen::Vector3d facet_area_vector(const PolygonMesh& mesh, const Facet& facet) {
  Eigen::Vector3d sum = loop_area_vector(mesh, facet.boundary);
  for (const auto& hole : facet.holes) sum += loop_area_vector(mesh, hole);
  return sum;
}

}  // namespace

int free_source_count(const Scene& scene) {
  const int of_sky = scene.sky ? (has_dome(*scene.sky) ? 1 : 0) + (scene.sky->sun ? 1 : 0) : 0;
  return static_cast<int>(scene.lamps.size()) + of_sky;
}

std::string free_source_name(const Scene& scene, int number) {
  const auto n = static_cast<std::size_t>(number);
  if (n < scene.lamps.size()) return scene.lamps[n].name;
  const bool is_dome = n == scene.lamps.size() && scene.sky && has_dome(*scene.sky);
  return is_dome ? "sky" : "sun";
}

bool gives_light(const Scene& scene) {
  for (const Surface& surface : scene.surfaces) {
    if (scene.materials[static_cast<std::size_t>(surface.material)].is_emitter()) return true;
  }
  for (const Lamp& lamp : scene.lamps) {
    if ((lamp.intensity > 0.0f).any() && relative_flux(lamp) > 0.0) return true;
  }
  return scene.sky &&
         (has_dome(*scene.sky) || (scene.sky->sun && (scene.sky->sun->irradiance > 0.0f).any()));
}

std::vector<FacetRef> scene_facets(const Scene& scene) {
  std::vector<FacetRef> facets;
  for (int s = 0; s < static_cast<int>(scene.surfaces.size()); ++s) {
    const auto* mesh = std::get_if<PolygonMesh>(&scene.surfaces[s].shape);
    const int count = mesh ? static_cast<int>(mesh->facets.size()) : 1;
    for (int f = 0; f < count; ++f) facets.push_back({.surface = s, .facet = f});
  }
  return facets;
}

Eigen::Vector3d facet_normal(const PolygonMesh& mesh, const Facet& facet) {
  const Eigen::Vector3d n = facet_area_vector(mesh, facet);
  const double length = n.norm();
  return length > 0.0 ? Eigen::Vector3d(n / length) : Eigen::Vector3d::Zero();
}

double facet_area(const PolygonMesh& mesh, const Facet& facet) {
  return facet_area_vector(mesh, facet).norm();
}

double surface_area(const Surface& surface) {
  if (const auto round = round_shape(surface)) return area(*round);
  const auto& mesh = std::get<PolygonMesh>(surface.shape);
  double area = 0.0;
  for (const Facet& facet : mesh.facets) area += facet_area(mesh, facet);
  return area;
}

Bounds scene_bounds(const Scene& scene) {
  Eigen::AlignedBox3d box;
  for (const Surface& surface : scene.surfaces) {
    if (const auto* mesh = std::get_if<PolygonMesh>(&surface.shape)) {
      for (const auto& v : mesh->vertices) box.extend(v);
    } else {
      box.extend(bounds(*round_shape(surface)));
    }
  }
  if (box.isEmpty()) throw std::invalid_argument("the scene has no surfaces");
  return {box.min(), box.max()};
}

}  // namespace lightwell
