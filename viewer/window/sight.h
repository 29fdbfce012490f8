#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "viewer/export/appearance.h"

namespace lightwell {

/// Which of the elements that face the eye count; the backs of surfaces never do, since they are
/// not drawn.
struct SightOptions {
  bool glass = false;  ///< else it is looked through
  bool unlit = true;   ///< else what gets no light is looked through
};

/// What a ray met.
struct Seen {
  ElementHit hit{};  ///< element < 0: nothing
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double distance = 0.0;  ///< in multiples of the ray's direction

  explicit operator bool() const { return hit.element >= 0; }
};

/// The first element along each ray that a window draws, as deep as 16 layers of what it does not.
std::vector<Seen> see(const ElementCaster& caster, const std::vector<ElementKind>& kinds,
                      std::span<const Ray> rays, const SightOptions& options = {});

/// Through a place of the picture, pixels from the left and from the top.
Seen see_through_pixel(const ElementCaster& caster, const std::vector<ElementKind>& kinds,
                       const Camera& camera, double x, double y, const SightOptions& options = {});

}  // namespace lightwell
