#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "scene/rays/ray_caster.h"

namespace lightwell {

struct ElementTree;

/// First element on a ray, and the place met.
struct ElementHit {
  int facet = -1;  ///< scene-wide number of the facet met; -1: the ray left the scene
  /// Element on the side met; -1: nothing, or the black back of a one-sided surface.
  int element = -1;
  bool from_back = false;  ///< true if the facet was met from behind (inside, for a sphere)
  double t = 0.0;          ///< distance, in lengths of the ray's direction
  /// Weights of the element's corners, in the order of PatchMesh::corners; they sum to 1 and are
  /// bilinear in quadrilaterals.
  Eigen::Array4f weights = Eigen::Array4f::Zero();
};

/// The hit on the other side of a sheet, at the same place. Precondition: the element has a twin.
ElementHit hit_behind(const PatchMesh& mesh, const ElementHit& hit);

/// Casts rays at the elements of a PatchMesh and at exact round shapes, and returns the element and
/// place that each ray meets. Ray::origin_group and target_group are scene-wide facet numbers here.
/// Keeps a reference to the mesh. A copy is cheap: large data are shared.
///
/// Moving surfaces stay at rest in the mesh. For each moving body a ray is transformed to the
/// body's rest pose and cast at a tree of the body's own, which is exact for rotations too.
/// Elements and places on them are thus those of the mesh at any time. Each motion costs one more
/// query per ray.
class ElementCaster {
 public:
  explicit ElementCaster(const PatchMesh& mesh);
  /// A caster for `mesh` of `scene`, with surfaces that move: all surfaces of one motion are one
  /// body. Bodies are at rest until at() sets the time.
  ElementCaster(const PatchMesh& mesh, const Scene& scene);
  /// A caster for the mesh into which the elements of `base` were split, as `tree` describes (null:
  /// for a mesh with the elements of the base). Rays are cast at the base's elements, which are
  /// fewer, and nothing is built. Throws std::invalid_argument if `base` itself has split elements
  /// or surfaces that move.
  ElementCaster(const PatchMesh& mesh, const ElementCaster& base,
                std::shared_ptr<const ElementTree> tree);

  /// A caster with the bodies at their places at `time`, seconds.
  ElementCaster at(double time) const;
  /// True if the scene has surfaces that move.
  bool moves() const { return bodies_ != nullptr; }
  /// The motion of a moving facet from its rest pose to its place; null for a facet that stands
  /// still.
  const Eigen::Isometry3d* pose_of(int facet) const;

  /// Writes the first hit of each ray to `hits`, which has the length of `rays`.
  void closest_hits(std::span<const Ray> rays, std::span<ElementHit> hits) const;
  /// Writes the first hits without weights, which takes a tenth less time.
  void closest_elements(std::span<const Ray> rays, std::span<ElementHit> hits) const;
  /// Sets blocked[i] to 1 if something lies in the way of ray i, else to 0.
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const;
  /// RayCaster::meets_first() for scene-wide facets that stand still.
  bool meets_first(int facet, int other, const Eigen::Vector3d& direction) const;
  /// True if another surface that lies on an element of a facet's front hides the element from the
  /// front, or (`from_back`) from behind.
  bool is_hidden(int front_element, bool from_back) const {
    return ((*hidden_)[static_cast<std::size_t>(front_element)] & (from_back ? 2 : 1)) != 0;
  }
  /// Number of a patch's elements that are hidden by another surface that lies on them.
  int hidden_elements(int patch) const;
  const PatchMesh& mesh() const { return mesh_; }

 private:
  struct Part;    // everything that stands still, or one body
  struct Bodies;  // all moving bodies
  struct Pose {
    Eigen::Isometry3d forth = Eigen::Isometry3d::Identity(), back = Eigen::Isometry3d::Identity();
  };
  template <bool with_weights>
  void cast(std::span<const Ray> rays, std::span<ElementHit> hits) const;
  template <bool with_weights>
  void cast_at_bodies(std::span<const Ray> rays, std::span<ElementHit> hits) const;
  Ray ray_for(int body, const Ray& ray) const;
  void find_hidden();

  const PatchMesh& mesh_;
  std::shared_ptr<const Part> still_;
  std::shared_ptr<const ElementTree> tree_{};                  // null: elements are the primitives
  std::shared_ptr<const Bodies> bodies_{};                     // null: nothing moves
  std::vector<Pose> poses_{};                                  // of each body
  std::shared_ptr<const std::vector<std::uint8_t>> hidden_{};  // per element, a bit per side
};

/// The hit of a ray at a point of an element if nothing else were there. The point must lie in the
/// element, or on its round shape.
ElementHit point_on_element(const PatchMesh& mesh, const PatchPoint& point);

/// The value at a hit, interpolated from values at vertices (vertices x bands); 0 if nothing was
/// met.
Spectrum interpolate(const PatchMesh& mesh, const BandArray& vertex_values, const ElementHit& hit);

}  // namespace lightwell
