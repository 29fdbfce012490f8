#include "raytrace/layer_film.h"

#include <algorithm>
#include <limits>

namespace lightwell {
namespace {

// Share of points of a pixel that show something.
float coverage(const CameraRays& rays, int x, int y) {
  constexpr int points = 8;  // along an edge
  const int panel = rays.panel_at(x + 0.5, y + 0.5);
  int seen = 0;
  for (int j = 0; j < points; ++j) {
    for (int i = 0; i < points; ++i) {
      seen += rays.ray_at(x + (i + 0.5) / points, y + (j + 0.5) / points, panel) ? 1 : 0;
    }
  }
  return static_cast<float>(seen) / (points * points);
}

// Replaces the hit of a ray by a luminaire before it: a hit on no element.
void show_lamp(const VisibleLamps& lamps, const Ray& ray, ElementHit& hit) {
  if (lamps.empty()) return;
  const double length = ray.direction.norm();
  Ray unit = ray;
  unit.direction /= length;
  const double end = hit.facet < 0 ? std::numeric_limits<double>::infinity() : hit.t * length;
  const auto seen = lamps.first(unit, end);
  if (!seen) return;
  hit = {};
  hit.facet = 0;
  hit.t = static_cast<decltype(hit.t)>(seen->t / length);
}

}  // namespace

LayerFilm::LayerFilm(const std::vector<Layer>& layers, Image& image) : image_(image) {
  LayerColumns& columns = image.layers;
  columns = {};
  for (const NamedLayer& known : named_layers) {
    if (std::find(layers.begin(), layers.end(), known.layer) == layers.end()) continue;
    const std::vector<std::string> names = channel_names(known.layer);
    placed_.push_back(
        {known.layer, static_cast<int>(columns.names.size()), static_cast<int>(names.size())});
    columns.names.insert(columns.names.end(), names.begin(), names.end());
  }
  if (columns.names.empty()) return;
  columns.values.setZero(image.radiance.rows(), static_cast<Eigen::Index>(columns.names.size()));
}

void LayerFilm::set_sampled(Eigen::Index pixel, const SampledLayers& mean) {
  for (const auto& [layer, column, count] : placed_) {
    const int first = first_sampled_column(layer);
    if (first < 0) continue;
    image_.layers.values.row(pixel).segment(column, count) = mean.segment(first, count).transpose();
  }
}

void LayerFilm::finish_row(int y, const Bands& bands, const CameraRays& rays,
                           const ElementCaster& caster, const VisibleLamps& lamps) {
  bool has_centres = false;
  for (const auto& [layer, column, count] : placed_) {
    has_centres = has_centres || layer == Layer::depth || layer == Layer::patch;
    if (layer == Layer::coverage) {
      for (int x = 0; x < image_.width; ++x) {
        image_.layers.values(Eigen::Index{y} * image_.width + x, column) = coverage(rays, x, y);
      }
    }
    if (layer != Layer::luminance) continue;
    for (int x = 0; x < image_.width; ++x) {
      const Eigen::Index pixel = Eigen::Index{y} * image_.width + x;
      const Spectrum L = image_.radiance.row(pixel).transpose();
      image_.layers.values(pixel, column) = static_cast<float>(luminous(bands, L));
    }
  }
  if (has_centres) trace_centres(y, rays, caster, lamps);
}

void LayerFilm::trace_centres(int y, const CameraRays& rays, const ElementCaster& caster,
                              const VisibleLamps& lamps) {
  std::vector<Ray> view_rays;
  std::vector<int> columns;  // of the rays: those that show something
  for (int x = 0; x < image_.width; ++x) {
    const auto ray = rays.ray_at(x + 0.5, y + 0.5);
    if (!ray) continue;
    view_rays.push_back(*ray);
    columns.push_back(x);
  }
  std::vector<ElementHit> hits(view_rays.size());
  caster.closest_elements(view_rays, hits);
  for (std::size_t i = 0; i < hits.size(); ++i) show_lamp(lamps, view_rays[i], hits[i]);
  for (const auto& [layer, column, count] : placed_) {
    if (layer != Layer::depth && layer != Layer::patch) continue;
    const Eigen::Index first = Eigen::Index{y} * image_.width;
    const float nothing = layer == Layer::depth ? std::numeric_limits<float>::infinity() : -1.0f;
    image_.layers.values.col(column).segment(first, image_.width).setConstant(nothing);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const ElementHit& hit = hits[i];
      float& value = image_.layers.values(first + columns[i], column);
      if (layer == Layer::depth && hit.facet >= 0) {
        const Ray& ray = view_rays[i];
        value = static_cast<float>(rays.depth(ray.origin + hit.t * ray.direction));
      } else if (layer == Layer::patch && hit.element >= 0) {
        // A float holds patch numbers exactly up to 2^24.
        value = static_cast<float>(caster.mesh().patch[hit.element]);
      }
    }
  }
}

}  // namespace lightwell
