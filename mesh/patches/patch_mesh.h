#pragma once

#include <Eigen/Core>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "scene/round_shape.h"
#include "scene/scene.h"

namespace lightwell {

class FacetTextures;
class PatchPatterns;

struct ElementMeshTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
/// A half-edge mesh: a face is an element, a vertex is a point at which radiosity is reconstructed.
using HalfedgeMesh = OpenMesh::PolyMesh_ArrayKernelT<ElementMeshTraits>;

/// A HalfedgeMesh that is moved without a copy, unlike OpenMesh's own; the mesh moved from is
/// empty.
class MovableHalfedgeMesh {
 public:
  MovableHalfedgeMesh() : mesh_(std::make_unique<HalfedgeMesh>()) {}
  MovableHalfedgeMesh(const MovableHalfedgeMesh& other)
      : mesh_(std::make_unique<HalfedgeMesh>(*other.mesh_)) {}
  MovableHalfedgeMesh(MovableHalfedgeMesh&& other) : MovableHalfedgeMesh() {
    mesh_.swap(other.mesh_);
  }
  MovableHalfedgeMesh& operator=(MovableHalfedgeMesh other) noexcept {
    mesh_.swap(other.mesh_);
    return *this;
  }
  ~MovableHalfedgeMesh() = default;

  HalfedgeMesh* operator->() { return mesh_.get(); }
  const HalfedgeMesh* operator->() const { return mesh_.get(); }
  HalfedgeMesh& operator*() { return *mesh_; }
  const HalfedgeMesh& operator*() const { return *mesh_; }

 private:
  std::unique_ptr<HalfedgeMesh> mesh_;
};

/// The elements of the front of a round shape (and their twins on its back), for finding the
/// element at a point of the exact shape. Rings run from the north, ring 0, to the south, evenly
/// along the shape; sectors are even in longitude, eastwards counter-clockwise as seen from the
/// front.
/// - Of a sphere, the north is at +z, and sector 0 starts at longitude 0 (+x), turning towards +y.
/// - Of a frustum, the north is the top, and sector 0 starts as longitudes() says.
struct RoundGrid {
  int facet = 0;  ///< scene-wide facet number of the shape
  RoundShape shape{};
  int rings = 0, sectors = 0;
  std::vector<int> element{};  ///< front element of (ring, sector) at ring * sectors + sector
};

/// Surfaces cut into *patches*, the sources of energy and unknowns of the solver, and patches cut
/// into *elements*, which receive light and carry its gradient (Cohen, Greenberg, Immel & Brock
/// 1986). A patch lies in one facet, or, where facets are small against it, reaches over many
/// facets that face nearly alike. Each quantity has an array of its own.
///
/// The mesh conforms: no vertex lies inside the edge of another element, except along lines in
/// which something much finer than an element crosses the inside of a facet.
///
/// Vertices are shared only where radiosity is continuous:
/// - within one side of one facet, except across contact lines (D0) and at reflex corners, where
///   each element has a vertex of its own; D1 and D2 lines do not part vertices;
/// - across facets of one surface whose normals (those at vertices where the surface has such, see
///   FacetNormals) differ by less than MeshOptions::smooth_angle_degrees (build_patches.h).
struct PatchMesh {
  MovableHalfedgeMesh elements{};

  // Per element. The elements of patch i are first_element[i] .. first_element[i+1] - 1.
  std::vector<int> patch{};
  std::vector<int> facet{};  ///< scene-wide facet number (see scene_facets)
  /// Vertices, counter-clockwise seen from the side that the element faces; [3] is -1 for a
  /// triangle. The same faces as those of `elements`, in a flat array for inner loops.
  std::vector<std::array<int, 4>> corners{};
  /// Area, m^2, > 0; exact on round shapes; without the holes that textures cut.
  Eigen::ArrayXd element_area{};
  /// The element on the other side of the same place; -1: the other side is black.
  std::vector<int> twin{};

