#include "cli/look_from.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/arguments.h"
#include "cli/outputs.h"
#include "cli/quoted.h"
#include "raytrace/cameras/camera_ray.h"
#include "raytrace/readings/probe.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

void add_camera(const Camera& camera, std::vector<Ray>& rays) {
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

// Rays over the hemisphere of a place, as a gather there casts them, and one to the surface that
// the place may lie on.
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

bool is_file_of_places(const std::string& name) {
  return name.ends_with(".csv") || name.ends_with(".CSV");
}

}  // namespace

void LookFromArguments::add_to(CLI::App& command, const std::string& group) {
  command
      .add_option("--look-from", names,
                  "spend effort on what these see: cameras, .csv files of places (x,y,z,nx,ny,nz), "
                  "or everywhere; the error is estimated there")
      ->type_name("NAME")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->check([](const std::string& name) {
        return name.empty() ? "name a camera, a .csv file of places, or everywhere" : "";
      })
      ->group(group);
}

std::vector<Ray> LookFromArguments::rays(const Scene& scene) const {
  std::vector<Ray> rays;
  if (std::ranges::count(names, everywhere) > 0) return rays;
  for (const std::string& name : names) {
    if (!is_file_of_places(name)) {
      add_camera(choose_camera(scene, name), rays);
      continue;
    }
    note_input(name);
    const double diagonal = scene_bounds(scene).diagonal();
    std::uint64_t key = 0;
    for (const Probe& place : read_probes(name, scene.metres_per_unit)) {
      add_place(place, diagonal, key++, rays);
    }
  }
  return rays;
}

std::string LookFromArguments::text() const {
  std::string text;
  for (const std::string& name : names) text += " --look-from " + quoted(name);
  return text;
}

}  // namespace lightwell
