#pragma once

#include "mesh/elements/refine_elements.h"
#include "radiosity/refine/light_peaks.h"
#include "radiosity/refine/vertex_gathers.h"
#include "scene/sampling.h"

namespace lightwell {

/// A squared difference counts from this multiple of its noise on.
constexpr double beyond_doubt = 2.0;

/// The search for shadows, beams and peaks of near lights between the vertices of a cell, at which
/// direct light is compared already.
///
/// - Small ones: 16 shadow rays run from points of the cell to each of the first 64 lights that all
///   of the cell's vertices see whole, or that none sees. A ray that disagrees meets a shadow or a
///   beam narrower than half the cell; direct light is gathered at its origin.
/// - Edges through the middle: there the mean of the corners is right by chance. If some of the
///   vertices see a light and others do not, and the vertices agree with the interpolation although
///   the corners differ, direct light is gathered in the middles of the cell's four parts.
/// - Peaks: direct light is gathered at the feet of the strongest LightPeaks.
class ShadowSearch {
 public:
  /// Keeps references to all.
  ShadowSearch(RefinedElements& elements, const VertexGathers& gathers);

  /// Mean squared error of interpolated direct light between the cell's vertices, mean of the
  /// bands, (W/m^2)^2. `at_vertices` is the mean squared error at the vertices, on top of which the
  /// result comes, and `shadow_noise` is the squared noise of shadow rays in `at_vertices`.
  double error(int cell, int side, double at_vertices, double shadow_noise) const;
  /// The greatest mean squared error that a peak of a near light may make, unobstructed and by its
  /// own light, (W/m^2)^2.
  double greatest_peak_error(int cell, int side) const;

 private:
  // A point in the cell and the direct light interpolated there.
  struct CellPoint {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Spectrum direct{};
  };
  CellPoint point_in(int cell, int side, const Eigen::Vector4d& weights) const;
  CellPoint point_in(int cell, int side, double u, double v) const;
  // The plane of a cell's side, with the facet that rays leave from.
  struct Plane {
    Eigen::Vector3d normal;
    int facet;
  };
  Plane plane_of(int cell, int side) const;
  double squared_error(const Plane& plane, const CellPoint& at, std::uint64_t key,
                       EmitterVisibility* visibility = nullptr) const;
  double direct_range(int cell, int side) const;
  bool has_edge(int cell, int side) const;
  double probed_error(int cell, int side) const;
  double parts_error(int cell, int side) const;
  double peaks_error(int cell, int side) const;

  RefinedElements& elements_;
  const VertexGathers& gathers_;
  SobolPoints probes_;
  LightPeaks peaks_;
};

}  // namespace lightwell
