#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mesh/elements/element_tree.h"
#include "mesh/patches/patch_mesh.h"
#include "scene/rays/ray_caster.h"

namespace lightwell {

struct ElementHit {
  int facet = -1;    ///< scene-wide facet that was met; -1: the ray left the scene
  int element = -1;  ///< element on the side that was met; -1: nothing, or the black back of a
                     ///< one-sided surface
  bool from_back = false;  ///< the facet was met from behind (inside, for a sphere)
  double t = 0.0;          ///< distance in multiples of the ray's direction
  /// Weights of the element's corners, in the order of PatchMesh::corners; they sum to 1 (bilinear
  /// in quads).
  Eigen::Array4f weights = Eigen::Array4f::Zero();
};

/// Casts rays at the elements of a PatchMesh, so that a ray names its element and place at once;
/// spheres are the exact ones. Ray::origin_group and target_group are scene-wide facet numbers
/// here. Keeps a reference to the mesh. A copy is cheap, and shares what is large.
///
/// What moves is not moved: a ray is taken to where the body rests instead, and cast there at a
/// tree of the body's own, which is exact for turns too. Elements and places on them are thereby
/// those of the mesh, whenever they are met. A ray costs as many queries more as there are motions;
/// where nothing moves, none.
class ElementCaster {
 public:
  explicit ElementCaster(const PatchMesh& mesh);
  /// Of a scene whose mesh that is, with surfaces that move: all of one motion are one body. They
  /// rest until at() says when.
  ElementCaster(const PatchMesh& mesh, const Scene& scene);
  /// Of the mesh that the elements of `base` were split into, as `tree` says; null: of a mesh like
  /// the base's. Rays go through the base's elements, which are fewer, and nothing is built. Throws
  /// std::invalid_argument if `base` is itself of split elements, or has surfaces that move.
  ElementCaster(const PatchMesh& mesh, const ElementCaster& base,
                std::shared_ptr<const ElementTree> tree);

  /// The same at a time, s.
  ElementCaster at(double time) const;
  /// Whether anything does.
  bool moves() const { return bodies_ != nullptr; }
  /// From where a facet that moves rests to where it is; null: it stands still.
  const Eigen::Isometry3d* pose_of(int facet) const;

  void closest_hits(std::span<const Ray> rays, std::span<ElementHit> hits) const;
  /// The same without weights, for who only counts elements: a tenth quicker.
  void closest_elements(std::span<const Ray> rays, std::span<ElementHit> hits) const;
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const;
  /// As RayCaster::meets_first, of scene-wide facets that stand still.
  bool meets_first(int facet, int other, const Eigen::Vector3d& direction) const;
  /// Whether another surface that lies on an element of a facet's front hides it from the front, or
  /// from behind.
  bool is_hidden(int front_element, bool from_back) const {
    return ((*hidden_)[static_cast<std::size_t>(front_element)] & (from_back ? 2 : 1)) != 0;
  }
  /// How many of a patch's elements another surface that lies on them hides.
  int hidden_elements(int patch) const;
  const PatchMesh& mesh() const { return mesh_; }

 private:
  struct Part;    // what stands still, or a body
  struct Bodies;  // all that moves
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

/// What a ray would meet at a point of an element if nothing else were there: the point must lie in
/// the element, or on its sphere.
ElementHit point_on_element(const PatchMesh& mesh, const PatchPoint& point);

/// Value at a hit from values at vertices (vertices x bands).
Spectrum interpolate(const PatchMesh& mesh, const BandArray& vertex_values, const ElementHit& hit);

}  // namespace lightwell
