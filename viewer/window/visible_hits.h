#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "viewer/export/appearance.h"

namespace lightwell {

/// Which of the elements that face the eye count; the backs of surfaces never do, since they are
/// not drawn.
struct VisibleHitOptions {
  bool glass = false;  ///< else it is looked through
  bool unlit = true;   ///< else what gets no light is looked through
};

/// What a ray met.
struct VisibleHit {
  ElementHit hit{};  ///< element < 0: nothing
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double distance = 0.0;  ///< in multiples of the ray's direction

  explicit operator bool() const { return hit.element >= 0; }
};

/// The first element along each ray that a window draws, as deep as 16 layers of what it does not.
std::vector<VisibleHit> visible_hits(const ElementCaster& caster,
                                     const std::vector<ElementKind>& kinds,
                                     std::span<const Ray> rays,
                                     const VisibleHitOptions& options = {});

/// Through a place of the picture, pixels from the left and from the top.
VisibleHit visible_hit_at_pixel(const ElementCaster& caster, const std::vector<ElementKind>& kinds,
                                const Camera& camera, double x, double y,
                                const VisibleHitOptions& options = {});

}  // namespace lightwell
