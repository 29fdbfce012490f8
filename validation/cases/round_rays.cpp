#include "validation/cases/round_rays.h"

#include <cmath>
#include <numeric>

#include "mesh/patches/patch_sampler.h"
#include "scene/parallel.h"
#include "scene/sampling.h"
#include "validation/cases/case_scenes.h"

namespace lightwell {
namespace {

constexpr int rays_per_patch = 1 << 17;

const SobolPoints& sobol_points() {
  static const SobolPoints points(rays_per_patch);
  return points;
}

Scene scene_of_shapes(const std::vector<RoundShape>& shapes) {
  Scene scene;
  const int paint = add_paint(scene, {.reflectance = 0.5f});
  for (const RoundShape& shape : shapes) {
    scene.surfaces.push_back({.name = "shape", .material = paint});
    set_shape(scene.surfaces.back(), shape);
  }
  return scene;
}

// Share of the rays that `start` makes of four numbers in [0,1).
double share_of(const LitCase& lit, const RayEnd& counts, std::uint64_t key,
                const std::function<Ray(const Eigen::Array4f& u)>& start) {
  std::vector<int> met(rays_per_patch, 0);
  parallel_for(rays_per_patch, 1024, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const Ray ray = start(sobol_points().point(i, key));
      ElementHit hit;
      lit.caster.closest_elements({&ray, 1}, {&hit, 1});
      const Eigen::Vector3d place = ray.origin + (hit.facet >= 0 ? hit.t : 0.0) * ray.direction;
      met[static_cast<std::size_t>(i)] = counts(hit.facet, place) ? 1 : 0;
    }
  });
  return std::accumulate(met.begin(), met.end(), 0) / static_cast<double>(rays_per_patch);
}

}  // namespace

double round_form_factor(const RoundRays& rays, const Progress& progress) {
  constexpr double patches = 10.0;  // on a side, about
  const LitCase lit(scene_of_shapes(rays.shapes), std::sqrt(area(rays.shapes[0]) / patches));
  double met = 0.0, sent = 0.0;
  for (int p = 0; p < lit.mesh.patch_count(); ++p) {
    if (lit.mesh.surface[p] != 0 || (lit.mesh.is_back[p] != 0) != rays.from_back) continue;
    report(progress, "rays", 0.0);
    const PatchSampler sampler(lit.mesh, p);
    met += lit.mesh.area[p] *
           share_of(lit, rays.counts, static_cast<std::uint64_t>(p), [&](const Eigen::Array4f& u) {
             return cosine_ray(lit.mesh, sampler.point(u[0], u[1]), u[2], u[3]);
           });
    sent += lit.mesh.area[p];
  }
  return met / sent;
}

double element_form_factor(const RoundRays& rays, const SurfacePoint& element) {
  const LitCase lit(scene_of_shapes(rays.shapes));
  Eigen::Vector3d a, b;
  tangent_frame(element.normal, a, b);
  return share_of(lit, rays.counts, 1, [&](const Eigen::Array4f& u) {
    const Eigen::Vector3d d = cosine_direction(u[0], u[1]);
    return Ray{.origin = element.position,
               .direction = d.x() * a + d.y() * b + d.z() * element.normal};
  });
}

}  // namespace lightwell
