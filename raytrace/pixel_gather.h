#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/emitters/direct_light.h"
#include "radiosity/gather/bright_patches.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/solution/solution.h"
#include "scene/hemisphere_sets.h"
#include "scene/sampling.h"

namespace lightwell {

/// A place that a pixel shows.
struct ShadingPoint {
  Eigen::Vector3d position, normal;  ///< the surface's own, unit, towards the eye
  Eigen::Vector3d smooth_normal;     ///< that light is measured about
  int facet = -1;
};

/// Final gather (Reichert 1992) at places of a picture: indirect irradiance, E = (1/N) sum B over
/// cosine-distributed rays of a scrambled Sobol sequence that read the solution's radiosity
/// where they end, going on through mirrors and clear glass, and a quarter as many more towards
/// bright patches where there are any (see BrightPatches). Light that emitters of DirectLight send
/// by way of mirrors and glass is not in it: see RadiositySolution::caustic_irradiance. That of the
/// sky's dome is.
class PixelGather {
 public:
  /// `most_rays` per place, at least 1; a power of two stratifies best.
  PixelGather(const Scene& scene, const ElementCaster& caster, const DirectLight& direct_light,
              const RadiositySolution& solution, int most_rays, int max_specular_depth);

  /// By about `share`, (0, 1], of the rays: the nearest power of two less, at least 8. `caster` is
  /// the one given, or what ElementCaster::at() makes of it.
  Spectrum indirect_irradiance(const ElementCaster& caster, const ShadingPoint& at,
                               std::uint64_t key, float share) const;

 private:
  void aim(const ElementCaster& caster, const ShadingPoint& at, const BrightPatches::View& view,
           int rays, std::uint64_t key, Eigen::ArrayXd& sum) const;
  Spectrum arriving(const ElementCaster& caster, const Ray& ray, const ElementHit& hit,
                    std::uint64_t key, double share) const;

  LightPaths paths_;
  BandArray radiosity_{};               // vertices x bands, W/m^2
  Spectrum dome_{};                     // factor of the sky's light; empty if there is none
  std::vector<HemisphereSets> sets_{};  // each of half as many rays as the one before
  BrightPatches bright_;
  SobolPoints aims_;  // towards those
};

}  // namespace lightwell
