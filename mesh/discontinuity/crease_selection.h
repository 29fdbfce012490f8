#pragma once

#include <array>
#include <map>
#include <vector>

#include "mesh/discontinuity/critical_lines.h"

namespace lightwell {

/// A piece of a line that a facet's triangulation holds already: of its boundary or of a contact
/// line.
struct FixedPiece {
  int a = 0, b = 0;  ///< points, any numbers that name them
  Eigen::Vector3d from, to;
  int segment = 0;  ///< the line it is a piece of, the same for all facets that share it
};

struct CreaseOptions {
  double element_size = 1.0;   ///< metres
  double tolerance = 0.0;      ///< metres; points nearer than that are one
  double most_elements = 0.0;  ///< roughly how many elements creases may add
};

/// What became of the critical lines.
struct CreaseCounts {
  int drawn = 0;        ///< at least in part
  int resolved = 0;     ///< D2 in penumbras that the elements resolve anyway
  int too_close = 0;    ///< too short, or nowhere far enough from what was drawn before
  int over_budget = 0;  ///< left out because enough elements had been added
};

/// Which critical lines to cut the mesh along, and where exactly, so that what comes of it can be
/// triangulated well: lines are taken by falling weight, each broken where it meets what is there
/// already. A piece is left out that would run closer than 1/20 of an element to another point or
/// leave another line at less than 12 degrees: the line it would follow is there already, and is
/// the more important one. A line that passes a point closer than that is led through it.
class CreaseSelection {
 public:
  using Segment = std::array<Eigen::Vector3d, 2>;

  /// `fixed`: per plane. Planes smaller than an element get no creases.
  CreaseSelection(const std::vector<FacetPlane>& planes,
                  const std::vector<std::vector<FixedPiece>>& fixed, const CreaseOptions& options);

  /// Lines by falling weight; contacts (D0) are passed over, they are fixed pieces.
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
  struct Stop {  // where a new line is broken
    double t = 0.0;
    int point = -1;  // of the drawing, or to be made at `xy`
    int piece = -1;  // that it lies on
    Eigen::Vector2d xy{};
  };

  Drawing& drawing(int plane);
  /// Whether any of it is drawn.
  bool add_line(const CriticalLine& line);
  std::vector<Stop> stops(const Drawing& d, const Eigen::Vector2d& a,
                          const Eigen::Vector2d& b) const;
  bool fits(const Drawing& d, const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Stop& from,
            const Stop& to) const;
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
