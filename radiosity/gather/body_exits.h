#pragma once

#include <optional>
#include <vector>

#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/gather/final_gather.h"

namespace lightwell {

/// Gather points of vertices of round shapes that lie within other bodies, such as those of a ball
/// that is sunk into a table. Elements of round shapes are not cut where they enter a body, so an
/// element that is partly covered is seen, and the dark of its covered corners would be
/// interpolated into a dark rim. The light just outside the body is gathered for them instead.
///
/// A vertex is covered if
/// - the straight way to another corner of one of its elements first meets the back of an opaque
///   surface, as from within a body;
/// - diffuse paths from the vertex do not come to places that see the way out: a sheet covers
///   nothing, and what is behind it is lit by the same room.
///
/// Bodies need not be closed where they stand on others. Without a sky, the space behind the floor
/// of a room is a body, too. Keeps references to the parts of `lit`.
class BodyExits {
 public:
  /// The way from a vertex to another corner of one of its elements.
  struct Way {
    int patch = 0;  ///< of the element
    Eigen::Vector3d to = Eigen::Vector3d::Zero();
  };

  explicit BodyExits(const LitScene& lit);
  /// The point on the same round shape just outside the body, where the ways from a `vertex` of the
  /// caster's mesh to other corners leave the body first; `point`, the gather point of the vertex,
  /// if it is not covered.
  GatherPoint outside(int vertex, const GatherPoint& point) const;
  /// True if a body covers a point of an element on a round shape, as it covers vertices.
  bool covers(const PatchPoint& point) const;

 private:
  bool is_cover(const ElementHit& hit) const;
  std::optional<GatherPoint> nearest_exit(const std::vector<Way>& ways,
                                          const GatherPoint& point) const;
  std::optional<GatherPoint> exit_along(const Way& way, const GatherPoint& from,
                                        ElementHit hit) const;
  Eigen::Vector3d place_above(const GatherPoint& point, double height) const;
  bool is_apart(const GatherPoint& covered, const Eigen::Vector3d& place) const;

  const ElementCaster& caster_;
  bool has_sky_;
  std::vector<char> is_clear_{};  // per facet; empty without round shapes
};

}  // namespace lightwell
