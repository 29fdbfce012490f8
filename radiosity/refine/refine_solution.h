#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "mesh/elements/refine_elements.h"
#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/refine/channel_light.h"
#include "radiosity/refine/element_limits.h"
#include "radiosity/refine/interpolated_vertices.h"
#include "radiosity/refine/refine_options.h"

namespace lightwell {

/// Refined elements, and the pilot gather at their vertices.
struct RefinedSolution {
  RefinedMesh refined{};
  /// Vertices x columns; direct light is as for the final solution. Neighbours have evened out the
  /// noise of the sky's light where more than asked for is left (see VertexEffort).
  GatheredIrradiance pilot{};
  std::vector<InterpolatedVertex> interpolated{};  ///< without a final gather of indirect light
  std::vector<VertexPrediction> predictions{};     ///< see combine_with_predictions
  /// SharedGathers::unread, whose entries are also in `interpolated`, and SharedGathers::rough.
  std::vector<InterpolatedVertex> unread{};
  std::vector<int> rough{};
  /// Per element, the estimated RMS error of interpolation, relative to error_reference(). Includes
  /// (in the square) half of the error that noise may hide.
  Eigen::ArrayXf error{};
  RefineReport report{};
  std::vector<int> gather_rays{};  ///< rays of the final gather in each part
};

/// Adaptive subdivision of elements (Cohen, Greenberg, Immel & Brock 1986, "An efficient radiosity
/// approach for realistic image synthesis"). Patches and their form factors stay the same. Each
/// part of the scene is refined until it has reached its own tolerance.
///
/// Elements are split if irradiance interpolated between their vertices differs from irradiance
/// gathered inside them (see InterpolationError). Each round splits the cells with the largest
/// squared errors, as many as it takes for the others to hold at most half of the squared error
/// that the tolerance allows (Doerfler 1996, "A convergent adaptive algorithm for Poisson's
/// equation"). Cells are not measured if a bound by their corners' values shows that their errors
/// are too small, and not split if they are smaller by a level than cells of typical_leaf_area()
/// are on the deepest level, as those of chains and leaves are from the start.
class SolutionRefinement {
 public:
  /// `radiosity` (as gatherable_radiosity makes it) and `caustic` irradiance (or an empty array)
  /// are at the base's vertices; the caster of `lit` is of the base. If the efforts of `options`
  /// limit the noise, a first gather chooses the rays of the final gather; otherwise they are those
  /// of `gather`. Keeps references to the parts of `lit` and to `elements`. Throws InputError as
  /// require_room does, Interrupted when progress says stop.
  SolutionRefinement(const LitScene& lit, const BandArray& radiosity, const BandArray& caustic,
                     RefinedElements& elements, const GatherOptions& gather,
                     const RefineOptions& options);
  ~SolutionRefinement();

  /// Splits elements until the tolerance, or a limit, is reached. A further call with another
  /// tolerance continues with the elements and gathers of the last one; the other options must be
  /// the same. With `by_channel` the pilot gather has columns of each channel, whose light must
  /// have the same sum. Throws Interrupted when progress says stop.
  RefinedSolution refine(const RefineOptions& options, const ChannelLight* by_channel = nullptr);

  /// Light at the vertices of the base, vertices x bands, W/m^2, which is known from the beginning,
  /// whether refine() was called or stopped or neither. Indirect light is 0 on unread_patches().
  GatheredIrradiance light_at_base() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lightwell
