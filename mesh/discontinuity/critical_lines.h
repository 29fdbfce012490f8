#pragma once

#include <array>
#include <vector>

#include "mesh/geometry/facet_plane.h"
#include "scene/progress.h"

namespace lightwell {

/// Degree of the discontinuity of irradiance across a line: the value jumps (d0), the slope jumps
/// (d1), or the curvature jumps (d2).
enum class LineDegree { d0, d1, d2 };

/// A straight line on a facet across which the view of an emitter changes. The line is the trace of
/// a critical surface: of the rays from an emitter's corner through an occluder's edge (VE), or
/// from an emitter's edge through an occluder's corner (EV). Bounds of umbra and penumbra are
/// critical lines.
struct CriticalLine {
  int plane = 0;  ///< receiver, index into the FacetPlanes
  int facet = 0;  ///< the receiver as scene-wide facet number
  std::array<Eigen::Vector3d, 2> ends{};
  LineDegree degree = LineDegree::d2;
  bool is_vertex_edge = true;  ///< VE; else EV
  int emitter = 0;             ///< scene-wide number of the emitter's first facet
  /// Approximate width of the penumbra at the two ends, metres: the extent of the emitter,
  /// projected through the occluder's edge or corner onto the receiver.
  std::array<double, 2> penumbra{};
  /// Estimated cost of leaving the line out, W/m: unoccluded irradiance times length, a quarter of
  /// that for d2.
  double weight = 0.0;
};

struct CriticalLineOptions {
  int most_emitters = 64;   ///< the most powerful; the others cast no lines
  int most_wedges = 10000;  ///< critical surfaces followed; those that matter least are left out
};

/// Critical lines by falling weight, and how many emitters and critical surfaces (wedges) the
/// limits left out. Lines of equal weight keep the order in which they were found, which is fixed.
struct CriticalLines {
  std::vector<CriticalLine> lines{};
  int emitters = 0, emitters_left_out = 0;
  int wedges = 0;
  std::int64_t wedges_left_out = 0;
};

/// Finds the vertex-edge critical lines of all emitting polygons (Heckbert 1992; Lischinski,
/// Tampieri & Greenberg 1992):
/// - D0 where an occluder's edge lies on the receiver;
/// - D1 where an edge of the emitter lies in one plane with an edge of the occluder;
/// - D2 elsewhere.
///
/// Critical surfaces of three edges (EEE) are left out, and round shapes cast no lines. Clear
/// facets neither cast nor receive lines. A one-sided receiver gets no lines from emitters behind
/// it.
CriticalLines critical_lines(const Scene& scene, const std::vector<FacetPlane>& planes,
                             const CriticalLineOptions& options = {},
                             const Progress& progress = {});

/// Finds the critical lines of a scene whose corners meet exactly: facet planes are made with
/// `weld_share` of the scene's diagonal as tolerance.
CriticalLines critical_lines(const Scene& scene, const CriticalLineOptions& options = {});

}  // namespace lightwell
