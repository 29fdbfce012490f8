#include "raytrace/readings/read_error.h"

#include <algorithm>
#include <numbers>
#include <optional>
#include <vector>

#include "mesh/patches/translucency.h"
#include "radiosity/gather/gap_light.h"
#include "radiosity/gather/patch_power.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/refine/illuminance_bound.h"
#include "raytrace/readings/sure_gather.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr int ray_count = 64;
constexpr int most_bounces = 16;
// Keeps these random numbers apart from those of gathers.
constexpr std::uint64_t own_key = 0x4ead;

class ReadErrors {
 public:
  // `missed` is the light that a path out of a gap at each patch, met by no ray, may bring, lx.
  // `rays` are those of a set of the gather.
  ReadErrors(const LitScene& lit, const BandArray& radiosity, const Eigen::ArrayXf& error,
             const Eigen::ArrayXd& missed, int rays)
      : mesh_(lit.mesh()),
        caster_(lit.caster),
        paths_(lit.scene, lit.caster, most_bounces),
        gaps_(lit, {lit.mesh(), radiosity}, paths_, widest_gap_at_readings),
        error_(error),
        missed_(missed),
        rays_of_set_(rays),
        directions_(ray_count) {}

  double at(const GatherPoint& point, std::uint64_t key) const {
    const std::uint64_t ray_key = random_key(key, RandomPurpose::gather_rays, own_key);
    std::vector<Ray> rays;
    for (int i = 0; i < ray_count; ++i) {
      const Eigen::Array4f u = directions_.point(i, ray_key);
      rays.push_back(cosine_ray(point.position, point.normal, point.facet, u[0], u[1]));
    }
    std::vector<ElementHit> hits(rays.size());
    caster_.closest_hits(rays, hits);
    const SurfacePoint here{
        .position = point.position, .normal = point.normal, .facet = point.facet};
    std::optional<GapExits> exits;
    if (point.facet >= 0) {
      exits = gaps_.exits(caster_, here, rays_of_set_,
                          random_key(key, RandomPurpose::gap_rays, own_key));
    }
    double sum = 0.0;
    for (int i = 0; i < ray_count; ++i) {
      const auto number = static_cast<std::size_t>(i);
      const std::uint64_t path = random_key(key, RandomPurpose::gather_paths, number, own_key);
      sum +=
          weight(here, exits, rays[number]) * along(here, exits, rays[number], hits[number], path);
    }
    if (exits) sum += along_exits(here, exits, key);
    return sum / ray_count;
  }

 private:
  // Weight of a ray of either kind by the balance heuristic: cosine-distributed, or as many aimed
  // at exits.
  static double weight(const SurfacePoint& here, const std::optional<GapExits>& exits,
                       const Ray& ray) {
    if (!exits) return 1.0;
    const double by_cosine = std::max(here.normal.dot(ray.direction), 0.0) * std::numbers::inv_pi;
    const double aimed = exits->density(here.normal, ray.direction);
    return by_cosine > 0.0 ? by_cosine / (by_cosine + aimed) : 0.0;
  }

  // Sum over rays aimed at exits.
  double along_exits(const SurfacePoint& here, const std::optional<GapExits>& exits,
                     std::uint64_t key) const {
    const std::uint64_t aims = random_key(key, RandomPurpose::gap_rays, own_key, 1);
    double sum = 0.0;
    for (int i = 0; i < ray_count; ++i) {
      const auto number = static_cast<std::uint64_t>(ray_count + i);
      const std::uint64_t path = random_key(key, RandomPurpose::gather_paths, number, own_key);
      const Eigen::Array4f u = directions_.point(i, aims);
      const Ray ray{.origin = here.position,
                    .direction = exits->draw(here.normal, u[0], u[1], u[2]),
                    .origin_group = here.facet};
      ElementHit hit;
      caster_.closest_hits({&ray, 1}, {&hit, 1});
      sum += weight(here, exits, ray) * along(here, exits, ray, hit, path);
    }
    return sum;
  }

  // rho e at the end of the path that begins with a ray, and the light missed if the path begins in
  // a gap whose exits are not known.
  double along(const SurfacePoint& here, const std::optional<GapExits>& exits, const Ray& ray,
               const ElementHit& hit, std::uint64_t key) const {
    if (hit.facet < 0) return 0.0;
    const GapExits* const gap = exits ? &*exits : nullptr;
    if (here.facet < 0 || !gaps_.stays_in(caster_, gap, here.normal, ray, hit)) {
      return end(ray, hit, 1.0, key);
    }
    double sum = gap && !gap->is_closed() ? 0.0 : missed_[mesh_.patch[hit.element]];
    gaps_.follow(caster_, ray, hit, key, {.exits = gap},
                 {.at_surface = [](const GapLight::Stop&) {},
                  .at_coat =
                      [&](const GapLight::Stop& stop) {
                        sum += mirrored(stop.ray, stop.hit, double{stop.share.mean()}, stop.key);
                      },
                  .at_end =
                      [&](const GapLight::Stop& stop) {
                        sum += end(stop.ray, stop.hit, double{stop.share.mean()}, stop.key);
                      }});
    return sum;
  }

