#include "raytrace/pixel_gather.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <span>

#include "radiosity/gather/final_gather.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr int batch = 64;

// Returns the direction, mirrored at the facet if it points below. The hemisphere of a smooth
// normal reaches below the facet, where a ray would meet the facet's own neighbourhood; the
// mirrored direction is the best estimate of that light.
Eigen::Vector3d above(const Eigen::Vector3d& direction, const Eigen::Vector3d& normal) {
  const double height = direction.dot(normal);
  return height < 0.0 ? Eigen::Vector3d(direction - 2.0 * height * normal) : direction;
}

// pi times the probability density of a direction after above() has mirrored the directions that
// point below.
double measure(const ShadingPoint& at, const Eigen::Vector3d& direction) {
  const double height = direction.dot(at.normal);
  if (!(height > 0.0)) return 0.0;
  const Eigen::Vector3d below = direction - 2.0 * height * at.normal;
  return std::max(direction.dot(at.smooth_normal), 0.0) +
         std::max(below.dot(at.smooth_normal), 0.0);
}

}  // namespace

PixelGather::PixelGather(const Scene& scene, const ElementCaster& caster,
                         const DirectLight& direct_light, const RadiositySolution& solution,
                         int most_rays, int max_specular_depth)
    : paths_(scene, caster, max_specular_depth),
      radiosity_(gatherable_radiosity(caster.mesh(), direct_light, solution.irradiance())),
      bright_(scene, caster.mesh(), radiosity_),
      gaps_({scene, caster, direct_light}, radiosity_, paths_),
      aims_(BrightPatches::aimed(most_rays)) {
  if (const FreeSource* dome = direct_light.dome()) dome_ = dome->light;
  constexpr int fewest = 8;
  for (int rays = most_rays; rays >= std::min(fewest, most_rays) && rays > 0; rays /= 2) {
    sets_.emplace_back(rays);
  }
}

Spectrum PixelGather::indirect_irradiance(const ElementCaster& caster, const ShadingPoint& at,
                                          std::uint64_t key, float share) const {
  std::size_t level = 0;
  for (; share <= 0.5f && level + 1 < sets_.size(); share *= 2.0f) ++level;
  const HemisphereSets::Draw draw =
      sets_[level].draw(random_key(key, RandomPurpose::pixel_gather_rays));
  const Eigen::Matrix3d frame = draw.frame(at.smooth_normal);
  const auto points = draw.all();
  const auto count = static_cast<int>(points.size());
  BrightPatches::View view;
  if (!bright_.is_empty()) view = bright_.view(at.position, at.smooth_normal, count);
  std::array<Ray, batch> rays;
  std::array<ElementHit, batch> hits;
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(radiosity_.cols());
  for (std::size_t begin = 0; begin < points.size(); begin += batch) {
    const std::size_t n = std::min<std::size_t>(batch, points.size() - begin);
    for (std::size_t r = 0; r < n; ++r) {
      const HemispherePoint& p = points[begin + r];
      rays[r] = {.origin = at.position,
                 .direction = above(frame * Eigen::Vector3d(p.x, p.y, p.z), at.normal),
                 .origin_group = at.facet};
    }
    caster.closest_hits({rays.data(), n}, {hits.data(), n});
    for (std::size_t r = 0; r < n; ++r) {
      if (hits[r].facet < 0) continue;
      const std::uint64_t ray_key = random_key(key, RandomPurpose::pixel_gather_paths, begin + r);
      if (gaps_.is_gap(at.normal, rays[r], hits[r])) {
        gaps_.add(caster, rays[r], hits[r], ray_key, sum);
        continue;
      }
      const double straight = view.is_empty() ? 1.0
                                              : bright_.share(view, measure(at, rays[r].direction),
                                                              count, rays[r], hits[r]);
      sum += arriving(caster, rays[r], hits[r], ray_key, straight).cast<double>();
    }
  }
  if (!view.is_empty()) aim(caster, at, view, count, key, sum);
  return (sum / static_cast<double>(points.size())).cast<float>();
}

// Adds light of bright patches by aimed rays. A ray counts only if the element it was aimed at is
// its first hit.
void PixelGather::aim(const ElementCaster& caster, const ShadingPoint& at,
                      const BrightPatches::View& view, int rays, std::uint64_t key,
                      Eigen::ArrayXd& sum) const {
  const std::uint64_t aim_key = random_key(key, RandomPurpose::pixel_gather_aims);
  for (int i = 0; i < BrightPatches::aimed(rays); ++i) {
    const Eigen::Array4d u = aims_.point(i, aim_key).cast<double>();
    const BrightPatches::Aim aim = bright_.draw(view, u[0], u[1], u[2]);
    const double cosine = measure(at, aim.direction);
    if (!(cosine > 0.0)) continue;
    const Ray ray{.origin = at.position, .direction = aim.direction, .origin_group = at.facet};
    ElementHit hit;
    caster.closest_hits({&ray, 1}, {&hit, 1});
    if (hit.element != aim.element || !paths_.is_diffuse(hit.facet)) continue;
    if (gaps_.is_gap(at.normal, ray, hit)) continue;
    const double share = bright_.share(view, cosine, rays, ray, hit);
    sum += share * interpolate(caster.mesh(), radiosity_, hit).cast<double>();
  }
}

// Radiosity B at the end of a ray. Light of the first hit itself is weighted by `share`; light
// through mirrors and glass has weight 1.
Spectrum PixelGather::arriving(const ElementCaster& caster, const Ray& ray, const ElementHit& hit,
                               std::uint64_t key, double share) const {
  const PatchMesh& mesh = caster.mesh();
  Spectrum B = Spectrum::Zero(radiosity_.cols());
  if (hit.element >= 0 && paths_.is_diffuse(hit.facet)) {
    B = static_cast<float>(share) * interpolate(mesh, radiosity_, hit);
  }
  if (!paths_.is_specular(hit.facet)) return B;
  const PathLosses losses = paths_.follow(caster, ray, hit, key, [&](const LightArrival& end) {
    B += end.throughput * interpolate(mesh, radiosity_, end.hit);
  });
  if (losses.sky.size() > 0 && dome_.size() > 0) {
    B += std::numbers::pi_v<float> * dome_ * losses.sky;
  }
  return B;
}

}  // namespace lightwell
