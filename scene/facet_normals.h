#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// Normals of the smooth surfaces that facets approximate, where files give normals at vertices.
/// Normals decide how a surface is shaded, mirrors and refracts in pictures, and across which edges
/// light is smooth. Position, visibility and the lit side remain those of the facets. Facets are
/// numbered through the scene (see scene_facets). Keeps no reference to the scene.
class FacetNormals {
 public:
  explicit FacetNormals(const Scene& scene);

  /// True if no surface has normals of its own.
  bool is_empty() const { return entries_.empty(); }
  /// True if the facet's surface has normals of its own; facets of such a surface without a normal
  /// map are flat.
  bool is_given(int facet) const { return !entries_.empty() && entry(facet).is_given; }
  /// Unit normal at `point` (metres) in a facet's plane, on the side of `normal`, which is the
  /// facet's own normal or its opposite. Returns `normal` where the facet has no other.
  Eigen::Vector3d at(int facet, const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const;

  /// Height of the smooth surface above the facet's plane at `point`, metres, >= 0, on the side of
  /// `normal`: h(p) = min over corners c of (c - p) . (n(c) + n(p)) / 2, with normals n scaled to
  /// length 1 along `normal`. The quadratic height is 0 at the facet's corners and has the normals
  /// for slopes. Exact to the second order for spheres and cylinders; 0 where a surface is flat or
  /// hollow, and for facets with holes.
  double height(int facet, const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const;

  /// Hash of all that decides the normals; 0 if is_empty().
  std::uint64_t hash() const { return hash_; }

 private:
  struct Entry {
    int map = -1;  // into maps_
    bool is_given = false;
    int first_corner = 0, corners = 0;
  };
  const Entry& entry(int facet) const { return entries_[static_cast<std::size_t>(facet)]; }

  std::vector<NormalMap> maps_{};
  std::vector<Entry> entries_{};            // by facet; empty: nowhere
  std::vector<Eigen::Vector3d> corners_{};  // boundaries of facets with a map and without holes
  std::uint64_t hash_ = 0;
};

/// `direction` in which light continues at a facet whose `normal` is on the side that the light
/// came from. The direction is mirrored at the facet's plane if a smooth normal has turned it to
/// the wrong side; otherwise unchanged. `crosses`: the light passes through the surface.
Eigen::Vector3d on_its_side(const Eigen::Vector3d& direction, const Eigen::Vector3d& normal,
                            bool crosses);

}  // namespace lightwell
