#include "radiosity/radiation/point_exposure.h"

#include <algorithm>
#include <array>
#include <map>

#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr int rays_of_a_point = 16384;
constexpr std::size_t point_ray_batch = 64;

// Numbers of rays of a point by where they end.
struct RayEnds {
  int at_sky = 0;
  std::map<int, int> at_row{};
};

void count_ends(const FacetViewFactors& found, const Eigen::Vector3d& up, std::span<const Ray> rays,
                std::span<const ElementHit> hits, RayEnds& ends) {
  for (std::size_t r = 0; r < hits.size(); ++r) {
    const ElementHit& hit = hits[r];
    if (hit.facet < 0 && rays[r].direction.dot(up) > 0.0) ++ends.at_sky;
    if (hit.element < 0) continue;
    const int patch = found.mesh.patch[static_cast<std::size_t>(hit.element)];
    const int row = found.rows.of_patch[static_cast<std::size_t>(patch)];
    if (row >= 0) ++ends.at_row[row];
  }
}

RayEnds ray_ends(const FacetViewFactors& found, const ElementCaster& caster,
                 const SobolPoints& sobol, const SurfacePoint& point, std::uint64_t key,
                 const Eigen::Vector3d& up) {
  Eigen::Vector3d a, b;
  tangent_frame(point.normal, a, b);
  std::array<Ray, point_ray_batch> rays;
  std::array<ElementHit, point_ray_batch> hits;
  RayEnds ends;
  for (int first = 0; first < rays_of_a_point; first += static_cast<int>(point_ray_batch)) {
    for (std::size_t r = 0; r < point_ray_batch; ++r) {
      const Eigen::Array4f u = sobol.point(first + static_cast<int>(r), key);
      const Eigen::Vector3d d = cosine_direction(u[0], u[1]);
      rays[r] = {.origin = point.position,
                 .direction = d.x() * a + d.y() * b + d.z() * point.normal,
                 .origin_group = point.facet};
    }
    caster.closest_elements(rays, hits);
    count_ends(found, up, rays, hits, ends);
  }
  return ends;
}

}  // namespace

PointViews point_views(const FacetViewFactors& found, const ElementCaster& caster,
                       std::span<const SurfacePoint> points, const Eigen::Vector3d& up,
                       const Progress& progress) {
  const SobolPoints sobol(rays_of_a_point);
  const int count = static_cast<int>(points.size());
  PointViews views{.sky = Eigen::ArrayXd::Zero(count)};
  views.rows.resize(points.size());
  constexpr int block = 64;  // points between two reports
  for (int first = 0; first < count; first += block) {
    report(progress, "points", static_cast<double>(first) / count);
    parallel_for(std::min(block, count - first), 1, [&](int begin, int end) {
      for (int p = first + begin; p < first + end; ++p) {
        const auto i = static_cast<std::size_t>(p);
        const std::uint64_t key = random_key(i, RandomPurpose::sky_point_rays);
        const RayEnds ends = ray_ends(found, caster, sobol, points[i], key, up);
        views.sky[p] = double(ends.at_sky) / rays_of_a_point;
        for (const auto& [row, rays] : ends.at_row) {
          views.rows[i].push_back({row, static_cast<float>(rays) / rays_of_a_point});
        }
      }
    });
  }
  return views;
}

Eigen::ArrayXd point_sun_factors(const ElementCaster& caster, std::span<const SurfacePoint> points,
                                 const Eigen::Vector3d& sun) {
  Eigen::ArrayXd factors(static_cast<Eigen::Index>(points.size()));
  constexpr int grain = 256;
  parallel_for(static_cast<int>(points.size()), grain, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) {
      const SurfacePoint& point = points[static_cast<std::size_t>(p)];
      const Ray ray{.origin = point.position, .direction = sun, .origin_group = point.facet};
      std::uint8_t blocked = 0;
      caster.occluded({&ray, 1}, {&blocked, 1});
      factors[p] = blocked != 0 ? 0.0 : std::max(0.0, point.normal.dot(sun));
    }
  });
  return factors;
}

Eigen::ArrayXd point_reflections(const PointViews& views, const Eigen::ArrayXd& albedo,
                                 const Eigen::ArrayXd& E) {
  Eigen::ArrayXd reflected = Eigen::ArrayXd::Zero(views.sky.size());
  for (Eigen::Index p = 0; p < reflected.size(); ++p) {
    for (const FormFactor& f : views.rows[static_cast<std::size_t>(p)]) {
      reflected[p] += double{f.value} * albedo[f.patch] * E[f.patch];
    }
  }
  return reflected;
}

}  // namespace lightwell
