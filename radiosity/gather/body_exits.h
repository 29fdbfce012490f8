#pragma once

#include <optional>
#include <vector>

#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/gather/final_gather.h"

namespace lightwell {

/// The way out of a body from a covered vertex (see BodyExits) to another corner of an element.
struct BodyExit {
  int vertex = -1;       ///< covered
  int towards = -1;      ///< the other corner, outside
  GatherPoint point{};   ///< on the round shape just outside, `vertex` being its key
  GatherPoint middle{};  ///< half-way from the other corner to the point, with the same key
  /// Share of the way from the other corner to the vertex that lies outside, (0, 1].
  double share = 1.0;
};

/// The vertices of round shapes that lie within other bodies beside vertices outside, such as those
/// of a ball that is sunk into a table, and their ways out. Elements of round shapes are not cut
/// where they enter a body, so an element that is partly covered is seen, and the dark of its
/// covered corners would be interpolated into a dark rim.
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
  explicit BodyExits(const LitScene& lit);

  /// The exit of each covered vertex that is nearest to the vertex, in rising order of vertices.
  const std::vector<BodyExit>& all() const { return all_; }
  /// True if the body that covers a corner of an element also covers a point of the element. False
  /// if no corner is covered.
  bool covers(const PatchPoint& point) const;

 private:
  struct Way;
  std::vector<Way> ways_from(int vertex, int facet) const;
  std::vector<char> find_backs(const std::vector<int>& vertices,
                               const std::vector<GatherPoint>& points) const;
  bool is_back(const ElementHit& hit) const;
  bool meets_back(const Ray& ray) const;
  std::optional<BodyExit> nearest_exit(int vertex, const GatherPoint& point) const;
  std::optional<GatherPoint> exit_along(const Way& way, const GatherPoint& from) const;
  Eigen::Vector3d place_above(const GatherPoint& point, double height) const;
  bool is_apart(const GatherPoint& covered, const Eigen::Vector3d& place) const;

  const ElementCaster& caster_;
  bool has_sky_;
  std::vector<char> is_clear_{};  // per facet; empty without round shapes
  std::vector<BodyExit> all_{};
};

/// Gives covered vertices the values of the corners that their exits lead to, so that rays which
/// meet the elements outside read no dark. `values` are vertices x columns.
void copy_from_outside(const std::vector<BodyExit>& exits, BandArray& values);

/// Gives covered vertices the light whose interpolation along the way outside has the least squared
/// error. The way's other corner has E_b, gathers at the exit and half-way to it find E_X and E_M,
/// and the share of the way outside is s. The slope of the line from E_b that is nearest to the
/// light E is 3/s^3 times the integral of t (E - E_b) over t in [0, s], by Simpson's rule
///
///     E = max(0, E_b + (E_M - E_b + (E_X - E_b) / 2) / max(s, 1/2))
///
/// at the vertex. With s below 1/2 the line would be drawn on by more than what was found, and the
/// vertex serves other elements as well.
///
/// `radiosity` is what rays read, W/m^2, vertices x columns. `found` has direct and indirect light,
/// W/m^2, vertices x columns, and the variance of indirect light at all vertices. Throws
/// Interrupted when progress says stop.
void light_covered_vertices(const LitScene& lit, const std::vector<BodyExit>& exits,
                            const BandArray& radiosity, const GatherOptions& options,
                            GatheredIrradiance& found);

}  // namespace lightwell
