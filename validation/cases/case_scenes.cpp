#include "validation/cases/case_scenes.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "mesh/build_patches.h"
#include "raytrace/readings/probe_surface.h"

namespace lightwell {

int add_paint(Scene& scene, const GreyPaint& paint) {
  const Bands& bands = scene.bands;
  scene.materials.push_back({.name = "paint " + std::to_string(scene.materials.size()),
                             .reflectance = constant_spectrum(bands, paint.reflectance),
                             .specular = constant_spectrum(bands, 0.0f),
                             .emission = constant_spectrum(bands, paint.exitance)});
  return static_cast<int>(scene.materials.size()) - 1;
}

void add_case_polygon(Scene& scene, const std::string& name, int material,
                      const std::vector<Eigen::Vector3d>& points) {
  PolygonMesh mesh{.vertices = points, .facets = {Facet{}}};
  for (int i = 0; i < static_cast<int>(points.size()); ++i) mesh.facets[0].boundary.push_back(i);
  scene.surfaces.push_back({.name = name, .material = material, .shape = std::move(mesh)});
}

void add_holed_polygon(Scene& scene, const std::string& name, int material,
                       const std::vector<Eigen::Vector3d>& points,
                       const std::vector<Eigen::Vector3d>& hole) {
  add_case_polygon(scene, name, material, points);
  auto& mesh = std::get<PolygonMesh>(scene.surfaces.back().shape);
  std::vector<int> loop;
  for (auto point = hole.rbegin(); point != hole.rend(); ++point) {
    loop.push_back(static_cast<int>(mesh.vertices.size()));
    mesh.vertices.push_back(*point);
  }
  mesh.facets[0].holes = {loop};
}

std::vector<Eigen::Vector3d> box_face(const CaseBox& box, int face) {
  const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
  const bool is_high = face % 2 == 1;
  std::vector<Eigen::Vector3d> points;
  for (const auto& [at_u, at_v] :
       {std::pair{false, false}, {true, false}, {true, true}, {false, true}}) {
    Eigen::Vector3d point;
    point[axis] = is_high ? box.high[axis] : box.low[axis];
    point[u] = at_u ? box.high[u] : box.low[u];
    point[v] = at_v ? box.high[v] : box.low[v];
    points.push_back(point);
  }
  // The loop above runs counter-clockwise about the axis.
  if (is_high == box.inwards) std::reverse(points.begin(), points.end());
  return points;
}

void add_case_box(Scene& scene, const CaseBox& box) {
  for (int face = 0; face < 6; ++face) {
    const auto f = static_cast<std::size_t>(face);
    add_case_polygon(scene, box_face_names[f], box.materials[f], box_face(box, face));
  }
}

int box_face_number(const std::string& name) {
  const auto* const found = std::find(box_face_names.begin(), box_face_names.end(), name);
  if (found == box_face_names.end()) throw std::invalid_argument("no face is named " + name);
  return static_cast<int>(found - box_face_names.begin());
}

LitCase::LitCase(Scene built, double max_patch_size)
    : scene(std::move(built)),
      mesh(build_patches(scene, {.max_patch_size = max_patch_size, .auto_patch_count = 200})),
      caster(mesh),
      direct_light(scene, mesh) {}

double LitCase::direct(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                       double sky_error) const {
  constexpr int rays = 1024, sky_rays = 8192;
  const Probe probe{.position = point, .normal = normal};
  const GatherPoint at = probe_points(caster, {&probe, 1}).front();
  const LightQuery query{.at = {at.position, at.normal, at.facet},
                         .key = 1,
                         .shadows = {.min_rays = rays, .max_rays = rays, .sky_rays = sky_rays},
                         .sky_noise = {.share = sky_error}};
  return static_cast<double>(direct_light.irradiance(caster, query)[0]);
}

}  // namespace lightwell
