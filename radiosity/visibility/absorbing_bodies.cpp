#include "radiosity/visibility/absorbing_bodies.h"

#include <Eigen/Geometry>

#include "scene/parallel.h"

namespace lightwell {

AbsorbingBodies::AbsorbingBodies(const Scene& scene, const ElementCaster& caster)
    : walks_(scene), round_(scene) {
  for (const Material& material : scene.materials) {
    const bool is_body = material.dielectric && !material.dielectric->thin;
    absorption_.push_back(is_body ? material.dielectric->absorption
                                  : Spectrum(Spectrum::Zero(scene.bands.count())));
  }
  for (const FacetRef& ref : scene_facets(scene)) {
    const auto* polygons = std::get_if<PolygonMesh>(&scene.surfaces[ref.surface].shape);
    normal_.push_back(polygons ? facet_normal(*polygons, polygons->facets[ref.facet])
                               : Eigen::Vector3d::Zero());
  }
  const PatchMesh& mesh = caster.mesh();
  of_patch_.resize(static_cast<std::size_t>(mesh.patch_count()));
  constexpr int grain = 64;
  parallel_for(mesh.patch_count(), grain, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) {
      // Media know the body behind its own surface.
      const int facet = mesh.facet[mesh.first_element[p]];
      const bool is_within_own = mesh.is_back[p] != 0 && walks_.body_of(facet) >= 0;
      of_patch_[static_cast<std::size_t>(p)] = is_within_own ? -1 : walks_.before(caster, p).body;
    }
  });
  of_facet_.assign(normal_.size(), {not_given, not_given});
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto p = static_cast<std::size_t>(mesh.patch[e]);
    note(mesh.facet[e], mesh.is_back[p] != 0, of_patch_[p]);
  }
}

void AbsorbingBodies::note(int facet, bool is_back, int body) {
  int& known = of_facet_[static_cast<std::size_t>(facet)][is_back ? 1 : 0];
  if (known == not_given) known = body;
  if (known != body) known = by_place;
}

std::shared_ptr<const AbsorbingBodies> AbsorbingBodies::find(const Scene& scene,
                                                             const ElementCaster& caster) {
  if (!MediumWalks(scene).absorbs()) return nullptr;
  const std::shared_ptr<const AbsorbingBodies> found(new AbsorbingBodies(scene, caster));
  for (int p = 0; p < caster.mesh().patch_count(); ++p) {
    if (found->before_patch(p)) return found;
  }
  return nullptr;
}

const Spectrum* AbsorbingBodies::before(const PatchMesh& mesh, const ElementHit& hit) const {
  if (hit.facet < 0 || (hit.from_back && walks_.body_of(hit.facet) >= 0)) return nullptr;
  if (hit.element >= 0) return before_patch(mesh.patch[hit.element]);
  // A pane within a body has the same body on both sides.
  const auto& sides = of_facet_[static_cast<std::size_t>(hit.facet)];
  const int body = sides[hit.from_back ? 1 : 0];
  return coefficient(body == not_given ? sides[0] : body);
}

const Spectrum* AbsorbingBodies::around(const ElementCaster& caster, const SurfacePoint& at) const {
  if (at.facet < 0) return coefficient(walks_.around(caster, at).body);
  const bool behind = is_behind(caster, at);
  const int own = walks_.body_of(at.facet);
  if (behind && own >= 0) return coefficient(own);
  const int body = of_facet_[static_cast<std::size_t>(at.facet)][behind ? 1 : 0];
  return coefficient(body > by_place ? body : walks_.around(caster, at).body);
}

bool AbsorbingBodies::is_behind(const ElementCaster& caster, const SurfacePoint& at) const {
  const Eigen::Isometry3d* pose = caster.pose_of(at.facet);
  const RoundShape* shape = round_.of(at.facet);
  Eigen::Vector3d normal = normal_[static_cast<std::size_t>(at.facet)];
  if (shape) normal = front_normal(*shape, pose ? pose->inverse() * at.position : at.position);
  if (pose) normal = pose->linear() * normal;
  return normal.dot(at.normal) < 0.0;
}

}  // namespace lightwell
