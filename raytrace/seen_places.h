#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/paths/light_path.h"
#include "raytrace/cameras/camera_ray.h"
#include "raytrace/shading/facet_shapes.h"
#include "raytrace/shading/pixel_gather.h"
#include "scene/facet_normals.h"
#include "scene/scene.h"

namespace lightwell {

/// A place of a diffuse surface that a picture shows.
struct SeenPlace {
  ShadingPoint at{};
  int element = -1;
  double spacing = 0.0;   ///< m, distance on the surface between neighbours of the narrowest grid
  std::uint64_t key = 0;  ///< of the point of the picture, for random numbers
};

/// The places that a picture shows at the points of regular grids, also by way of smooth mirrors
/// and glass, of which the brighter branch is followed.
class SeenPlaces {
 public:
  /// Keeps references. The narrowest grid has one point for each pixel, or 65536 points at most.
  SeenPlaces(const LitScene& lit, const Camera& camera, const CameraRays& rays, int max_depth);

  /// Places at the points of a grid whose points are `step` times as far apart as those of the
  /// narrowest one; no place where the picture shows no diffuse surface.
  std::vector<std::optional<SeenPlace>> on_grid(int step) const;

 private:
  std::optional<SeenPlace> place_at(double x, double y) const;
  std::optional<Ray> onward(const Ray& ray, const ElementHit& hit) const;
  SeenPlace place_of(const Ray& ray, const ElementHit& hit, double width) const;

  LitScene lit_;
  const Camera& camera_;
  const CameraRays& rays_;
  LightPaths paths_;
  FacetNormals normals_;
  FacetShapes facets_;
  int finest_ = 1;  // step of the narrowest grid, pixels
};

}  // namespace lightwell
