#include "radiosity/point_lists.h"

#include "mesh/patches/patch_sampler.h"
#include "radiosity/gather/vertex_points.h"

namespace lightwell {

GatherPoints points_of_vertices(const GatherPoints& all, const std::vector<int>& vertices) {
  return {static_cast<int>(vertices.size()), [&all, &vertices](int i) {
            const int v = vertices[static_cast<std::size_t>(i)];
            GatherPoint point = all[v];
            point.key = static_cast<std::uint64_t>(v);
            return point;
          }};
}

GatherPoints points_on_patches(const PatchMesh& mesh, const std::vector<int>& patches) {
  return {static_cast<int>(patches.size()), [&mesh, &patches](int i) {
            const PatchPoint at =
                PatchSampler(mesh, patches[static_cast<std::size_t>(i)]).point(0.5, 0.5);
            return GatherPoint{at.position, at.normal, mesh.facet[at.element]};
          }};
}

BandArray direct_beside(const LitScene& lit, const std::vector<InterpolatedVertex>& unread,
                        const GatherOptions& options) {
  const GatherPoints all = vertex_points(lit.caster);
  const std::vector<int> others = indices_without(unread, static_cast<std::size_t>(all.size()));
  BandArray direct =
      spread_rows(gather_direct(lit, points_of_vertices(all, others), options), others, all.size());
  interpolate_vertices(unread, direct);
  return direct;
}

}  // namespace lightwell
