#pragma once

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "mesh/patches/patch_sampler.h"
#include "radiosity/solution/scene_parts.h"

namespace lightwell::test {

/// Mean irradiance of each part by light that is traced from the emitting patches, W/m^2, over the
/// area that reflects in band 0.
inline std::vector<double> traced_means(const ElementCaster& caster, const SceneParts& parts,
                                        int paths) {
  const PatchMesh& mesh = caster.mesh();
  std::vector<double> sum(static_cast<std::size_t>(parts.judged_count()), 0.0), area(sum);
  std::vector<int> emitters;
  std::vector<double> power;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (mesh.reflectance(p, 0) > 0.0f) area[parts.judged_with(p)] += mesh.area[p];
    if (!(mesh.emission(p, 0) > 0.0f)) continue;
    emitters.push_back(p);
    power.push_back(mesh.area[p] * double{mesh.emission(p, 0)});
  }
  std::mt19937_64 random(7);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  for (std::size_t i = 0; i < emitters.size(); ++i) {
    const PatchSampler sampler(mesh, emitters[i]);
    for (int n = 0; n < paths; ++n) {
      PatchPoint from = sampler.point(uniform(random), uniform(random));
      for (;;) {
        const float u = uniform(random), v = uniform(random);
        const Ray ray = cosine_ray(mesh, from, u, v);
        std::array<ElementHit, 1> hit;
        caster.closest_elements({&ray, 1}, hit);
        if (hit[0].element < 0) break;
        const int patch = mesh.patch[hit[0].element];
        const double rho = double{mesh.reflectance(patch, 0)};
        if (rho > 0.0) sum[parts.judged_with(patch)] += power[i] / paths;
        if (!(uniform(random) < rho)) break;
        from.element = hit[0].element;
        from.position = ray.origin + hit[0].t * ray.direction;
        from.normal = element_center(mesh, hit[0].element).normal;
      }
    }
  }
  for (std::size_t p = 0; p < sum.size(); ++p) sum[p] /= area[p];
  return sum;
}

}  // namespace lightwell::test
