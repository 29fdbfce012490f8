#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "mesh/elements/refine_elements.h"
#include "radiosity/emitters/lit_scene.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/refine/interpolated_vertices.h"

namespace lightwell {

/// Options of refinement.
struct RefineOptions {
  /// RMS error of interpolated irradiance at which refinement stops, over all area that reflects,
  /// relative to error_reference(). 0: nothing is refined.
  double tolerance = 0.007;
  /// Most elements, both sides counted. 0: about as many as an even mesh of a quarter of the
  /// start's edges has, if small elements of the start are not split.
  std::int64_t max_elements = 0;
  /// Most elements that there is memory for, both sides counted; below 0: any number. The elements
  /// of the start are kept even if they are more.
  std::int64_t room = -1;
  /// Most levels of splits: edges of 2^-max_level of the start's.
  int max_level = 4;
};

/// The reason why refinement ended.
enum class RefineOutcome {
  off,
  tolerance_reached,
  max_elements_reached,
  memory_limit_reached,  ///< as many elements as RefineOptions::room
  smallest_size_reached
};

/// The course of refinement, in numbers.
struct RefineReport {
  RefineOutcome outcome = RefineOutcome::off;
  double tolerance = 0.0;
  double estimate = 0.0;  ///< RMS error that is left, by the elements' own estimates; relative
  int rounds = 0;
  std::int64_t elements_at_first = 0, elements = 0;
  std::int64_t gathers = 0;  ///< points at which direct light was gathered
};

/// The report as text, such as "the tolerance of 0.7 % is reached (0.68 % estimated; 1780 elements
/// became 6990 in 2 rounds)".
std::string sentence(const RefineReport& report);

/// Throws InputError if `mesh` has more elements than `options` allow.
void require_room(const PatchMesh& mesh, const RefineOptions& options);

/// Light at the base's vertices with the columns of each channel side by side (see DirectLight);
/// W/m^2, vertices x columns.
struct ChannelLight {
  const DirectLight& direct_light;
  const BandArray& radiosity;  ///< as gatherable_radiosity makes it
  const BandArray& caustic;    ///< irradiance, or empty
};

/// Refined elements, and the pilot gather at their vertices.
struct RefinedSolution {
  RefinedMesh refined{};
  GatheredIrradiance pilot{};  ///< vertices x columns; direct light is as for the final solution
  std::vector<InterpolatedVertex> interpolated{};  ///< without a final gather of indirect light
  std::vector<VertexPrediction> predictions{};     ///< see combine_with_predictions
  /// Per element, the estimated RMS error of interpolation, relative to error_reference(). Includes
  /// (in the square) half of the error that noise may hide.
  Eigen::ArrayXf error{};
  RefineReport report{};
  int gather_rays = 0;  ///< rays of the final gather
};

/// Adaptive subdivision of elements (Cohen, Greenberg, Immel & Brock 1986, "An efficient radiosity
/// approach for realistic image synthesis"). Patches and their form factors stay the same.
///
/// Elements are split if irradiance interpolated between their vertices differs from irradiance
/// gathered inside them (see InterpolationError). Each round splits the cells with the largest
/// squared errors, as many as it takes for the others to hold at most half of the squared error
/// that the tolerance allows (Doerfler 1996, "A convergent adaptive algorithm for Poisson's
/// equation"). Cells are not measured if a bound by their corners' values shows that their errors
/// are too small.
class SolutionRefinement {
 public:
  /// `radiosity` (as gatherable_radiosity makes it) and `caustic` irradiance (or an empty array)
  /// are at the base's vertices; the caster of `lit` is of the base. With `noise` above 0 a first
  /// gather chooses the rays with which the final gather's noise is at most that share of the mean
  /// irradiance; otherwise they are those of `gather`. Keeps references to the parts of `lit` and
  /// to `elements`. Throws InputError as require_room does, Interrupted when progress says stop.
  SolutionRefinement(const LitScene& lit, const BandArray& radiosity, const BandArray& caustic,
                     RefinedElements& elements, const GatherOptions& gather,
                     const RefineOptions& options, double noise = 0.0);
  ~SolutionRefinement();

  /// Splits elements until the tolerance, or a limit, is reached. A further call with another
  /// tolerance continues with the elements and gathers of the last one; the other options must be
  /// the same. With `by_channel` the pilot gather has columns of each channel, whose light must
  /// have the same sum. Throws Interrupted when progress says stop.
  RefinedSolution refine(const RefineOptions& options, const ChannelLight* by_channel = nullptr);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lightwell
