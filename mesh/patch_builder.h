#pragma once

#include "mesh/facets/facet_mesh.h"
#include "mesh/facets/group_facets.h"
#include "mesh/patches/patch_mesh.h"
#include "mesh/patches/round_grid.h"
#include "scene/disjoint_sets.h"
#include "scene/facet_normals.h"

namespace lightwell {

/// Joins the meshes of all facets and round shapes into one PatchMesh, in the order in which these
/// are added (ascending facet numbers): shares vertices across smooth edges, joins the patches of
/// small facets, and adds the back sides. Keeps a reference to the scene.
class PatchBuilder {
 public:
  PatchBuilder(const Scene& scene, double smooth_angle_degrees, const FacetGroupOptions& groups)
      : scene_(scene),
        normals_(scene),
        smooth_angle_degrees_(smooth_angle_degrees),
        groups_(groups) {}

  /// Adds the front of a facet; `normal` is its unit normal.
  void add_facet(int facet, int surface, const Eigen::Vector3d& normal, FacetMesh mesh);
  /// Adds the front of a round shape.
  void add_round(int facet, int surface, const RoundShape& shape, RoundElements elements);
  /// Returns the mesh; the builder is empty afterwards.
  PatchMesh finish();

 private:
  struct Piece {  // the front of one facet; its vertices are numbered from `first_vertex`
    int facet = 0, surface = 0;
    int first_vertex = 0;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    FacetMesh mesh{};
    std::vector<char> at_reflex_corner{};  ///< per vertex; empty: none
    int round = -1;                        ///< index into grids_ and round_area_; -1: a polygon
  };
  /// One of a piece's patches, before they are joined.
  struct Part {
    int piece = 0, patch = 0;
  };
  /// A border edge of a piece by its points; `forward`: the piece passes the edge from `low` to
  /// `high`.
  struct Side {
    int low = 0, high = 0;
    int v_low = 0, v_high = 0;  ///< vertices there
    int piece = 0;
    bool forward = true;
  };
  std::vector<Side> border_sides() const;
  void share_smooth_edges(const std::vector<Side>& sides);
  Eigen::Vector3d normal_at(int piece, int vertex) const;
  FacetPatch facet_patch(const Part& part) const;
  /// Parts that share an edge at which nothing else stands. `first_part` is per piece its first
  /// part.
  std::vector<FacetPatchContact> part_contacts(const std::vector<int>& first_part,
                                               const std::vector<Side>& sides) const;
  /// Per piece, the patches whose first part lies in the piece; a patch is a list of parts.
  std::vector<std::vector<std::vector<Part>>> patches_of_pieces(
      const std::vector<Side>& sides) const;
  void emit_patch(const std::vector<Part>& parts, bool is_back, std::vector<int>& number,
                  PatchMesh& out, std::vector<Eigen::Vector3d>& positions);
  bool has_back(const Material& material) const;

  const Scene& scene_;
  FacetNormals normals_;
  double smooth_angle_degrees_;
  FacetGroupOptions groups_;
  std::vector<Piece> pieces_;
  std::vector<RoundGrid> grids_;
  std::vector<std::vector<double>> round_area_;
  DisjointSets shared_;  ///< front vertices; those of a set become one
  std::vector<double> element_area_, patch_area_;
};

}  // namespace lightwell
