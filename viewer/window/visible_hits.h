#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "viewer/export/appearance.h"

namespace lightwell {

/// Kinds of elements that a ray of sight can hit. A ray passes through the backs of surfaces, which
/// are not drawn.
struct VisibleHitOptions {
  bool glass = false;  ///< hit glass; else pass through
  bool unlit = true;   ///< hit surfaces without light; else pass through
};

/// The hit of a ray of sight.
struct VisibleHit {
  ElementHit hit{};                                    ///< element < 0: nothing
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  double distance = 0.0;                               ///< in lengths of the ray's direction

  explicit operator bool() const { return hit.element >= 0; }
};

/// Returns for each ray the first drawn element, among the first 16 surfaces along the ray.
std::vector<VisibleHit> visible_hits(const ElementCaster& caster,
                                     const std::vector<ElementKind>& kinds,
                                     std::span<const Ray> rays,
                                     const VisibleHitOptions& options = {});

/// Returns the hit through the point (x, y) of a camera's picture, pixels from the left and from
/// the top. Throws InputError as CameraRays does.
VisibleHit visible_hit_at_pixel(const ElementCaster& caster, const std::vector<ElementKind>& kinds,
                                const Camera& camera, double x, double y,
                                const VisibleHitOptions& options = {});

}  // namespace lightwell