  // Per vertex.
  std::vector<Eigen::Vector3d> vertex_normal{};  ///< unit, on the side its elements face
  /// 1 for a vertex at a reflex corner, where each element has its own. Empty for a mesh from a
  /// file.
  std::vector<char> at_reflex_corner{};

  // Per patch.
  std::vector<int> first_element{};  ///< patch_count + 1 entries
  Eigen::ArrayXd area{};             ///< A_i, m^2, > 0
  /// Reflectance rho_i, patches x bands; the mean over the patch where a texture varies.
  BandArray reflectance{};
  /// Diffuse transmittance tau_i, patches x bands: light that arrives behind the patch leaves it.
  /// Empty if nothing is translucent.
  BandArray transmittance{};
  std::vector<int> behind{};    ///< see patch_behind(); empty if nothing is translucent
  BandArray emission{};         ///< M_i, W/m^2, patches x bands
  std::vector<int> surface{};   ///< index into Scene::surfaces
  std::vector<int> material{};  ///< index into Scene::materials
  std::vector<char> is_back{};  ///< 1: the patch faces away from its facets' fronts

  /// Factors of the power of free sources (see free_source_count()), as relight() leaves them:
  /// sources x bands. Empty: all 1.
  BandArray source_scale{};

  /// Distance from the border of an element, metres, below which rays do not tell its two sides.
  double least_inset = 0.0;

  std::vector<RoundGrid> round_grids{};
  /// The textures of the scene; rays pass through their holes. Null: nothing varies over facets.
  std::shared_ptr<const FacetTextures> textures{};
  /// Shares of light that patches with patterns mirror and pass. Null: no facet has a pattern.
  std::shared_ptr<const PatchPatterns> patterns{};
  std::vector<std::string> notes{};  ///< what meshing had to leave out, a sentence each

  int patch_count() const { return static_cast<int>(area.size()); }
  int element_count() const { return static_cast<int>(patch.size()); }
  int vertex_count() const { return static_cast<int>(vertex_normal.size()); }
  /// The facet that holds all of patch p; -1 for a patch over several facets, which is not flat.
  int facet_of(int p) const {
    const int first = facet[first_element[p]];
    for (int e = first_element[p] + 1; e < first_element[p + 1]; ++e) {
      if (facet[e] != first) return -1;
    }
    return first;
  }
  /// The patch whose irradiance passes through a sheet to patch p; -1: none.
  int patch_behind(int p) const {
    return behind.empty() ? -1 : behind[static_cast<std::size_t>(p)];
  }
  int corner_count(int element) const { return corners[element][3] < 0 ? 3 : 4; }
  Eigen::Vector3d position(int vertex) const {
    const auto& p = elements->point(HalfedgeMesh::VertexHandle(vertex));
    return {p[0], p[1], p[2]};
  }
};

/// A point of a patch.
struct PatchPoint {
  int element = -1;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, towards the side the patch faces
};

/// The mean of the element's corners (on round shapes moved to the exact shape), with the unit
/// normal there.
PatchPoint element_center(const PatchMesh& mesh, int element);

/// A patch that each vertex belongs to. A vertex belongs to several patches only where patches meet
/// smoothly.
std::vector<int> vertex_patches(const PatchMesh& mesh);

/// An element of each vertex in which its light is gathered; -1: no element has the vertex. The
/// first one is taken, unless its area is less than a 64th of another's: a point inside such an
/// element may lie nearer to its border than single precision tells.
std::vector<int> vertex_elements(const PatchMesh& mesh);

/// Rebuilds `elements` from `positions` (metres) and `corners`, and vertex normals from faces
/// (weighted by area; exact on round shapes): completes a PatchMesh read from a file. Throws
/// std::runtime_error if an element names a vertex that does not exist or does not fit its
/// neighbours.
void build_topology(PatchMesh& mesh, const std::vector<Eigen::Vector3d>& positions);

}  // namespace lightwell
