#include "raytrace/seen_places.h"

#include <algorithm>

#include "scene/parallel.h"
#include "scene/sampling.h"
#include "scene/specular.h"

namespace lightwell {

SeenPlaces::SeenPlaces(const LitScene& lit, const Camera& camera, const CameraRays& rays,
                       int max_depth)
    : lit_(lit),
      camera_(camera),
      rays_(rays),
      paths_(lit.scene, lit.caster, max_depth),
      normals_(lit.scene),
      facets_(lit.scene, lit.mesh(), normals_) {
  constexpr double most_places = 65536.0;
  const double pixels = static_cast<double>(camera.width) * camera.height;
  while (pixels / (finest_ * finest_) > most_places) ++finest_;
}

std::vector<std::optional<SeenPlace>> SeenPlaces::on_grid(int step) const {
  const int across = step * finest_;
  std::vector<Eigen::Vector2i> points;
  for (int y = across / 2; y < camera_.height; y += across) {
    for (int x = across / 2; x < camera_.width; x += across) points.emplace_back(x, y);
  }
  std::vector<std::optional<SeenPlace>> places(points.size());
  constexpr int grain = 16;
  parallel_for(static_cast<int>(points.size()), grain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const Eigen::Vector2i& at = points[k];
      places[k] = place_at(at.x() + 0.5, at.y() + 0.5);
      if (!places[k]) continue;
      places[k]->key =
          random_key(static_cast<std::uint64_t>(at.x()), static_cast<std::uint64_t>(at.y()));
    }
  });
  return places;
}

std::optional<SeenPlace> SeenPlaces::place_at(double x, double y) const {
  const int panel = rays_.panel_at(x, y);
  auto ray = rays_.ray_at(x, y, panel);
  const PixelCone cone = rays_.cone(x, y, panel);
  double width = cone.start;
  constexpr int most_surfaces = 8;
  for (int i = 0; ray && i < most_surfaces; ++i) {
    ElementHit hit;
    lit_.caster.closest_hits({&*ray, 1}, {&hit, 1});
    if (hit.facet < 0) return std::nullopt;
    width += cone.spread * hit.t * ray->direction.norm();
    if (paths_.is_diffuse(hit.facet)) {
      if (hit.element < 0) return std::nullopt;
      return place_of(*ray, hit, width);
    }
    ray = onward(*ray, hit);
  }
  return std::nullopt;
}

// The ray that a smooth surface sends most light to.
std::optional<Ray> SeenPlaces::onward(const Ray& ray, const ElementHit& hit) const {
  const Material& material =
      lit_.scene.materials[static_cast<std::size_t>(facets_[hit.facet].material)];
  if (!material.is_specular() || material.gloss_roughness() > 0.0f) return std::nullopt;
  const Eigen::Vector3d point = ray.origin + hit.t * ray.direction;
  const SmoothScattering lobes =
      smooth_scattering({.material = material,
                         .direction = ray.direction.normalized(),
                         .normal = facets_.normal_against(ray.direction, hit.facet, point),
                         .from_back = hit.from_back});
  if (lobes.count == 0) return std::nullopt;
  const auto brightest = std::max_element(
      lobes.sample.begin(), lobes.sample.begin() + lobes.count,
      [](const auto& a, const auto& b) { return a.weight.mean() < b.weight.mean(); });
  return Ray{.origin = point, .direction = brightest->direction, .origin_group = hit.facet};
}

SeenPlace SeenPlaces::place_of(const Ray& ray, const ElementHit& hit, double width) const {
  const Eigen::Vector3d point = ray.origin + hit.t * ray.direction;
  const Eigen::Vector3d normal = facets_.normal_against(ray.direction, hit.facet, point);
  constexpr double grazing = 0.1;  // cosine; neighbours at a smaller one are far apart
  const double cosine = std::max(grazing, -normal.dot(ray.direction.normalized()));
  return {.at = {.position = point,
                 .normal = normal,
                 .smooth_normal = facets_.smooth_normal(lit_.mesh(), normals_, hit, point, normal),
                 .facet = hit.facet},
          .element = hit.element,
          .spacing = finest_ * width / cosine};
}

}  // namespace lightwell
