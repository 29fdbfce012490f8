#include "radiosity/even_caustics.h"

#include "radiosity/gather/caustic_irradiance.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/refine/element_limits.h"

namespace lightwell {
namespace {

// The leaves that are not much smaller than most of the area is cut into.
std::vector<int> large_leaves(const RefinedElements& elements) {
  const double typical = typical_leaf_area(elements);
  constexpr double small = 1.0 / 64.0;  // as crumbs are small
  std::vector<int> large;
  for (const int cell : elements.leaves()) {
    if (elements.area(cell) > small * typical) large.push_back(cell);
  }
  return large;
}

}  // namespace

BandArray caustics(const LitScene& lit, const SolveOptions& options) {
  return caustic_irradiance(lit, options.caustic_rays, options.form_factors.max_specular_depth,
                            options.run);
}

EvenCaustics::EvenCaustics(const LitScene& base, const SolveOptions& options,
                           RefinedElements& elements) {
  if (!LightPaths(base.scene, base.caster, 1).has_specular()) return;
  const std::vector<int> large = large_leaves(elements);
  if (starts_coarse(options) && options.mesh.elements_per_patch_edge > 1) elements.split(large);
  const RefinedMesh even = elements.mesh();
  elements.merge(large);
  values_ = BandArray::Zero(elements.vertex_count(), base.direct_light.column_count());
  const ElementCaster caster(even.mesh, base.caster, even.tree);
  const BandArray found = caustics({base.scene, caster, base.direct_light}, options);
  if (found.size() == 0) return;
  known_ = elements.vertex_count();
  for (std::size_t v = 0; v < even.vertex.size(); ++v) {
    values_.row(even.vertex[v]) = found.row(static_cast<Eigen::Index>(v));
  }
}

BandArray EvenCaustics::at(const RefinedElements& elements, const std::vector<int>& vertices) {
  if (known_ == 0) return {};
  values_.conservativeResize(elements.vertex_count(), values_.cols());
  for (int v = known_; v < elements.vertex_count(); ++v) {
    values_.row(v).setZero();
    int count = 0;
    for (const int end : elements.ends(v)) {
      if (end < 0) continue;
      values_.row(v) += values_.row(end);
      ++count;
    }
    values_.row(v) /= static_cast<float>(count);
  }
  BandArray result(static_cast<Eigen::Index>(vertices.size()), values_.cols());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    result.row(static_cast<Eigen::Index>(v)) = values_.row(vertices[v]);
  }
  return result;
}

}  // namespace lightwell
