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
  /// Facets of one surface share patches up to `curve_angle_degrees`, see FacetGroupOptions.
  PatchBuilder(const Scene& scene, double smooth_angle_degrees, double curve_angle_degrees)
      : scene_(scene),
        normals_(scene),
        smooth_angle_degrees_(smooth_angle_degrees),
        curve_angle_degrees_(curve_angle_degrees) {}

  /// Adds the front of a facet of the plane. Small facets of one `patch_size` (metres) share
  /// patches.
  void add_facet(const FacetPlane& plane, double patch_size, FacetMesh mesh);
  /// Adds the front of a round shape.
  void add_round(int facet, int surface, double patch_size, const RoundShape& shape,
                 RoundElements elements);
  /// Returns the mesh; the builder is empty afterwards.
  PatchMesh finish();

 private:
  struct Piece {  // the front of one facet; its vertices are numbered from `first_vertex`
    int facet = 0, surface = 0;
    int first_vertex = 0;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    double patch_size = 1.0;  ///< metres
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
  void add_piece(Piece piece);
  Eigen::Vector3d normal_at(int piece, int vertex) const;
  FacetPatch facet_patch(const Part& part) const;
  /// Parts that share an edge at which nothing else stands. `first_part` is per piece its first
  /// part.
  std::vector<FacetPatchContact> part_contacts(const std::vector<int>& first_part,
                                               const std::vector<Side>& sides) const;
  /// Per part, a part of its group, the same for all of a group.
  std::vector<int> groups_of(const std::vector<Part>& parts, const std::vector<int>& first_part,
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
  double curve_angle_degrees_;
  std::vector<Piece> pieces_;
  std::vector<RoundGrid> grids_;
  std::vector<std::vector<double>> round_area_;
  DisjointSets shared_;  ///< front vertices; those of a set become one
  std::vector<double> element_area_, patch_area_;
};

}  // namespace lightwell
