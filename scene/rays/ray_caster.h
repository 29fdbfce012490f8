#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "scene/round_shape.h"

namespace lightwell {

/// Geometry of a RayCaster. Primitives are numbered triangles first, then quads, then round
/// shapes.
///
/// A *group* joins primitives that cannot see each other because they lie in one plane (a facet),
/// or are one round shape. A ray never meets the group it starts from, whatever rounding does to
/// the ray's origin. Where groups lie on each other, the group that is met first hides the others.
struct CastGeometry {
  std::vector<Eigen::Vector3d> vertices{};
  std::vector<std::array<int, 3>> triangles{};
  std::vector<std::array<int, 4>> quads{};  ///< planar, convex, in order around
  std::vector<RoundShape> round_shapes{};
  std::vector<int> group{};  ///< group of each primitive, >= 0
  /// True if rays pass through a point of a group that has holes. Called from many threads.
  std::function<bool(int group, const Eigen::Vector3d& point)> is_hole{};
  std::vector<char> has_holes{};  ///< per triangle, then quad: 1 if is_hole applies; empty: none
};

/// Ray from `origin` to the distance t_max.
struct Ray {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction =
      Eigen::Vector3d::UnitZ();  ///< any length > 0; distances t are in multiples of the length
  double t_max = std::numeric_limits<double>::infinity();
  int origin_group = -1;  ///< group the ray starts on (a ray inside a round shape still meets its
                          ///< far side)
  int target_group = -1;  ///< for occluded(): group that does not count as an occluder
};

/// First primitive on a ray, and the place met.
struct Hit {
  int primitive = -1;  ///< -1: nothing was hit
  int group = -1;      ///< of the primitive
  double t = std::numeric_limits<double>::infinity();
  /// Position on the primitive. Triangle (v0,v1,v2): weights (1-u-v, u, v). Quad (v0..v3):
  /// bilinear, u along v0-v1, v along v0-v3. Round shape: 0.
  float u = 0.0f, v = 0.0f;
  bool from_back = false;  ///< the ray met the clockwise side, or a round shape's back
};

/// Answers batches of rays by Embree, which no other room includes. Immutable once built, and safe
/// to use from many threads. Coordinates are recentred before the conversion to float, so a room
/// far from the origin loses no digits.
///
/// Triangles and quads are watertight along shared edges (Embree's robust mode). Of rays aimed at a
/// vertex itself, to the last float digit, one in 1e4 slips through. Small quads in even rows and
/// columns of a group are cast as one. Round shapes are intersected in double precision.
class RayCaster {
 public:
  /// Throws std::invalid_argument if `group` does not match the primitives, std::runtime_error if
  /// Embree fails.
  explicit RayCaster(const CastGeometry& geometry);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;

  /// Sets hits[i] to the closest hit of rays[i] in (0, t_max).
  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits) const;

  /// Sets blocked[i] to 1 if anything but the origin's and the target's group lies in (0, t_max) of
  /// rays[i], else to 0.
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const;

  /// True if a ray in `direction` meets `group` before `other`, of two groups that lie on each
  /// other.
  bool meets_first(int group, int other, const Eigen::Vector3d& direction) const;

  /// True if another surface that lies on a triangle or quad hides the front or the back of
  /// `primitive`.
  bool is_hidden(int primitive, bool from_back) const;

  int triangle_count() const;
  int quad_count() const;
  int round_count() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lightwell
