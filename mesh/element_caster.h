#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/patch_mesh.h"
#include "scene/ray_caster.h"

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
/// here. Keeps a reference to the mesh.
class ElementCaster {
 public:
  explicit ElementCaster(const PatchMesh& mesh);

  void closest_hits(std::span<const Ray> rays, std::span<ElementHit> hits) const;
  /// The same without weights, for who only counts elements: a tenth quicker.
  void closest_elements(std::span<const Ray> rays, std::span<ElementHit> hits) const;
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const {
    caster_.occluded(rays, blocked);
  }
  /// As RayCaster::meets_first, of scene-wide facets.
  bool meets_first(int facet, int other, const Eigen::Vector3d& direction) const {
    return caster_.meets_first(facet, other, direction);
  }
  /// Whether another surface that lies on an element of a facet's front hides it from the front, or
  /// from behind.
  bool is_hidden(int front_element, bool from_back) const {
    return (hidden_[static_cast<std::size_t>(front_element)] & (from_back ? 2 : 1)) != 0;
  }
  /// How many of a patch's elements another surface that lies on them hides.
  int hidden_elements(int patch) const;
  const PatchMesh& mesh() const { return mesh_; }

 private:
  /// v2 - v0 = alpha (v1 - v0) + beta (v3 - v0); both 1 in a parallelogram.
  struct QuadShape {
    float alpha = 1.0f, beta = 1.0f;
  };
  static CastGeometry cast_geometry(const PatchMesh& mesh, std::vector<int>& elements,
                                    std::vector<QuadShape>& quad_shapes);
  template <bool with_weights>
  void cast(std::span<const Ray> rays, std::span<ElementHit> hits) const;
  template <bool with_weights>
  ElementHit element_hit(const Ray& ray, const Hit& hit) const;

  const PatchMesh& mesh_;
  /// Of RayCaster's primitives, on their front; of a sphere, the index of its grid.
  std::vector<int> elements_;
  std::vector<QuadShape> quad_shapes_;
  RayCaster caster_;
  int triangles_ = 0, polygons_ = 0;  // the first of the primitives
  std::vector<std::uint8_t> hidden_;  // per element, a bit per side
};

/// Value at a hit from values at vertices (vertices x bands).
Spectrum interpolate(const PatchMesh& mesh, const BandArray& vertex_values, const ElementHit& hit);

}  // namespace lightwell
