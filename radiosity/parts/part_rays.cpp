#include "radiosity/parts/part_rays.h"

#include <algorithm>
#include <bit>
#include <map>

#include "mesh/patches/patch_sampler.h"
#include "radiosity/parts/backdrop.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

int part_rays_per_patch(int patches) {
  constexpr int all = 1 << 15, fewest = 32, most = 1024;
  const int wanted = std::clamp(all / std::max(patches, 1), fewest, most);
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(wanted)));
}

class PartRays {
 public:
  PartRays(const Scene& scene, const ElementCaster& caster, const LightPaths& paths)
      : caster_(caster),
        paths_(paths),
        is_backdrop_(backdrop_patches(scene, caster.mesh())),
        rays_(part_rays_per_patch(caster.mesh().patch_count())),
        sobol_(rays_) {}

  PartRayEnds cast(int patch) const {
    const PatchMesh& mesh = caster_.mesh();
    PartRayEnds result;
    if (!paths_.is_diffuse(mesh.facet[mesh.first_element[patch]])) return result;
    result.takes_part = true;
    const std::uint64_t key =
        random_key(static_cast<std::uint64_t>(patch), RandomPurpose::part_rays);
    const PatchSampler sampler(mesh, patch);
    std::vector<Ray> rays;
    for (int r = 0; r < rays_; ++r) {
      const Eigen::Array4f u = sobol_.point(r, key);
      rays.push_back(cosine_ray(mesh, sampler.point(u[0], u[1]), u[2], u[3]));
    }
    std::vector<ElementHit> hits(rays.size());
    caster_.closest_elements(rays, hits);
    const float one = 1.0f / static_cast<float>(rays_);
    std::map<int, RayArrivals> by_patch;
    const auto arrive = [&](int element, float share, double length) {
      const int p = mesh.patch[element];
      RayArrivals& at = by_patch[p];
      at.patch = p;
      at.share += share;
      at.length += share * static_cast<float>(length);
    };
    for (std::size_t r = 0; r < rays.size(); ++r) {
      const ElementHit& hit = hits[r];
      if (leaves(hit)) {
        result.escaped += double{one};
        continue;
      }
      const bool is_specular = paths_.has_specular() && paths_.is_specular(hit.facet);
      if (hit.element >= 0 && (!is_specular || paths_.is_diffuse(hit.facet))) {
        arrive(hit.element, one, hit.t);
      } else if (is_specular) {
        const auto end = [&](const ElementHit& at, const Spectrum& throughput) {
          if (leaves(at)) {
            result.escaped += double{one * throughput.mean()};
          } else if (at.element >= 0) {
            arrive(at.element, one * throughput.mean(), hit.t);
          }
        };
        const PathLosses losses =
            paths_.follow(rays[r], hit, random_key(key, RandomPurpose::part_rays, r), end);
        result.escaped += double{one * losses.escaped.mean()};
      }
    }
    for (const auto& [p, at] : by_patch) result.at.push_back(at);
    return result;
  }

 private:
  // Light that ends on a backdrop is outside.
  bool leaves(const ElementHit& hit) const {
    return hit.facet < 0 || (hit.element >= 0 && is_backdrop_[caster_.mesh().patch[hit.element]]);
  }

  const ElementCaster& caster_;
  const LightPaths& paths_;
  std::vector<char> is_backdrop_;
  int rays_;
  SobolPoints sobol_;
};

}  // namespace

std::vector<PartRayEnds> cast_part_rays(const Scene& scene, const ElementCaster& caster,
                                        const LightPaths& paths, const Progress& progress) {
  const PartRays rays(scene, caster, paths);
  const int patches = caster.mesh().patch_count();
  std::vector<PartRayEnds> arrivals(static_cast<std::size_t>(patches));
  constexpr int slice = 4096, grain = 16;  // patches between two reports of progress
  for (int begin = 0; begin < patches; begin += slice) {
    report(progress, "parts", static_cast<double>(begin) / patches);
    parallel_for(std::min(slice, patches - begin), grain, [&](int low, int high) {
      for (int i = begin + low; i < begin + high; ++i) arrivals[i] = rays.cast(i);
    });
  }
  return arrivals;
}

std::vector<ClusterSums> sums_of_clusters(const PatchMesh& mesh,
                                          const std::vector<PartRayEnds>& arrivals,
                                          const std::vector<int>& cluster) {
  std::vector<ClusterSums> sums(static_cast<std::size_t>(*std::ranges::max_element(cluster) + 1));
  for (int i = 0; i < mesh.patch_count(); ++i) {
    if (cluster[i] < 0) continue;
    ClusterSums& of = sums[cluster[i]];
    of.area += mesh.area[i];
    ++of.patches;
    of.escaped += mesh.area[i] * arrivals[i].escaped;
    for (const RayArrivals& at : arrivals[i].at) {
      if (cluster[at.patch] != cluster[i]) continue;
      of.within += mesh.area[i] * double{at.share};
      of.length += mesh.area[i] * double{at.length};
    }
  }
  return sums;
}

}  // namespace lightwell