  double end(const Ray& ray, const ElementHit& hit, double share, std::uint64_t key) const {
    double sum = 0.0;
    if (hit.element >= 0 && paths_.is_diffuse(hit.facet)) {
      const Spectrum left = paths_.left_by_body(ray, hit);
      const double dimmed = left.size() > 0 ? double{left.mean()} : 1.0;
      sum += share * dimmed * reflected(hit.element);
    }
    return paths_.is_specular(hit.facet) ? sum + mirrored(ray, hit, share, key) : sum;
  }

  // rho e where light ends that the surface at the end of a ray mirrors or passes.
  double mirrored(const Ray& ray, const ElementHit& hit, double share, std::uint64_t key) const {
    double sum = 0.0;
    paths_.follow(
        ray, hit, key,
        [&](const ElementHit& end, const Spectrum& throughput) {
          if (end.element < 0) return;
          sum += share * static_cast<double>(throughput.mean()) * reflected(end.element);
        },
        PathQuantity::radiance);
    return sum;
  }

  double reflectance(int element) const {
    return double{mesh_.reflectance.row(mesh_.patch[element]).mean()};
  }
  double reflected(int element) const {
    const double sum = reflectance(element) * double{error_[element]};
    const int patch = mesh_.patch[element];
    if (mesh_.patch_behind(patch) < 0) return sum;
    return sum +
           double{mesh_.transmittance.row(patch).mean()} * double{error_[mesh_.twin[element]]};
  }

  static Ray cosine_ray(const Eigen::Vector3d& from, const Eigen::Vector3d& normal, int facet,
                        float u, float v) {
    Eigen::Vector3d a, b;
    tangent_frame(normal, a, b);
    const Eigen::Vector3d d = cosine_direction(u, v);
    return {
        .origin = from, .direction = d.x() * a + d.y() * b + d.z() * normal, .origin_group = facet};
  }

  const PatchMesh& mesh_;
  const ElementCaster& caster_;
  LightPaths paths_;
  GapLight gaps_;
  const Eigen::ArrayXf& error_;
  const Eigen::ArrayXd& missed_;
  int rays_of_set_;
  SobolPoints directions_;
};

// Mean of rho E over the lit surfaces of each patch's part, lx.
Eigen::ArrayXd mean_reflected(const LitScene& lit, const RadiositySolution& solution) {
  const PatchMesh& mesh = lit.mesh();
  const SceneParts& parts = solution.parts;
  const BandArray E = solution.irradiance();
  const Eigen::ArrayXXd of_patch = patch_integral(mesh, E);
  Eigen::ArrayXXd sum = Eigen::ArrayXXd::Zero(parts.judged_count(), E.cols());
  Eigen::ArrayXd area = Eigen::ArrayXd::Zero(parts.judged_count());
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (!(of_patch.row(p) > 0.0).any()) continue;
    sum.row(parts.judged_with(p)) +=
        of_patch.row(p) * scattered_share(mesh, p).transpose().cast<double>();
    area[parts.judged_with(p)] += mesh.area[p];
  }
  Eigen::ArrayXd mean = Eigen::ArrayXd::Zero(mesh.patch_count());
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const int part = parts.judged_with(p);
    if (!(area[part] > 0.0)) continue;
    const Spectrum of_part = (sum.row(part) / area[part]).transpose().cast<float>();
    mean[p] = luminous(lit.scene.bands, of_part);
  }
  return mean;
}

}  // namespace

Eigen::ArrayXd read_errors(const LitScene& lit, const RadiositySolution& solution,
                           const BandArray& radiosity, const GatherPoints& points, int rays) {
  Eigen::ArrayXd errors = Eigen::ArrayXd::Zero(points.size());
  const Eigen::ArrayXf of_elements = illuminance_errors(lit.mesh(), solution);
  if (of_elements.size() != lit.mesh().element_count()) return errors;
  constexpr double unseen = 3.0;  // of n trials, at odds of 19 to 1
  const Eigen::ArrayXd missed = unseen / std::max(rays, 1) * mean_reflected(lit, solution);
  const ReadErrors read(lit, radiosity, of_elements, missed, rays / rays_over_set);
  parallel_for(points.size(), 8, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const GatherPoint point = points[i];
      errors[i] = read.at(point, point.key.value_or(static_cast<std::uint64_t>(i)));
    }
  });
  return errors;
}

}  // namespace lightwell
