#pragma once

#include <array>
#include <vector>

#include "mesh/geometry/facet_plane.h"
#include "scene/progress.h"

namespace lightwell {

/// How irradiance changes across a line: it jumps (d0), its slope jumps (d1), its curvature (d2).
enum class LineDegree { d0, d1, d2 };

/// A straight line on a facet along which the view of an emitter changes: where the rays from an
/// emitter's corner through an occluder's edge (VE) or from an emitter's edge through an occluder's
/// corner (EV) fall. Bounds of umbra and penumbra are among them.
struct CriticalLine {
  int plane = 0;  ///< receiver, index into the FacetPlanes
  int facet = 0;  ///< the same as scene-wide facet number
  std::array<Eigen::Vector3d, 2> ends{};
  LineDegree degree = LineDegree::d2;
  bool is_vertex_edge = true;  ///< VE; else EV
  int emitter = 0;             ///< facet number of the emitter's first facet
  /// Roughly how wide the penumbra is at the ends, metres: the shadow of the occluder's feature
  /// from all of the emitter.
  std::array<double, 2> penumbra{};
  /// What leaving it out costs, watts per metre: irradiance (unshaded) times length, a quarter of
  /// that for d2.
  double weight = 0.0;
};

struct CriticalLineOptions {
  int most_emitters = 64;   ///< the most powerful; the others cast no lines
  int most_wedges = 10000;  ///< critical surfaces followed; those that matter least are left out
};

/// Lines by falling weight (ties by where they came from), and what bounded them.
struct CriticalLines {
  std::vector<CriticalLine> lines{};
  int emitters = 0, emitters_left_out = 0;
  int wedges = 0;
  std::int64_t wedges_left_out = 0;
};

/// Finds the critical lines of vertices and edges (Heckbert 1992; Lischinski, Tampieri & Greenberg
/// 1992) of all emitting polygons: D0 where an occluder's edge lies on the receiver, D1 where an
/// edge of the emitter lies in one plane with an edge of the occluder, D2 elsewhere. Surfaces of
/// three edges (EEE) are left out, and spheres cast no lines. Clear facets neither cast nor
/// receive. Faces behind which a one-sided receiver is black get none.
CriticalLines critical_lines(const Scene& scene, const std::vector<FacetPlane>& planes,
                             const CriticalLineOptions& options = {},
                             const Progress& progress = {});

/// The same with planes of its own, for scenes whose corners meet exactly.
CriticalLines critical_lines(const Scene& scene, const CriticalLineOptions& options = {});

}  // namespace lightwell
