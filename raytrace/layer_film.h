#pragma once

#include <vector>

#include "mesh/elements/element_caster.h"
#include "raytrace/camera_ray.h"
#include "raytrace/image.h"
#include "raytrace/layers.h"

namespace lightwell {

/// Fills Image::layers beside Image::radiance. Different pixels from any number of threads.
class LayerFilm {
 public:
  /// Makes the columns. `image` has its radiance's size already.
  LayerFilm(const std::vector<Layer>& layers, Image& image);

  /// The mean of a pixel's samples.
  void set_sampled(Eigen::Index pixel, const SampledLayers& mean);
  /// What a row's pixels show at their centres, and what follows from their radiance.
  void finish_row(int y, const Bands& bands, const Camera& camera, const CameraRays& rays,
                  const ElementCaster& caster);

 private:
  struct Placed {
    Layer layer;
    int column, count;  // of its channels
  };
  void trace_centres(int y, const Camera& camera, const CameraRays& rays,
                     const ElementCaster& caster);

  Image& image_;
  std::vector<Placed> placed_{};
};

}  // namespace lightwell
