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

struct RefineOptions {
  /// Relative RMS error of interpolated irradiance at which refinement stops, over all that
  /// reflects; see InterpolationError for what it is relative to. 0: nothing is refined.
  double tolerance = 0.007;
  /// Elements that there may be, both sides; 0: about as many as an even mesh of a quarter of the
  /// edges would have, small ones left as they are.
  std::int64_t max_elements = 0;
  /// Elements that there is memory for, both sides; below 0: any number. Those of the start are
  /// kept however few these are.
  std::int64_t room = -1;
  /// How often an element of the start may be split: its edge by 2 to this.
  int max_level = 4;
};

/// Why refinement ended.
enum class RefineOutcome {
  off,
  tolerance_reached,
  max_elements_reached,
  memory_limit_reached,  ///< as many elements as there is room for
  smallest_size_reached
};

struct RefineReport {
  RefineOutcome outcome = RefineOutcome::off;
  double tolerance = 0.0;
  double estimate = 0.0;  ///< the relative RMS error that is left, as the elements tell
  int rounds = 0;
  std::int64_t elements_at_first = 0, elements = 0;
  std::int64_t gathers = 0;  ///< places at which irradiance was gathered
};

/// "the tolerance of 0.7 % is reached (0.68 % estimated; 1780 elements became 6990 in 2 rounds)".
std::string sentence(const RefineReport& report);

/// Throws InputError if a mesh to be refined has more elements than there may be.
void require_room(const PatchMesh& mesh, const RefineOptions& options);

/// The light of a scene with the columns of each channel side by side (see DirectLight).
struct ChannelLight {
  const DirectLight& direct_light;
  const BandArray& radiosity;  ///< at the base's vertices, as gatherable_radiosity makes it
  const BandArray& caustic;    ///< the same, or nothing; W/m^2
};

/// Refined elements, and a first gather at their vertices.
struct RefinedSolution {
  RefinedMesh refined{};
  GatheredIrradiance pilot{};  ///< vertices x bands; the direct light is as good as it gets
  std::vector<InterpolatedVertex>
      interpolated{};  ///< where the final gather of indirect light may be left out
  std::vector<VertexPrediction>
      predictions{};  ///< what the pilot gather says of the others, and of these
  /// Per element: estimated relative RMS error of interpolation over it, with half of what noise
  /// may hide, in the square.
  Eigen::ArrayXf error{};
  RefineReport report{};
  int gather_rays = 0;  ///< that the final gather is to take
};

/// Adaptive subdivision (Cohen, Greenberg, Immel & Brock 1986, "An efficient radiosity approach for
/// realistic image synthesis"): patches and their exchange stay what they are; elements are split
/// where irradiance interpolated between their vertices is not what is gathered inside them (see
/// InterpolationError). Each round splits the cells that hold most of the squared error, as many as
/// it takes for the others to hold no more than half of what the tolerance allows (Doerfler 1996,
/// "A convergent adaptive algorithm for Poisson's equation"). What a bound by the corners' values
/// shows not to matter is not measured.
class SolutionRefinement {
 public:
  /// `radiosity` (as gatherable_radiosity makes it) and `caustic` irradiance (or nothing) are at
  /// the base's vertices; `caster` is of the base. With `noise` above 0 a first gather tells how
  /// many rays the final gather takes to leave no larger a share of the mean irradiance; else they
  /// are those of `gather`. Keeps references to the first three and to `elements`. Throws as
  /// require_room does.
  SolutionRefinement(const LitScene& lit, const BandArray& radiosity, const BandArray& caustic,
                     RefinedElements& elements, const GatherOptions& gather,
                     const RefineOptions& options, double noise = 0.0);
  ~SolutionRefinement();

  /// Splits until the tolerance is reached, and goes on from there when it is called again: what
  /// was gathered is kept. Of `options` only the tolerance may have changed. With `by_channel` the
  /// pilot gather is of that light, which has the same sum.
  RefinedSolution refine(const RefineOptions& options, const ChannelLight* by_channel = nullptr);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lightwell
