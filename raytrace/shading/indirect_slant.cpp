#include "raytrace/shading/indirect_slant.h"

#include <vector>

#include "raytrace/shading/pixel_gather.h"
#include "scene/facet_relief.h"
#include "scene/parallel.h"

namespace lightwell {

BandArray indirect_slant(const Scene& scene, const ElementCaster& caster,
                         const DirectLight& direct_light, const RadiositySolution& solution,
                         int max_specular_depth) {
  const FacetRelief relief(scene);
  if (relief.is_empty()) return {};
  const PatchMesh& mesh = caster.mesh();
  std::vector<int> elements;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (relief.is_given(mesh.facet[e])) elements.push_back(e);
  }
  if (elements.empty()) return {};
  // 20000 elements of 64 pairs are 2.5 million rays, some seconds on two cores. The slant of more
  // elements, which are smaller in a picture, may have twice the noise.
  constexpr int many_elements = 20000, pairs = 64, fewer_pairs = 16;
  const auto count = static_cast<int>(elements.size());
  const PixelGather gather(scene, caster, direct_light, solution,
                           count > many_elements ? fewer_pairs : pairs, max_specular_depth);
  std::vector<Eigen::Vector3d> slant(elements.size());
  parallel_for(count, 16, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const int e = elements[static_cast<std::size_t>(i)];
      const PatchPoint at = element_center(mesh, e);
      slant[static_cast<std::size_t>(i)] = gather.slant(caster,
                                                        {.position = at.position,
                                                         .normal = at.normal,
                                                         .smooth_normal = at.normal,
                                                         .facet = mesh.facet[e]},
                                                        static_cast<std::uint64_t>(e));
    }
  });
  BandArray at_vertices = BandArray::Zero(mesh.vertex_count(), 3);
  std::vector<int> sharing(static_cast<std::size_t>(mesh.vertex_count()), 0);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    for (int c = 0; c < mesh.corner_count(elements[i]); ++c) {
      const int v = mesh.corners[elements[i]][c];
      at_vertices.row(v) += slant[i].transpose().array().cast<float>();
      ++sharing[static_cast<std::size_t>(v)];
    }
  }
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const int n = sharing[static_cast<std::size_t>(v)];
    if (n > 1) at_vertices.row(v) /= static_cast<float>(n);
  }
  return at_vertices;
}

}  // namespace lightwell
