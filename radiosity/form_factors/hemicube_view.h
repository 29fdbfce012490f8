#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/form_factors/hemicube_cells.h"

namespace lightwell {

/// Where a hemicube stands.
struct HemicubeEye {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  /// Columns: two edges of the top, and the unit normal.
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
  int element = -1;     ///< it stands on; -1: free in space
  int facet = -1;       ///< of that element; not seen from itself ...
  bool inside = false;  ///< ... but from inside a sphere
};

/// The hemicube's place on a patch: the area centroid, or, where that is not on the patch (an L, a
/// ring), the centre of the element nearest to it. On a sphere it is on the exact sphere, but for
/// the inside when `on_elements`: flat elements would lie in front of that place. Turned about the
/// normal by a random angle that depends on the patch alone, so that edges that run alike all over
/// a scene do not meet every patch's cells alike.
HemicubeEye hemicube_eye(const PatchMesh& mesh, int patch, bool on_elements);

/// What a cell sees: an element on the side that faces the eye, nothing, or the black back of a
/// one-sided surface.
namespace hemicube_item {
inline constexpr int nothing = -1;
inline constexpr int black_back(int facet) {
  return -2 - facet;
}
/// -1 where nothing is seen.
inline int facet(const PatchMesh& mesh, int item) {
  return item >= 0 ? mesh.facet[item] : item == nothing ? -1 : -2 - item;
}
}  // namespace hemicube_item

/// One ray through the centre of each cell; spheres are the exact ones. Writes
/// cells.cell_count() items.
void cast_hemicube(const ElementCaster& caster, const HemicubeEye& eye, const HemicubeCells& cells,
                   std::span<int> items);

/// Scan conversion of a mesh's elements into the cells of hemicubes: a depth buffer that keeps
/// items. Spheres are drawn by their elements, flat polygons inscribed in the sphere.
///
/// A polygon covers a cell if the cell's centre lies in the pyramid over it. That test, in three
/// dimensions and in double precision, needs no vertex to be projected, so polygons that reach
/// below the horizon, behind a face or around the hemicube's corners are cut exactly. Polygons that
/// share an edge decide it by the same number: no cell falls between them, none belongs to both
/// (Olano & Greer 1997, "Triangle scan conversion using 2D homogeneous coordinates"). Along a row
/// the inverse distance is affine.
class HemicubeScan {
 public:
  /// Keeps a reference to the caster, which knows what lies on what.
  explicit HemicubeScan(const ElementCaster& caster);

  /// Reused from call to call by one thread.
  struct Scratch {
    std::vector<Eigen::Vector3d> vertex{};  // in the hemicube's frame
    std::vector<std::uint16_t> outside{};   // a bit per bounding plane the vertex is beyond
    std::vector<float> inverse_distance{};  // in multiples of HemicubeCells::direction
  };
  /// Writes cells.cell_count() items.
  void draw(const HemicubeEye& eye, const HemicubeCells& cells, Scratch& scratch,
            std::span<int> items) const;

 private:
  struct Polygon {
    std::array<int, 4> vertex{};  // [3] = [2] in a triangle
    int corner_count = 3;
    int element = -1;                                  // on the front
    int behind = -1;                                   // item that is seen from behind
    bool front_hidden = false, back_hidden = false;    // by what lies on it
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // unit; counter-clockwise from there
  };
  /// Polygons of one facet near each other, rejected together.
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
  double coplanar_ = 0.0;  // metres: a plane nearer than this is the eye's own
};

}  // namespace lightwell
