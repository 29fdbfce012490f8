#pragma once

#include <vector>

#include "mesh/elements/element_caster.h"
#include "raytrace/cameras/camera_ray.h"
#include "raytrace/pictures/image.h"
#include "raytrace/pictures/layers.h"
#include "raytrace/shading/visible_lamps.h"

namespace lightwell {

/// Writer of Image::layers. Any number of threads may set different pixels.
class LayerFilm {
 public:
  /// Makes the columns of `layers` in `image`, whose radiance must have its size already.
  LayerFilm(const std::vector<Layer>& layers, Image& image);

  /// Sets the sampled layers of a pixel to the mean of its samples.
  void set_sampled(Eigen::Index pixel, const SampledLayers& mean);
  /// Fills the remaining layers of row y: depth and patch at the pixels' centres (a
  /// luminaire has a depth and no patch), and luminance
  /// from radiance.
  void finish_row(int y, const Bands& bands, const CameraRays& rays, const ElementCaster& caster,
                  const VisibleLamps& lamps);

 private:
  struct Placed {
    Layer layer;
    int column, count;  // first of the layer's columns in LayerColumns, and their number
  };
  void trace_centres(int y, const CameraRays& rays, const ElementCaster& caster,
                     const VisibleLamps& lamps);

  Image& image_;
  std::vector<Placed> placed_{};
};

}  // namespace lightwell
