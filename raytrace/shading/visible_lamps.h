#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "radiosity/emitters/direct_light.h"
#include "scene/rays/ray_caster.h"
#include "scene/scene.h"

namespace lightwell {

/// The openings of luminaires as an eye sees them. Lamps are no surfaces: rays of the first pass do
/// not meet them, and their light is direct light. In a picture the opening of a lamp is a flat
/// face of even luminance, I over its area projected towards the eye, from either side, as for
/// UGR. An opening that sends no light towards the eye is not seen.
class VisibleLamps {
 public:
  /// The lamps of a scene that are `visible` and have an opening with an area, as bright as in
  /// `direct_light`. Keeps a reference to the scene.
  VisibleLamps(const Scene& scene, const DirectLight& direct_light);

  bool empty() const { return lamp_.empty(); }

  struct Seen {
    int lamp = 0;         ///< index into Scene::lamps
    Spectrum radiance{};  ///< towards the ray's origin, W/(m^2 sr)
  };
  /// The first opening along a ray before `end`, m, the distance of the first surface: an opening
  /// in the plane of that surface is seen (see way_before_opening). The ray's direction has unit
  /// length.
  std::optional<Seen> first(const Ray& ray, double end) const;

 private:
  const Scene& scene_;
  std::vector<Spectrum> intensity_{};  ///< W/sr for relative_intensity() 1, per lamp of the scene
  std::vector<int> lamp_{};            ///< lamp of each group of caster_
  std::unique_ptr<const RayCaster> caster_{};  ///< null: no lamp is visible
};

}  // namespace lightwell
