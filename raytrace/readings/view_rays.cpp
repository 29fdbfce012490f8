#include "raytrace/readings/view_rays.h"

#include "raytrace/cameras/camera_ray.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

void add_place(const Probe& place, double diagonal, std::uint64_t key, std::vector<Ray>& rays) {
  constexpr int count = 64;
  const double height = 1e-4 * diagonal;
  const Eigen::Vector3d above = place.position + height * place.normal;
  rays.push_back({.origin = above, .direction = -place.normal, .t_max = 2.0 * height});
  Eigen::Vector3d a, b;
  tangent_frame(place.normal, a, b);
  const SobolPoints sobol(count);
  for (int i = 0; i < count; ++i) {
    const Eigen::Array4f u = sobol.point(i, key);
    const Eigen::Vector3d d = cosine_direction(u[0], u[1]);
    rays.push_back({.origin = above, .direction = d.x() * a + d.y() * b + d.z() * place.normal});
  }
}

}  // namespace

void add_view_rays(const Camera& camera, std::vector<Ray>& rays) {
  constexpr int count = 1 << 14;
  const CameraRays of_camera(camera);
  const SobolPoints sobol(count);
  for (int i = 0; i < count; ++i) {
    const Eigen::Array4d u = sobol.point(i, 0).cast<double>();
    const double x = u[0] * camera.width, y = u[1] * camera.height;
    const auto ray = of_camera.ray_at(x, y, u[2], u[3], of_camera.panel_at(x, y));
    if (ray) rays.push_back(*ray);
  }
}

void add_view_rays(std::span<const Probe> places, double diagonal, std::vector<Ray>& rays) {
  std::uint64_t key = 0;
  for (const Probe& place : places) add_place(place, diagonal, key++, rays);
}

}  // namespace lightwell
