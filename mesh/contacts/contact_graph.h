#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "mesh/contacts/contact_effort.h"
#include "mesh/contacts/line_selection.h"
#include "mesh/discontinuity/crease_selection.h"
#include "mesh/geometry/facet_plane.h"
#include "mesh/geometry/patch_sizes.h"
#include "scene/progress.h"

namespace lightwell {

/// The lines that a facet's triangulation has to contain, as indices into ContactGraph::points().
struct FacetOutline {
  std::vector<std::vector<int>> loops{};       ///< boundary, then holes, divided into pieces
  std::vector<std::array<int, 2>> contacts{};  ///< pieces of contact lines inside the facet
  std::vector<std::array<int, 2>> creases{};   ///< pieces of other critical lines: D1 and D2
  /// True if a loop crosses, overlaps or repeats itself, or a hole leaves the boundary.
  bool crosses_itself = false;

  bool has_lines() const { return !contacts.empty() || !creases.empty(); }
};

/// All boundary edges, contact lines and gap_lines() of a scene, cut wherever one meets another and
/// divided into pieces of element size. A line that several facets share is cut once for all of
/// them, so the mesh conforms across facets.
class ContactGraph {
 public:
  /// Keeps references to `planes` and `sizes`. `points` must hold the planes' corners. The mesh is
  /// cut along `critical` lines too, as far as these add no more than about `most_elements`
  /// elements.
  ///
  /// Facets keep only their longest contact lines where there are more contacts than ContactEffort
  /// allows, or where contact lines cross in more than 4000 places and in more than three per
  /// element (see lacks_contacts()).
  ContactGraph(const Scene& scene, const std::vector<FacetPlane>& planes, WeldedPoints points,
               const PatchSizes& sizes, const std::vector<CriticalLine>& critical,
               double most_elements, const Progress& progress);

  const std::vector<Eigen::Vector3d>& points() const { return points_; }
  /// The outline of the facet of planes[index].
  FacetOutline outline(int index) const;
  const CreaseCounts& crease_counts() const { return crease_counts_; }
  /// True if too many others touch or cross the facet of planes[index] to keep all contact lines.
  bool lacks_contacts(int index) const { return lacks_contacts_[index] != 0; }

 private:
  class Search;
  /// A boundary edge, a contact line or a crease.
  struct Segment {
    int a = 0, b = 0;                 ///< points, a < b
    int triangle_apex[2] = {-1, -1};  ///< third corners of triangles that have this edge
  };
  /// A part of a segment between two neighbouring cuts.
  struct Atom {
    int a = 0, b = 0;  ///< points, a < b
    int pieces = 1;
    int first_division = 0;      ///< the pieces - 1 points between a and b, in order
    std::vector<double> cuts{};  ///< parameters of these points; empty: at even distances
  };

  int segment(int a, int b);
  void add_boundaries();
  void add_contacts(const Scene& scene, const Progress& progress);
  void add_contact(int index, const std::array<Eigen::Vector3d, 2>& ends);
  /// Adds the contacts of all facets; false if the effort is exceeded.
  bool add_all_contacts(const Search& search, ContactEffort& effort, const Progress& progress);
  /// Adds the longest contacts of each facet with its largest neighbours.
  void add_longest_contacts(const Search& search, const ContactEffort& effort,
                            const Progress& progress);
  void thin_out_contacts(int corners);
  void remove_contacts(int corners);
  std::vector<FlatLine> contact_lines(int index) const;
  void add_gap_lines();
  void sort_contacts();
  void add_creases(const std::vector<CriticalLine>& critical, double most_elements);
  std::vector<FixedPiece> fixed_pieces(int index) const;
  /// The points along a segment: a, the cuts in order, b.
  std::vector<int> chain(int segment) const;
  void cut_at_crossings();
  struct Crossing;
  /// The crossings of a segment with those of the others that have larger numbers.
  std::vector<Crossing> crossings_of(int segment, const std::vector<int>& others) const;
  /// All crossings; not all if the effort is exceeded.
  std::vector<std::vector<Crossing>> all_crossings(ContactEffort& effort) const;
  std::vector<std::vector<Crossing>> crossings_within_facets() const;
  void cut_at_points();
  void make_atoms();
  void size_atoms();
  void count_pieces();
  void divide();
  std::vector<int> atoms_of_boundary(int index) const;
  std::vector<int> contact_atoms(int index) const;
  std::vector<int> crease_atoms(int index) const;
  std::vector<int> atoms_of(const std::vector<int>& segments) const;

  const std::vector<FacetPlane>& planes_;
  const PatchSizes& sizes_;
  WeldedPoints welded_;
  std::vector<Segment> segments_;
  std::unordered_map<std::uint64_t, int> segment_of_ends_;
  std::vector<int> first_edge_;    ///< per plane, index of its first edge in edge_segment_
  std::vector<int> edge_segment_;  ///< segment of every boundary edge of every plane
  /// Per plane, ascending, unique; contact lines, and lines where narrow gaps begin.
  std::vector<std::vector<int>> contact_segments_;
  std::vector<char> lacks_contacts_;               ///< per plane
  std::vector<std::vector<int>> crease_segments_;  ///< per plane, ascending, unique
  CreaseCounts crease_counts_{};
  std::vector<std::vector<std::pair<double, int>>> cuts_;  ///< per segment: (parameter, point)
  std::vector<Atom> atoms_;
  std::vector<std::vector<int>> atoms_of_segment_;  ///< in order from a to b
  std::vector<Eigen::Vector3d> points_;
};

}  // namespace lightwell
