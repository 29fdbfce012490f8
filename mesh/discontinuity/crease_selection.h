#pragma once

#include <array>
#include <map>
#include <vector>

#include "mesh/discontinuity/critical_lines.h"

namespace lightwell {

/// A piece of a line that the triangulation of a facet already contains: part of the facet's
/// boundary or of a contact line.
struct FixedPiece {
  int a = 0, b = 0;  ///< the end points, in any numbering
  Eigen::Vector3d from, to;
  int segment = 0;  ///< number of the whole line, equal in all facets that share the line
};

struct CreaseOptions {
  double element_size = 1.0;   ///< metres
  double tolerance = 0.0;      ///< metres; nearer points are joined
  double most_elements = 0.0;  ///< approximate limit on the elements that creases add
};

/// Counts of critical lines by outcome.
struct CreaseCounts {
  int drawn = 0;        ///< drawn at least in part
  int resolved = 0;     ///< D2 lines that were not needed: the penumbra is wider than six elements
  int too_close = 0;    ///< too short, or everywhere too close to what was drawn before
  int over_budget = 0;  ///< not tried: the limit on added elements was reached
};

/// Selects the critical lines to cut the mesh along, and breaks each into pieces that can be
/// triangulated well. Lines are taken by falling weight and broken where they meet points and lines
/// that are already there. A line that passes a point closer than 1/20 of an element is led through
/// the point.
///
/// A piece is left out if it would be shorter than 1/20 of an element, pass a point closer than
/// 1/40 of an element, or leave another line at less than 12 degrees. In the last case the other
/// line nearly coincides with the piece and has the greater weight.
class CreaseSelection {
 public:
  using Segment = std::array<Eigen::Vector3d, 2>;

  /// Keeps references to `planes` and to `fixed`, the fixed pieces of each plane. Planes of less
  /// area than a square element get no creases.
  CreaseSelection(const std::vector<FacetPlane>& planes,
                  const std::vector<std::vector<FixedPiece>>& fixed, const CreaseOptions& options);

  /// Draws `lines`, which are in order of falling weight. Contact lines (D0) are skipped: they are
  /// among the fixed pieces.
  void select(const std::vector<CriticalLine>& lines);

  const std::vector<Segment>& creases(int plane) const { return creases_[plane]; }
  const CreaseCounts& counts() const { return counts_; }

 private:
  struct Piece {
    int a = 0, b = 0;  // points of the drawing
    int segment = -1;  // of FixedPiece; -1 for a crease
  };
  struct Drawing {  // one facet
    bool is_ready = false;
    std::vector<Eigen::Vector2d> xy{};
    std::vector<Eigen::Vector3d> position{};
    std::vector<Piece> pieces{};
  };
  // A point at which a new line is broken.
  struct Stop {
    double t = 0.0;  // parameter on the line, in [0, 1]
    int point = -1;  // of the drawing; -1: to be made at `xy`
    int piece = -1;  // of the drawing, on which the point lies; -1: none
    Eigen::Vector2d xy{};
  };

  Drawing& drawing(int plane);
  /// True if at least a part of the line is drawn.
  bool add_line(const CriticalLine& line);
  std::vector<Stop> stops(const Drawing& d, const Eigen::Vector2d& a,
                          const Eigen::Vector2d& b) const;
  bool fits(const Drawing& d, const Stop& from, const Stop& to) const;
  int make_point(const FacetPlane& plane, Drawing& d, const Stop& stop);

  const std::vector<FacetPlane>& planes_;
  const std::vector<std::vector<FixedPiece>>& fixed_;
  CreaseOptions options_;
  double spacing_ = 0.0;
  std::vector<Drawing> drawings_;
  std::map<int, std::vector<Eigen::Vector3d>> made_on_segment_;
  std::vector<std::vector<Segment>> creases_;
  double elements_ = 0.0;  // added so far
  CreaseCounts counts_{};
};

}  // namespace lightwell
