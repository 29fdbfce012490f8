#pragma once

#include "radiosity/solution/light_channel.h"
#include "scene/progress.h"

namespace lightwell {

class DirectLight;
class ElementCaster;
class LightPaths;
struct Scene;

/// Irradiance of patches from free sources, straight and through mirrors and glass: the E0 of
/// B = M + rho (E0 + F B). Columns are bands, channel after channel as in DirectLight. Empty
/// without free sources.
struct FreeLight {
  BandArray irradiance{};  ///< E0_i, W/m^2, patches x columns
  // Power by its fate, W per column; the rest arrived at patches.
  Eigen::ArrayXd emitted{};
  Eigen::ArrayXd absorbed{};  ///< by mirrors and glass
  Eigen::ArrayXd escaped{};   ///< out of the scene or onto black backs, `missed` included
  Eigen::ArrayXd missed{};    ///< out of the scene without meeting any surface

  bool empty() const { return irradiance.size() == 0; }
};

/// The sum over channels: `bands` columns.
FreeLight all_channels(const FreeLight& light, int bands);

/// The columns of one channel.
FreeLight of_channel(const FreeLight& light, int channel, int bands);

/// Sends about `rays` rays (1 to 2^24) in all from the free sources of `direct_light`, in
/// proportion to their flux, at least 4096 each. Directions follow intensity by scrambled Sobol
/// points. The rays of a source carry exactly its flux: emitted = arrived + absorbed + escaped. The
/// same bits for any number of threads. Throws Interrupted when progress says stop.
FreeLight cast_free_light(const Scene& scene, const ElementCaster& caster, const LightPaths& paths,
                          const DirectLight& direct_light, int rays = 1 << 20,
                          const Progress& progress = {});

}  // namespace lightwell
