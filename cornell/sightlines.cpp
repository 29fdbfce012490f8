#include "cornell/sightlines.h"

#include "scene/optics.h"
#include "scene/round_shape.h"

namespace lightwell {
namespace {

constexpr int most_bounces = 12;

}  // namespace

Sightlines::Sightlines(const Scene& scene, const ElementCaster& caster)
    : scene_(scene), caster_(caster), facets_(scene_facets(scene)) {}

int Sightlines::surface_ahead(const Ray& ray) const {
  ElementHit hit;
  caster_.closest_hits({&ray, 1}, {&hit, 1});
  return hit.facet < 0 ? -1 : facets_[hit.facet].surface;
}

void Sightlines::trace(const Ray& ray, double least_weight,
                       const std::function<void(const TracedPoint&)>& show) const {
  follow(ray, 1.0, 0, least_weight, show);
}

void Sightlines::follow(const Ray& ray, double weight, int bounces, double least_weight,
                        const std::function<void(const TracedPoint&)>& show) const {
  if (weight < least_weight || bounces > most_bounces) return;
  ElementHit hit;
  caster_.closest_hits({&ray, 1}, {&hit, 1});
  if (hit.facet < 0) return;
  const FacetRef at = facets_[hit.facet];
  const Surface& surface = scene_.surfaces[at.surface];
  const Material& material = scene_.materials[surface.material];
  const Eigen::Vector3d position = ray.origin + hit.t * ray.direction;
  if (!material.is_specular() || material.coat) {
    show({at.surface, hit.facet, position, weight, bounces});
    return;
  }
  Eigen::Vector3d normal;
  if (const auto shape = round_shape(surface)) {
    normal = front_normal(*shape, position);
  } else {
    const auto& mesh = std::get<PolygonMesh>(surface.shape);
    normal = facet_normal(mesh, mesh.facets[at.facet]);
  }
  if (hit.from_back) normal = -normal;
  const Eigen::Vector3d direction = ray.direction.normalized();
  const auto onwards = [&](const Eigen::Vector3d& towards, double share) {
    follow({.origin = position, .direction = towards, .origin_group = hit.facet}, weight * share,
           bounces + 1, least_weight, show);
  };
  if (!material.dielectric) {
    onwards(reflect(direction, normal), material.specular.maxCoeff());
    return;
  }
  const double outside_to_inside = material.dielectric->index_of_refraction;
  const double index = hit.from_back ? 1.0 / outside_to_inside : outside_to_inside;
  const double reflected = fresnel_reflectance(-direction.dot(normal), index);
  onwards(reflect(direction, normal), reflected);
  if (const auto refracted = refract(direction, normal, index)) {
    onwards(*refracted, (1.0 - reflected) * material.dielectric->tint.maxCoeff());
  }
}

}  // namespace lightwell
