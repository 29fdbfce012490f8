#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "mesh/elements/pictured_reflectance.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/gather/bright_patches.h"
#include "radiosity/gather/gap_light.h"
#include "radiosity/openings/portals.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/solution/solution.h"
#include "scene/hemisphere_sets.h"
#include "scene/receiver_gain.h"
#include "scene/sampling.h"

namespace lightwell {

/// A point that a pixel shows.
struct ShadingPoint {
  Eigen::Vector3d position, normal;  ///< geometric normal, unit, on the side of the eye
  Eigen::Vector3d smooth_normal;     ///< shading normal, the axis of the gather's hemisphere, unit
  int facet = -1;
  ReceiverGain gain{};  ///< light counts times its factor
};

/// Final gather (Reichert 1992) at points of a picture: indirect irradiance E = (1/N) sum B over N
/// cosine-distributed rays of a scrambled Sobol sequence. B is the solution's radiosity at the end
/// of a ray, which is followed through mirrors and clear glass. If there are bright patches, a
/// quarter as many rays are aimed at them (see BrightPatches), and as many at openings between
/// bright and dim parts (see Portals). In a deep gap as many rays more are drawn with the logarithm
/// of the tangent of their angle even over the scales of the gap (see GapExits).
///
/// Light of emitters of DirectLight through mirrors and glass is not included: see
/// RadiositySolution::caustic_irradiance. Light of the sky's dome through mirrors and glass is
/// included.
class PixelGather {
 public:
  PixelGather(const PixelGather&) = delete;
  PixelGather& operator=(const PixelGather&) = delete;
  /// `most_rays` is the number of rays per point, at least 1; a power of two stratifies best.
  PixelGather(const Scene& scene, const ElementCaster& caster, const DirectLight& direct_light,
              const RadiositySolution& solution, int most_rays, int max_specular_depth);

  /// Indirect irradiance at a point, W/m^2 per band, with about `share`, (0, 1], of the rays:
  /// `most_rays` halved until the share is reached, but at least 8 rays. `caster` is the caster of
  /// the constructor or its ElementCaster::at().
  Spectrum indirect_irradiance(const ElementCaster& caster, const ShadingPoint& at,
                               std::uint64_t key, float share) const;

  /// Slant of the indirect light at a point, int L (w - (w . n) n) dw / int L (w . n) dw, all bands
  /// together, from two rays for each of `most_rays`: the second lies opposite about the normal.
  /// Light below 18 degrees counts as light at that height. 0 without light.
  Eigen::Vector3d slant(const ElementCaster& caster, const ShadingPoint& at,
                        std::uint64_t key) const;

 private:
  // Balance-heuristic weights of light straight from a hit, and of light through mirrors and glass,
  // and the solid angle, sr, that a ray of the former stands for.
  struct Shares {
    double straight = 1.0, by_way = 1.0, solid_angle = 0.0;
  };
  // A point, and the bright patches, portals and exits of a gap that are seen from there.
  struct Place {
    const ElementCaster& caster;
    const ShadingPoint& at;
    std::uint64_t key = 0;
    int rays = 0;  // cosine-distributed
    BrightPatches::View bright{};
    Portals::View portals{};
    std::optional<GapExits> exits{};
  };
  double aimed_density(const Place& place, const Ray& ray, const ElementHit& hit) const;
  void aim_at_bright(const Place& place, Eigen::ArrayXd& sum) const;
  void aim_at_portals(const Place& place, Eigen::ArrayXd& sum) const;
  void aim_at_exits(const Place& place, Eigen::ArrayXd& sum) const;
  bool is_in_gap(const Place& place, const Ray& ray, const ElementHit& hit) const;
  void add(const Place& place, const Ray& ray, const ElementHit& hit, std::uint64_t index,
           double aimed, Eigen::ArrayXd& sum) const;
  void add_flat(const Place& place, const Ray& ray, const ElementHit& hit, std::uint64_t index,
                double aimed, Eigen::ArrayXd& sum) const;
  Spectrum arriving(const ElementCaster& caster, const Ray& ray, const ElementHit& hit,
                    std::uint64_t key, const Shares& shares) const;
  Spectrum straight_radiosity(const ElementCaster& caster, const Ray& ray, const ElementHit& hit,
                              double solid_angle) const;

  LightPaths paths_;
  BandArray radiosity_{};               // vertices x bands, W/m^2
  Spectrum dome_{};                     // irradiance factor of the sky's dome; empty: no dome
  std::vector<HemisphereSets> sets_{};  // each with half the rays of the set before
  BrightPatches bright_;
  PicturedReflectance pictures_;
  GapLight gaps_;
  SobolPoints aims_;                        // Sobol points of the rays towards bright_ and portals_
  SobolPoints exit_aims_;                   // and out of gaps
  std::shared_ptr<const Portals> portals_;  // null: none
};

}  // namespace lightwell
