#include "raytrace/shading/picture_base_gains.h"

#include <optional>
#include <vector>

#include "radiosity/direct_light/patch_base.h"
#include "radiosity/emitters/free_source.h"
#include "radiosity/gather/gatherable_radiosity.h"
#include "radiosity/gather/vertex_points.h"
#include "radiosity/sky/sky_light.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Sets the gains of the dome's light.
void find_dome_gains(const LitScene& lit, BandArray& gains) {
  const SkyLight* const sky = lit.direct_light.sky();
  if (!sky || !lit.direct_light.dome()->is_on()) return;
  const PatchMesh& mesh = lit.mesh();
  const std::vector<int> patch = vertex_patches(mesh);
  const VertexGatherPoints points(mesh);
  // The factor deviates from its mean by 0.2 or less over the directions of a part of the sky: 64
  // rays leave 2.5 % if they were not stratified, about the noise of a pixel's shadow rays.
  constexpr SkyEffort effort{.first = 16, .most = 48};
  constexpr int grain = 64;
  constexpr auto column = static_cast<Eigen::Index>(BaseGain::of_dome);
  parallel_for(mesh.vertex_count(), grain, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      const std::optional<CoatedBase> base = base_of_patch(lit.direct_light, mesh, patch[v]);
      if (!base) continue;
      const GatherPoint at = points[v];
      const auto key = random_key(static_cast<std::uint64_t>(v), RandomPurpose::gather_shadows);
      const SkyGlow glow = sky->irradiance(lit.caster, {at.position, at.normal, at.facet}, key,
                                           effort, {.base = &*base});
      gains(v, column) = static_cast<float>(glow.gain);
    }
  });
}

}  // namespace

BandArray picture_base_gains(const LitScene& lit, const RadiositySolution& solution) {
  if (!lit.direct_light.has_coats()) return {};
  const PatchMesh& mesh = lit.mesh();
  constexpr int rays = 64;
  const BandArray indirect =
      indirect_base_gains(lit, gatherable_radiosity(mesh, lit.direct_light, solution), rays);
  if (indirect.size() == 0) return {};
  BandArray gains = BandArray::Ones(mesh.vertex_count(), 2);
  gains.col(static_cast<Eigen::Index>(BaseGain::of_indirect)) = indirect.col(0);
  find_dome_gains(lit, gains);
  return gains;
}

}  // namespace lightwell
