#include "raytrace/layer_film.h"

#include <algorithm>
#include <limits>

namespace lightwell {

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

void LayerFilm::finish_row(int y, const Bands& bands, const Camera& camera, const CameraRays& rays,
                           const ElementCaster& caster) {
  bool has_centres = false;
  for (const auto& [layer, column, count] : placed_) {
    has_centres = has_centres || layer == Layer::depth || layer == Layer::patch;
    if (layer != Layer::luminance) continue;
    for (int x = 0; x < image_.width; ++x) {
      const Eigen::Index pixel = Eigen::Index{y} * image_.width + x;
      const Spectrum L = image_.radiance.row(pixel).transpose();
      image_.layers.values(pixel, column) = static_cast<float>(luminous(bands, L));
    }
  }
  if (has_centres) trace_centres(y, camera, rays, caster);
}

void LayerFilm::trace_centres(int y, const Camera& camera, const CameraRays& rays,
                              const ElementCaster& caster) {
  std::vector<Ray> view_rays(image_.width);
  for (int x = 0; x < image_.width; ++x) view_rays[x] = rays.ray(x + 0.5, y + 0.5);
  std::vector<ElementHit> hits(view_rays.size());
  caster.closest_elements(view_rays, hits);
  for (const auto& [layer, column, count] : placed_) {
    for (int x = 0; x < image_.width; ++x) {
      const ElementHit& hit = hits[x];
      float& value = image_.layers.values(Eigen::Index{y} * image_.width + x, column);
      if (layer == Layer::depth) {
        value = hit.facet < 0
                    ? std::numeric_limits<float>::infinity()
                    : static_cast<float>(hit.t * view_rays[x].direction.dot(camera.direction));
      } else if (layer == Layer::patch) {
        // A float holds patch numbers exactly up to 2^24.
        value = hit.element < 0 ? -1.0f : static_cast<float>(caster.mesh().patch[hit.element]);
      }
    }
  }
}

}  // namespace lightwell
