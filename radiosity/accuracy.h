#pragma once

#include <optional>
#include <vector>

#include "radiosity/direct_light/direct_light.h"
#include "radiosity/refine/refine_options.h"
#include "radiosity/solution/solution.h"

namespace lightwell {

/// The settings that decide over the error of a solution, apart from the form factors.
struct Effort {
  double refine_tolerance = 0.0;  ///< RefineOptions::tolerance; 0: nothing is refined
  int gather_rays = 0;            ///< GatherOptions::rays

  /// Shadow rays that leave about as much noise in penumbras as `gather_rays` leave elsewhere: at
  /// most a quarter of `gather_rays` (64 to 256), at first an eighth of that (16 or more). They
  /// choose among many lights by `many_lights`.
  ShadowOptions shadows(ManyLights many_lights) const;
};

/// Mean illuminance of the patches that reflect in at least one band, weighted by area, lx.
/// `patch_radiosity` is patches x bands, W/m^2. A band that a patch absorbs whole takes the mean
/// irradiance of the patch's other bands.
double mean_illuminance(const Bands& bands, const PatchMesh& mesh,
                        const BandArray& patch_radiosity);
/// The same of each part of the scene (see SceneParts::judged_with); 0: nothing reflects in it.
std::vector<double> mean_illuminances(const Bands& bands, const PatchMesh& mesh,
                                      const BandArray& patch_radiosity, const SceneParts& parts);

/// The irradiance by which errors in each part are judged (see PartMeans), from the light of
/// patches, mean of the bands, W/m^2.
std::vector<double> reference_irradiances(const PatchMesh& mesh, const BandArray& patch_radiosity,
                                          const SceneParts& parts);

/// The effort of the first attempt at `target`, an error relative to the mean irradiance: 95 % of
/// the target for the tolerance of refinement (0 if `refines` is false), and 1024 rays for 1 %,
/// which suffices in a room of white walls; see rays_for_noise for other targets.
Effort first_effort(double target, bool refines);

/// Rays to the dome of the sky at each vertex for a `target`: 2048 for 1 %. Their noise falls with
/// rays^(-3/4); see ShadowOptions.
int sky_rays(double target);

/// The target for which sky_rays() gives `rays`.
double target_of_sky_rays(int rays);

/// The noise that the final gather may leave, relative to the mean irradiance: 55 % of `target`.
double noise_share(double target);

/// Rays of the final gather if neither they nor an accuracy are asked for.
inline constexpr int rays_by_default = 1024;

/// The rays of rays_by_default that are worth their time where refinement ended at a limit with the
/// error `left` by its own estimate, relative to the mean: those whose noise is a sixth of that, a
/// power of two from 256 on. More would not show.
int rays_worth(double left);

/// The effort of the next attempt, after `spent` left an `error` of which `noise_estimate` is that
/// of rays (both gathers of the error estimate); all relative to the mean irradiance. Empty if more
/// would not help. Noise falls with the number of rays, the error of interpolation with the
/// tolerance of refinement, as long as `refinement` has reached its tolerance and not a limit of
/// elements. `attempt` counts from 0; there are six at most.
std::optional<Effort> next_effort(const Effort& spent, double target, double error,
                                  double noise_estimate, const RefineReport& refinement,
                                  int attempt);

}  // namespace lightwell
