#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/solution/solution.h"

namespace lightwell {

/// Effort of specular_irradiance().
struct SpecularLightOptions {
  int most_rays = 1 << 15;  ///< per point, in addition to the first 4096
  double accuracy = 0.003;  ///< standard error at which a point is done, share of all its light
  /// Light that a point gets by other ways, which counts for the accuracy, mean of the bands,
  /// W/m^2; empty: none.
  std::vector<double> other_light{};
  int max_depth = 16;         ///< most mirrors and clear surfaces along a path
  std::uint64_t replica = 0;  ///< another number gives an independent estimate
  Progress progress{};
};

/// Light at points by way of mirrors, gloss and clear bodies.
struct SpecularIrradiance {
  BandArray irradiance{};     ///< W/m^2, points x bands
  Eigen::ArrayXf variance{};  ///< of the mean of the bands, (W/m^2)^2, estimated
};

/// Irradiance of points from DirectLight's lights by way of mirrors, gloss and clear bodies, for
/// points that no mesh holds such light for (see caustic_irradiance).
///
/// - Emitters: E = int L cos over the hemisphere by stratified rays, whose trees (see
///   RayTree::trace_lamps) end on emitters. Strata are split where their rays differ most, so the
///   outlines of mirrored emitters get most rays. In scenes with rough surfaces or coats, what a
///   ray finds also depends on chance, and new rays in the final strata give the result: a stratum
///   is not chosen by the rays that it is the mean of.
/// - Lamps without surface and the sun: Newton's method finds the direction in which a chain of
///   smooth surfaces leads to the lamp (manifold exploration, Jakob & Marschner 2012), with
///   E = I T cos / |det A|. A is the derivative of the path's offset at the lamp by its direction
///   at the point; on a straight path det A = r^2. The search begins with the nearest of the first
///   rays. One solution is found per lamp and chain; a curved surface may have more.
///   Through parallel faces, as of stacked slabs, chains are many: the 256 heaviest are followed,
///   and the share of the others is that of the first rays.
/// - Emitters that the first rays may miss have strata split where Newton's method finds them.
///
/// The result does not depend on the number of threads. Throws Interrupted when progress says stop.
SpecularIrradiance specular_irradiance(const LitScene& lit, const RadiositySolution& solution,
                                       std::span<const GatherPoint> points,
                                       const SpecularLightOptions& options = {});

}  // namespace lightwell
