#include "radiosity/visibility/clear_panes.h"

#include <Eigen/Geometry>
#include <optional>

#include "scene/facet_textures.h"
#include "scene/specular.h"

namespace lightwell {

ClearPanes::ClearPanes(const Scene& scene) : bands_(scene.bands.count()) {
  for (const FacetRef& ref : scene_facets(scene)) {
    const Surface& surface = scene.surfaces[static_cast<std::size_t>(ref.surface)];
    const Material& material = scene.materials[static_cast<std::size_t>(surface.material)];
    of_facet_.push_back(is_clear_pane(material) ? static_cast<int>(panes_.size()) : -1);
    if (of_facet_.back() < 0) continue;
    Pane pane{.material = material, .round = round_shape(surface)};
    if (!pane.round) {
      const auto& polygons = std::get<PolygonMesh>(surface.shape);
      const auto facet = static_cast<std::size_t>(ref.facet);
      pane.normal = facet_normal(polygons, polygons.facets[facet]);
    }
    panes_.push_back(std::move(pane));
  }
}

Spectrum ClearPanes::passed(const ElementCaster& caster, const Ray& first) const {
  Spectrum share = Spectrum::Ones(bands_);
  const Eigen::Vector3d direction = first.direction.normalized();
  Polarisation polarisation;
  Ray ray = first;
  constexpr int most_panes = 64;  // the transmittance of so many is negligible
  for (int i = 0; i < most_panes; ++i) {
    ElementHit hit;
    caster.closest_elements({&ray, 1}, {&hit, 1});
    if (hit.facet < 0 || hit.facet == first.target_group) return share;
    const int number = of_facet_[static_cast<std::size_t>(hit.facet)];
    if (number < 0) break;
    const Pane& pane = panes_[static_cast<std::size_t>(number)];
    const Eigen::Vector3d point = ray.origin + hit.t * ray.direction;
    Eigen::Vector3d normal = pane.normal;
    const Eigen::Isometry3d* pose = caster.pose_of(hit.facet);
    if (pane.round) normal = front_normal(*pane.round, pose ? pose->inverse() * point : point);
    if (pose) normal = pose->linear() * normal;
    if (normal.dot(direction) > 0.0) normal = -normal;
    const FacetTextures* textures = caster.mesh().textures.get();
    std::optional<Material> here;
    if (textures && textures->has_pattern(hit.facet)) {
      here = textures->material(hit.facet, pose ? Eigen::Vector3d(pose->inverse() * point) : point);
    }
    const SmoothScattering lobes = smooth_scattering({.material = here ? *here : pane.material,
                                                      .direction = direction,
                                                      .normal = normal,
                                                      .from_back = hit.from_back,
                                                      .polarisation = polarisation});
    if (lobes.count < 2) break;
    share *= lobes.sample[1].weight;
    polarisation = lobes.sample[1].polarisation;
    ray.origin = point;
    ray.t_max -= hit.t;
    ray.origin_group = hit.facet;
  }
  return Spectrum::Zero(bands_);
}

}  // namespace lightwell
