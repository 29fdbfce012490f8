#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/form_factors/hemicube_cells.h"

namespace lightwell {

/// Position and orientation of a hemicube.
struct HemicubeEye {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  /// Columns: two edges of the top, and the unit normal.
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
  int element = -1;     ///< element under the eye; -1: in free space
  int facet = -1;       ///< facet of that element, invisible from the eye unless `inside`
  bool inside = false;  ///< eye on the inside of a round shape, which sees its own facet
};

/// Hemicube of a patch. The eye stands
///   - at the area centroid if that lies on the patch;
///   - otherwise (an L, a ring) at the centre of the nearest element;
///   - on a round shape, on the exact shape, except inside one with `on_elements`: there flat
///   elements
///     would lie in front of the exact shape.
///
/// The frame is turned about the normal by a random angle that depends on the patch alone, so that
/// parallel edges throughout a scene do not alias alike on every patch.
HemicubeEye hemicube_eye(const PatchMesh& mesh, int patch, bool on_elements);

/// Item of a cell: an element on the side that faces the eye, nothing, or the black back of a
/// one-sided surface.
namespace hemicube_item {
inline constexpr int nothing = -1;
inline constexpr int black_back(int facet) {
  return -2 - facet;
}
/// Facet of an item; -1 for nothing.
inline int facet(const PatchMesh& mesh, int item) {
  return item >= 0 ? mesh.facet[item] : item == nothing ? -1 : -2 - item;
}
}  // namespace hemicube_item

/// Casts one ray through the centre of each cell, with exact round shapes. Writes
/// cells.cell_count() items.
void cast_hemicube(const ElementCaster& caster, const HemicubeEye& eye, const HemicubeCells& cells,
                   std::span<int> items);

/// Scan conversion of a mesh's elements into the cells of hemicubes: a depth buffer with items.
/// Round shapes are drawn as their elements, flat polygons with corners on the shape.
///
/// A polygon covers a cell if the cell's centre lies in the pyramid from the eye over the polygon.
/// The test, in three dimensions and in double precision, projects no vertex, so polygons that
/// reach below the horizon, behind a face or around the hemicube's corners are clipped exactly.
/// Both polygons at a shared edge test the edge with the same number: every cell belongs to exactly
/// one of them (Olano & Greer 1997, "Triangle scan conversion using 2D homogeneous coordinates").
/// The inverse distance is affine along a row.
class HemicubeScan {
 public:
  /// Keeps a reference to the caster, which resolves surfaces that lie on each other.
  explicit HemicubeScan(const ElementCaster& caster);

  /// Memory reused from call to call by one thread.
  struct Scratch {
    std::vector<Eigen::Vector3d> vertex{};  // vertices in the hemicube's frame
    // One bit per bounding plane beyond which the vertex lies.
    std::vector<std::uint16_t> outside{};
    std::vector<float> inverse_distance{};  // in multiples of HemicubeCells::direction
  };
  /// Draws the view from `eye`. Writes cells.cell_count() items.
  void draw(const HemicubeEye& eye, const HemicubeCells& cells, Scratch& scratch,
            std::span<int> items) const;

 private:
  struct Polygon {
    std::array<int, 4> vertex{};  // [3] = [2] in a triangle
    int corner_count = 3;
    int element = -1;                                  // element of the front
    int behind = -1;                                   // item seen from behind
    bool front_hidden = false, back_hidden = false;    // hidden by a surface on it
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // unit; vertices counter-clockwise about it
  };
  /// Neighbouring polygons of one facet, rejected together.
  struct Group {
    int first_polygon = 0, last_polygon = 0;
    int first_vertex = 0, last_vertex = 0;
    int facet = -1;
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    double radius = 0.0;
  };
  class Painter;
  void add_runs_of_facets(int first_element, int last_element);
  void add_facet_elements(int first_element, int last_element);

  const ElementCaster& caster_;
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Polygon> polygons_;
  std::vector<Group> groups_;
  double coplanar_ = 0.0;  // m; the eye lies in planes nearer than this
};

}  // namespace lightwell
