#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/visibility/medium_walks.h"
#include "scene/round_shape.h"
#include "scene/scene.h"
#include "scene/surface_point.h"

namespace lightwell {

/// Clear bodies that absorb and that surfaces lie within: water around a diver, glass around a
/// filament. Light between two places of one body crosses no surface of the body, so Media do not
/// know the body. The surface that the light arrives at does: exp(-a d) is left after d metres.
///
/// MediumWalks find the body in front of each patch once. A patch that reaches out of a body counts
/// as a whole by most of its walks; points on such facets, and points in free space, take walks of
/// their own.
class AbsorbingBodies {
 public:
  /// Null if no patch lies within a body that absorbs.
  static std::shared_ptr<const AbsorbingBodies> find(const Scene& scene,
                                                     const ElementCaster& caster);

  /// Absorption coefficient per band, 1/m, of the body before a hit of light that has crossed no
  /// surface; null: none absorbs. Null also for the surface of a body met from within, since
  /// Media::passed() counts that.
  const Spectrum* before(const PatchMesh& mesh, const ElementHit& hit) const;
  /// That in front of a patch.
  const Spectrum* before_patch(int patch) const {
    return coefficient(of_patch_[static_cast<std::size_t>(patch)]);
  }
  /// That around a point, on the side of its normal.
  const Spectrum* around(const ElementCaster& caster, const SurfacePoint& at) const;

 private:
  // In place of the body on a side of a facet: not every patch there has the same, or there is
  // none.
  static constexpr int by_place = -2, not_given = -3;

  AbsorbingBodies(const Scene& scene, const ElementCaster& caster);
  void note(int facet, bool is_back, int body);
  const Spectrum* coefficient(int body) const {
    const auto m = static_cast<std::size_t>(std::max(body, 0));
    return body < 0 || !(absorption_[m] > 0.0f).any() ? nullptr : &absorption_[m];
  }
  const Spectrum* walked(const ElementCaster& caster, const SurfacePoint& at) const;
  bool is_behind(const ElementCaster& caster, const SurfacePoint& at) const;

  MediumWalks walks_;
  std::optional<Eigen::AlignedBox3d> box_;    // that the bodies lie in; nothing: not known
  std::vector<Spectrum> absorption_;          // per material; 0 where it is no body
  std::vector<int> of_patch_;                 // material of the body; -1: none
  std::vector<std::array<int, 2>> of_facet_;  // the same on the front and the back
  std::vector<Eigen::Vector3d> normal_;       // per facet; zero for round shapes
  RoundShapes round_;
};

/// exp(-a d), per band.
inline Spectrum left_after(const Spectrum& absorption, double distance) {
  return (-static_cast<float>(distance) * absorption).exp();
}

}  // namespace lightwell
