#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "scene/scene.h"
#include "scene/surface_point.h"

namespace lightwell {

/// The clear bodies around a place.
struct Medium {
  float index = 1.0f;  ///< of refraction, relative to the air around all bodies
  int body = -1;       ///< material of the innermost body; -1: none
  auto operator<=>(const Medium&) const = default;
};

/// Finds the clear bodies that places lie in, by walks: straight on through clear bodies, and on in
/// a random direction where something opaque is met before a clear body. A surface that a walk
/// leaves without having entered bounds a body around the place; the indices of bodies within
/// bodies multiply. The result of most walks counts, since rays pass between the polygons of
/// imperfect models.
class MediumWalks {
 public:
  explicit MediumWalks(const Scene& scene);

  /// True if a body has an index other than 1.
  bool bends() const { return bends_; }
  /// True if a body absorbs.
  bool absorbs() const { return absorbs_; }
  /// True for facets of panes and bodies.
  bool passes(int facet) const { return passes_[static_cast<std::size_t>(facet)] != 0; }
  /// Material of the body that a facet bounds; -1: it bounds none.
  int body_of(int facet) const;

  /// The medium in front of a patch.
  Medium before(const ElementCaster& caster, int patch) const;
  /// The medium around a point, on the side of its normal.
  Medium around(const ElementCaster& caster, const SurfacePoint& at) const;

 private:
  std::optional<Medium> walk(const ElementCaster& caster, Ray ray, std::uint64_t key) const;
  void cross(std::size_t facet, bool from_back, int& entered, std::optional<Medium>& medium) const;

  std::vector<float> index_;   // per facet: of the body that it bounds; 0: it bounds none
  std::vector<char> passes_;   // per facet: 1 for panes and bodies
  std::vector<int> material_;  // per facet
  bool bends_ = false, absorbs_ = false;
};

}  // namespace lightwell
