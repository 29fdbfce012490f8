#pragma once

#include <optional>

#include "radiosity/refine/refine_solution.h"
#include "radiosity/solution/solution.h"

namespace lightwell {

/// How exact irradiance is to be: the RMS error that RadiositySolution::error_estimate is. One of
/// both.
struct Accuracy {
  double share = 0.0;  ///< of the mean irradiance
  double lux = 0.0;
};

/// What the error of a solution depends on, the form factors of its patches apart.
struct Effort {
  double refine_tolerance = 0.0;  ///< 0: nothing is refined
  int gather_rays = 0;

  /// Shadow rays that leave about as much in penumbras as those rays leave elsewhere: a quarter
  /// as many, 64 to 256, and first an eighth of that, 16 or more.
  ShadowOptions shadows() const;
};

/// Mean illuminance of the patches that reflect, lx.
double mean_illuminance(const Bands& bands, const PatchMesh& mesh,
                        const BandArray& patch_radiosity);

/// For a target error relative to the mean irradiance: most of it is left to interpolation, and as
/// many rays are cast as a room of white walls takes for the rest. `refines`: whether elements may
/// be split.
Effort first_effort(double target, bool refines);

/// What of a target error is left to the noise of the gather.
double noise_share(double target);

/// The effort after one that left an `error`, `noise` of it by rays, those of what it was compared
/// with included, or nothing where more would not help: noise falls with rays, what interpolation
/// leaves with the tolerance of refinement, as far as there may be elements. `attempt` counts from
/// 0.
std::optional<Effort> next_effort(const Effort& spent, double target, double error, double noise,
                                  const RefineReport& refinement, int attempt);

}  // namespace lightwell
