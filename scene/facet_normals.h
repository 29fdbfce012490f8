#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// The normals of the smooth surfaces that facets stand for, where files give normals at vertices.
/// They decide how a surface is shaded, mirrors and refracts in pictures, and across which edges
/// light is smooth; where a surface is, what it hides and which side of it is lit stays the
/// facets'. Facets are numbered through the scene (see scene_facets). Keeps no reference to it.
class FacetNormals {
 public:
  explicit FacetNormals(const Scene& scene);

  /// Whether no surface has normals of its own.
  bool is_empty() const { return entries_.empty(); }
  /// Whether the surface of a facet has: its flat facets then are flat, as it says.
  bool is_given(int facet) const { return !entries_.empty() && entry(facet).is_given; }
  /// Unit normal at a point (metres) of a facet's plane, on the side of `normal`, the facet's own
  /// or its opposite, which it is where there is no other.
  Eigen::Vector3d at(int facet, const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const;

  /// How far the smooth surface lies above the facet's plane at a point, metres, >= 0, on the side
  /// of `normal`: the quadratic height that is 0 at the facet's corners and has the normals for
  /// slopes, h(p) = (c - p) . (n(c) + n(p)) / 2 from a corner c, and of what the corners say the
  /// least. Exact for spheres and cylinders, to the second order; 0 where a surface is flat or
  /// hollow, and for facets with holes.
  double height(int facet, const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const;

  /// Of all that decides the answers; 0 if is_empty().
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
  std::vector<Eigen::Vector3d> corners_{};  // of the boundaries of facets that have a map
  std::uint64_t hash_ = 0;
};

/// A direction on which light goes on at a facet whose `normal` is on the side it came from: as it
/// is, or mirrored at the facet's plane where a smooth normal has sent it to the wrong side.
Eigen::Vector3d on_its_side(const Eigen::Vector3d& direction, const Eigen::Vector3d& normal,
                            bool crosses);

}  // namespace lightwell
