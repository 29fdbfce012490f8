#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "mesh/elements/element_caster.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/paths/light_path.h"
#include "raytrace/caustics/caustic_map.h"
#include "scene/progress.h"
#include "scene/receiver_gain.h"

namespace lightwell {

struct VirtualLightOptions {
  int count = 4096;             ///< about as many lights, at least 1
  int max_specular_depth = 10;  ///< most mirrors and clear surfaces on the way of light
  std::shared_ptr<const CausticMap> caustics{};  ///< light by way of these; null: none
  std::uint64_t key = 0;                         ///< of the random numbers: other lights for each
  Progress progress{};
};

/// Instant radiosity (Keller 1997): indirect light at a point from virtual lights, without a
/// solution.
///
///     E = sum_k flux_k V min(cos cos' / r^2, b) / pi + (1/n) sum_i B(y_i) (1 - b r^2 / (cos
///     cos'))+
///
/// The first sum, of cuts through the light tree, leaves out what lights nearer than 1 / sqrt(b)
/// would add without bound. A few cosine-distributed rays find that light (Kollig & Keller 2004,
/// "Illumination in the presence of weak singularities"): B at the end y of a ray is
/// rho (E_direct + E), computed there by one light and one further ray. The mean has no bias for
/// any number of lights; more lights leave less to rays. The rays also find light by way of mirrors
/// and glass, by chance: what one of many rays finds of bright places is limited (see
/// limited_sum()).
class VirtualLights {
 public:
  /// Keeps references to all that `lit` refers to.
  VirtualLights(const LitScene& lit, const VirtualLightOptions& options);

  /// Number of lights.
  int count() const { return lights_.light_count(); }
  /// Light by way of mirrors and glass; null: none.
  const CausticMap* caustics() const { return caustics_.get(); }
  /// True if the scene has mirrors or glass.
  bool has_specular() const { return paths_.has_specular(); }

  /// A point and the effort there.
  struct Query {
    SurfacePoint at{};
    std::uint64_t key = 0;  ///< of the random numbers
    /// Share of the whole effort, (0, 1]; 0: one light and one ray, for one of many samples.
    float effort = 1.0f;
    ReceiverGain gain{};  ///< light counts times its factor
    int depth = 0;        ///< ends of rays, one behind another, that the query is of
    /// Radiosity at the vertices of the mesh, W/m^2, which rays read where they end, as
    /// gatherable_radiosity() makes it. Null: rays find it by one light and one further ray.
    const BandArray* radiosity = nullptr;
  };
  /// Indirect irradiance, W/m^2 per band. `caster` is that of the scene or its ElementCaster::at().
  /// Caustics are not included.
  Spectrum indirect_irradiance(const ElementCaster& caster, const Query& query) const;

  // The two parts of indirect_irradiance(), W/m^2 per band.
  /// The first sum: light of the lights, as far as the limit of the kernel lets it pass.
  Spectrum from_lights(const ElementCaster& caster, const Query& query) const;
  /// The second sum: light that the limit cuts off, and that comes by way of mirrors and glass.
  /// `of_lights`: the first sum, mean of the bands.
  Spectrum from_rays(const ElementCaster& caster, const Query& query, float of_lights) const;

 private:
  int rays_of(const Query& query) const;
  /// The end of a ray, `depth` ends of rays behind a query.
  struct End {
    const ElementHit& hit;
    Eigen::Vector3d position, normal;
    int depth = 0;
  };
  Spectrum near_light(const ElementCaster& caster, const Ray& ray, const ElementHit& hit,
                      double cosine, const Query& query, std::uint64_t key) const;
  Spectrum dimmed(const Ray& ray, const ElementHit& hit, const Spectrum& light) const;
  Spectrum by_way(const ElementCaster& caster, const Ray& ray, const ElementHit& hit,
                  const Query& query, std::uint64_t key) const;
  Spectrum radiosity(const ElementCaster& caster, const End& end, std::uint64_t key) const;

  LitScene lit_;
  LightPaths paths_;
  std::shared_ptr<const CausticMap> caustics_{};
  double most_ = 0.0;  // b, 1/m^2
  DirectLight lights_;
  Spectrum dome_{};  // factor of the sky's dome; empty: no dome
};

}  // namespace lightwell
