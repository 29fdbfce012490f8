#include "radiosity/radiation/sky_exposure.h"

#include <algorithm>
#include <array>
#include <functional>
#include <span>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "mesh/patches/patch_sampler.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr int fewest_exposure_rays = 1024, most_exposure_rays = 16384;
constexpr int shadow_edge_refinement = 16;  // times as many rays of the sun beside a shadow
constexpr std::size_t ray_batch = 64;

using RayBatch = std::array<Ray, ray_batch>;

struct PhaseProgress {
  const Progress& to;
  const char* phase;
};

// Means over rows of a value of each patch, by area.
Eigen::ArrayXd means_of_rows(const FacetViewFactors& found, const PhaseProgress& progress,
                             const std::function<double(int patch)>& of_patch) {
  const PatchMesh& mesh = found.mesh;
  std::vector<double> value(static_cast<std::size_t>(mesh.patch_count()), 0.0);
  constexpr int block = 512;  // patches between two reports
  for (int first = 0; first < mesh.patch_count(); first += block) {
    report(progress.to, progress.phase, static_cast<double>(first) / mesh.patch_count());
    parallel_for(std::min(block, mesh.patch_count() - first), 1, [&](int begin, int end) {
      for (int p = first + begin; p < first + end; ++p) {
        const auto i = static_cast<std::size_t>(p);
        if (found.rows.of_patch[i] >= 0) value[i] = of_patch(p);
      }
    });
  }
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(found.rows.count()), area = sum;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const int row = found.rows.of_patch[static_cast<std::size_t>(p)];
    if (row < 0) continue;
    sum[row] += mesh.area[p] * value[static_cast<std::size_t>(p)];
    area[row] += mesh.area[p];
  }
  return (area > 0.0).select(sum / area, 0.0);
}

// Rays of a patch, and those of them that meet no row.
struct LostRays {
  int count = 0, to_sky = 0, elsewhere = 0;
};

// Adds the rays that leave the rows.
void count_lost(const FacetViewFactors& found, const Eigen::Vector3d& up, const RayBatch& rays,
                std::span<const ElementHit> hits, LostRays& lost) {
  for (std::size_t r = 0; r < hits.size(); ++r) {
    const ElementHit& hit = hits[r];
    if (hit.facet < 0 && rays[r].direction.dot(up) > 0.0) {
      ++lost.to_sky;
    } else if (hit.element < 0) {
      ++lost.elsewhere;
    } else {
      const int patch = found.mesh.patch[static_cast<std::size_t>(hit.element)];
      if (found.rows.of_patch[static_cast<std::size_t>(patch)] < 0) ++lost.elsewhere;
    }
  }
}

std::uint64_t key_of_patch(int patch, RandomPurpose purpose) {
  return random_key(static_cast<std::uint64_t>(patch), purpose);
}

LostRays lost_rays(const FacetViewFactors& found, const ElementCaster& caster,
                   const SobolPoints& sobol, const Eigen::Vector3d& up, int patch) {
  const PatchSampler sampler(found.mesh, patch);
  const std::uint64_t key = key_of_patch(patch, RandomPurpose::sky_view_rays);
  RayBatch rays;
  std::array<ElementHit, ray_batch> hits;
  LostRays lost;
  for (int wanted = fewest_exposure_rays; lost.count < wanted;) {
    for (std::size_t r = 0; r < ray_batch; ++r) {
      const Eigen::Array4f u = sobol.point(lost.count + static_cast<int>(r), key);
      rays[r] = cosine_ray(found.mesh, sampler.point(double{u[0]}, double{u[1]}), u[2], u[3]);
    }
    caster.closest_elements(rays, hits);
    count_lost(found, up, rays, hits, lost);
    lost.count += static_cast<int>(ray_batch);
    if (lost.to_sky > 0 && lost.elsewhere > 0) wanted = most_exposure_rays;
  }
  return lost;
}

}  // namespace

Eigen::ArrayXd sky_view_factors(const FacetViewFactors& found, const Eigen::Vector3d& up,
                                const Progress& progress) {
  const ElementCaster caster(found.mesh);
  const SobolPoints sobol(most_exposure_rays);
  // The rays divide the share that meets no row; the share itself is known better.
  Eigen::ArrayXd elsewhere = Eigen::ArrayXd::Zero(found.mesh.patch_count());
  const Eigen::ArrayXd sky = means_of_rows(found, {progress, "sky view factors"}, [&](int patch) {
    const LostRays lost = lost_rays(found, caster, sobol, up, patch);
    elsewhere[patch] = double(lost.elsewhere) / lost.count;
    return double(lost.to_sky) / lost.count;
  });
  const Eigen::ArrayXd all =
      sky + means_of_rows(found, {{}, ""}, [&](int patch) { return elsewhere[patch]; });
  Eigen::ArrayXd factors(found.rows.count());
  for (int i = 0; i < found.rows.count(); ++i) {
    const auto r = static_cast<std::size_t>(i);
    const double open = found.factors.open[r] + found.factors.blocked[r];
    // A gap that no ray found shows the sky.
    const double part = all[i] > 0.0 ? sky[i] / all[i] : 1.0;
    factors[i] = found.factors.area[r] > 0.0 ? std::clamp(open * part, 0.0, 1.0) : 0.0;
  }
  return factors;
}

namespace {

// Mean cosine to the sun over a patch, where points see it.
double sunlit_cosine(const FacetViewFactors& found, const ElementCaster& caster,
                     const SobolPoints& sobol, const Eigen::Vector3d& sun, int patch) {
  const PatchMesh& mesh = found.mesh;
  const PatchSampler sampler(mesh, patch);
  const std::uint64_t key = key_of_patch(patch, RandomPurpose::sun_shadows);
  RayBatch rays;
  std::array<double, ray_batch> cosines{};
  std::array<std::uint8_t, ray_batch> blocked{};
  double sum = 0.0;
  int count = 0, dark = 0;
  for (int wanted = sobol.count() / shadow_edge_refinement; count < wanted;
       count += static_cast<int>(ray_batch)) {
    for (std::size_t r = 0; r < ray_batch; ++r) {
      const Eigen::Array4f u = sobol.point(count + static_cast<int>(r), key);
      const PatchPoint from = sampler.point(double{u[0]}, double{u[1]});
      cosines[r] = from.normal.dot(sun);
      rays[r] = {.origin = from.position,
                 .direction = sun,
                 .origin_group = mesh.facet[static_cast<std::size_t>(from.element)]};
    }
    if (sampler.is_flat() && !(cosines[0] > 0.0)) return 0.0;
    caster.occluded(rays, blocked);
    for (std::size_t r = 0; r < ray_batch; ++r) {
      const bool is_lit = blocked[r] == 0 && cosines[r] > 0.0;
      sum += is_lit ? cosines[r] : 0.0;
      dark += is_lit ? 0 : 1;
    }
    const int seen = count + static_cast<int>(ray_batch);
    if (dark > 0 && dark < seen) wanted = sobol.count();
  }
  return sum / count;
}

}  // namespace

Eigen::ArrayXd sun_factors(const FacetViewFactors& found, const ElementCaster& caster,
                           const Eigen::Vector3d& sun, int rays, const Progress& progress) {
  const SobolPoints sobol(shadow_edge_refinement * rays);
  return means_of_rows(found, {progress, "sun"},
                       [&](int patch) { return sunlit_cosine(found, caster, sobol, sun, patch); });
}

Eigen::ArrayXd sun_factors(const FacetViewFactors& found, const Eigen::Vector3d& sun) {
  return sun_factors(found, ElementCaster(found.mesh), sun);
}

}  // namespace lightwell
