#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "scene/coat.h"
#include "scene/round_shape.h"
#include "scene/scene.h"

namespace lightwell {

class AbsorbingBodies;
class FacetNormals;

/// The part of a ray's unit of light that arrived at no diffuse surface.
struct PathLosses {
  Spectrum escaped{};   ///< left the scene or met a black back, see PathQuantity
  Spectrum absorbed{};  ///< by mirrors, and by glass that is tinted or absorbs
  Spectrum cut{};       ///< left when the depth limit was reached
  /// Radiance of the sky's dome in the direction of escape times the throughput of the path,
  /// W/(m^2 sr). Empty if no light escaped, if it escaped through clear panes alone (direct light),
  /// or if there is no sky.
  Spectrum sky{};
  /// Unit direction in which light left the scene; zero if none did, or through clear panes alone.
  Eigen::Vector3d exit = Eigen::Vector3d::Zero();
};

/// An arrival of light behind mirrors and clear surfaces, at one of PathArrivals.
struct LightArrival {
  const ElementHit& hit;
  const Spectrum& throughput;
  double base_factor;        ///< LightPaths::base_factor() of the arrival
  Eigen::Vector3d position;  ///< m
  bool through_panes_only;   ///< the path went straight on, through smooth thin panes alone
};

/// Detail of the surfaces that mirror and refract.
enum class PathDetail {
  patches,  ///< normals of the polygons, so that reflected light adds up facet by facet; shares of
            ///< patterns as they are in the mean over a patch, so that they add up with its
            ///< reflectance; roughness at the point met
  points,   ///< normals of the curved surfaces that facets stand for, where given (see
            ///< FacetNormals); patterns as they are at the point met
};

/// True for a surface that reflects or emits diffusely, and for black ones that do not mirror: rays
/// read the light there, and photons stay there.
bool takes_diffuse_light(const Material& material);

/// Surfaces at which light that follows a path is told to arrive.
enum class PathArrivals {
  diffuse,  ///< surfaces that reflect or emit diffusely, whose light the ray reads or feeds
  all,      ///< mirrors and glass along the path, too, whose irradiance is to be measured
};

/// Quantity that a path weighs at its arrivals and where light escapes. The two are equal unless a
/// path begins and ends in bodies of different indices of refraction.
enum class PathQuantity {
  power,    ///< the share of the power sent along the ray: form factors, photons
  radiance  ///< the factor of the radiance that the ray reads, with radiance_scale(): gathers
};

/// Follows rays through mirrors and clear glass to diffuse surfaces (extended form factors, Sillion
/// & Puech 1989). One scattering sample continues each ray: a branch of glass with Fresnel's
/// probability, a direction of a rough surface's lobe. The mean is exact. Absorbing bodies
/// attenuate along the path, also those that a path begins in. Smooth surfaces polarise the light,
/// which decides over its share at the surfaces behind them.
///
/// Weak paths end by Russian roulette, behind two coats, which mirror a twentieth of the light
/// each, and beyond `max_depth`: light in a closed body of brushed metal would be followed to the
/// last of 128 surfaces otherwise.
class LightPaths {
 public:
  LightPaths(const Scene& scene, const ElementCaster& caster, int max_depth,
             PathDetail detail = PathDetail::patches,
             PathArrivals arrivals = PathArrivals::diffuse);

  /// True if the scene has a mirror or glass.
  bool has_specular() const { return has_specular_; }
  /// True if the facet mirrors or transmits at least a part of the light.
  bool is_specular(int facet) const { return specular_[facet] != 0; }
  /// True if the facet mirrors by a coat, if at all: light there is mostly that of its base.
  bool is_mostly_diffuse(int facet) const;
  /// Light that leaves the diffuse base of a facet against a ray, or that the base gets along the
  /// ray, over that at all angles alike: CoatedBase::factor(), and 1 without a coat. `hit` is where
  /// the ray ends.
  double base_factor(const ElementCaster& caster, const Ray& ray, const ElementHit& hit) const;
  double base_factor(const Ray& ray, const ElementHit& hit) const {
    return base_factor(caster_, ray, hit);
  }
  /// True if the facet reflects or emits diffusely.
  bool is_diffuse(int facet) const { return diffuse_[facet] != 0; }
  /// Share, per band, that an absorbing body leaves of light that comes straight along `ray` to
  /// `hit`; empty: all of it. follow() counts this share on its own.
  Spectrum left_by_body(const Ray& ray, const ElementHit& hit) const;
  /// True if a patch lies within an absorbing body, so that left_by_body() at its hits is not
  /// empty.
  bool dims_before(int patch) const;

  /// Calls `arrive` for every arrival behind the specular facet at `hit` of `ray`. The
  /// facet's own diffuse share, if any, is left to the caller. `key` decides the branches.
  PathLosses follow(const Ray& ray, const ElementHit& hit, std::uint64_t key,
                    const std::function<void(const LightArrival&)>& arrive,
                    PathQuantity quantity = PathQuantity::power) const;
  /// Calls `arrive` with the throughput times base_factor, for callers that need no more.
  PathLosses follow(const Ray& ray, const ElementHit& hit, std::uint64_t key,
                    const std::function<void(const ElementHit&, const Spectrum&)>& arrive,
                    PathQuantity quantity = PathQuantity::power) const;
  /// Follows rays of another caster of the same scene, such as ElementCaster::at().
  PathLosses follow(const ElementCaster& caster, const Ray& ray, const ElementHit& hit,
                    std::uint64_t key, const std::function<void(const LightArrival&)>& arrive,
                    PathQuantity quantity = PathQuantity::power) const;

 private:
  struct PathLight;
  // The material of a hit at `point`; `own` holds the numbers of a pattern.
  const Material& material_at(const ElementCaster& caster, const ElementHit& hit,
                              const Eigen::Vector3d& point, std::optional<Material>& own) const;
  Eigen::Vector3d normal_at(const ElementCaster& caster, const ElementHit& hit,
                            const Eigen::Vector3d& point) const;
  bool continue_at(const ElementCaster& caster, Ray& ray, const ElementHit& hit, std::uint64_t key,
                   PathLight& light, PathLosses& losses) const;
  bool survives(std::uint64_t key, float weak, PathLight& light, PathLosses& losses) const;
  void absorb(const Ray& ray, const ElementHit& hit, PathLight& light, PathLosses& losses) const;

  const Scene& scene_;
  const ElementCaster& caster_;
  int max_depth_ = 8;
  PathDetail detail_ = PathDetail::patches;
  PathArrivals arrivals_ = PathArrivals::diffuse;
  std::shared_ptr<const FacetTextures> textures_{};  // null: no facet has a pattern
  std::shared_ptr<const PatchPatterns> patterns_{};  // null with textures_
  bool has_specular_ = false, absorbs_ = false;
  std::shared_ptr<const AbsorbingBodies> bodies_{};  // null: no patch lies in one
  std::vector<char> specular_, diffuse_;
  CoatedBases bases_;
  std::vector<int> material_;            // per facet
  std::vector<Eigen::Vector3d> normal_;  // per facet; zero for round shapes
  RoundShapes round_;
  std::shared_ptr<const FacetNormals> smooth_{};  // null: the facets' own
};

}  // namespace lightwell
