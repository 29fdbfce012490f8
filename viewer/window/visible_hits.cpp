#include "viewer/window/visible_hits.h"

#include "raytrace/cameras/camera_ray.h"

namespace lightwell {
namespace {

constexpr int max_layers = 16;  ///< surfaces along a ray

bool counts(const ElementHit& hit, const std::vector<ElementKind>& kinds,
            const VisibleHitOptions& options) {
  if (hit.element < 0) return false;
  const ElementKind kind = kinds[static_cast<std::size_t>(hit.element)];
  return kind == ElementKind::lit || (kind == ElementKind::glass && options.glass) ||
         (kind == ElementKind::unlit && options.unlit);
}

}  // namespace

std::vector<VisibleHit> visible_hits(const ElementCaster& caster,
                                     const std::vector<ElementKind>& kinds,
                                     std::span<const Ray> rays, const VisibleHitOptions& options) {
  std::vector<VisibleHit> seen(rays.size());
  std::vector<Ray> open(rays.begin(), rays.end());
  std::vector<std::size_t> indices(rays.size());
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = i;
  for (int layer = 0; layer < max_layers && !open.empty(); ++layer) {
    std::vector<ElementHit> hits(open.size());
    caster.closest_hits(open, hits);
    std::size_t left = 0;
    for (std::size_t k = 0; k < open.size(); ++k) {
      if (hits[k].facet < 0) continue;
      Ray ray = open[k];
      VisibleHit& found = seen[indices[k]];
      found.distance += hits[k].t;
      ray.origin += hits[k].t * ray.direction;
      if (counts(hits[k], kinds, options)) {
        found.hit = hits[k];
        found.position = ray.origin;
        continue;
      }
      ray.t_max -= hits[k].t;
      ray.origin_group = hits[k].facet;
      open[left] = ray;
      indices[left++] = indices[k];
    }
    open.resize(left);
    indices.resize(left);
  }
  return seen;
}

VisibleHit visible_hit_at_pixel(const ElementCaster& caster, const std::vector<ElementKind>& kinds,
                                const Camera& camera, double x, double y,
                                const VisibleHitOptions& options) {
  const Ray ray = CameraRays(camera).ray(x, y);
  return visible_hits(caster, kinds, {&ray, 1}, options).front();
}

}  // namespace lightwell
