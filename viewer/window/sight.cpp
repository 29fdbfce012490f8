#include "viewer/window/sight.h"

#include "raytrace/camera_ray.h"

namespace lightwell {
namespace {

constexpr int max_layers = 16;

bool counts(const ElementHit& hit, const std::vector<ElementKind>& kinds,
            const SightOptions& options) {
  if (hit.element < 0) return false;
  const ElementKind kind = kinds[static_cast<std::size_t>(hit.element)];
  return kind == ElementKind::lit || (kind == ElementKind::glass && options.glass) ||
         (kind == ElementKind::unlit && options.unlit);
}

}  // namespace

std::vector<Seen> see(const ElementCaster& caster, const std::vector<ElementKind>& kinds,
                      std::span<const Ray> rays, const SightOptions& options) {
  std::vector<Seen> seen(rays.size());
  std::vector<Ray> open(rays.begin(), rays.end());
  std::vector<std::size_t> places(rays.size());
  for (std::size_t i = 0; i < places.size(); ++i) places[i] = i;
  for (int layer = 0; layer < max_layers && !open.empty(); ++layer) {
    std::vector<ElementHit> hits(open.size());
    caster.closest_hits(open, hits);
    std::size_t left = 0;
    for (std::size_t k = 0; k < open.size(); ++k) {
      if (hits[k].facet < 0) continue;
      Ray ray = open[k];
      Seen& place = seen[places[k]];
      place.distance += hits[k].t;
      ray.origin += hits[k].t * ray.direction;
      if (counts(hits[k], kinds, options)) {
        place.hit = hits[k];
        place.position = ray.origin;
        continue;
      }
      ray.t_max -= hits[k].t;
      ray.origin_group = hits[k].facet;
      open[left] = ray;
      places[left++] = places[k];
    }
    open.resize(left);
    places.resize(left);
  }
  return seen;
}

Seen see_through_pixel(const ElementCaster& caster, const std::vector<ElementKind>& kinds,
                       const Camera& camera, double x, double y, const SightOptions& options) {
  const Ray ray = CameraRays(camera).ray(x, y);
  return see(caster, kinds, {&ray, 1}, options).front();
}

}  // namespace lightwell
