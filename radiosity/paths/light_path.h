#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "scene/facet_normals.h"
#include "scene/scene.h"
#include "scene/specular.h"

namespace lightwell {

/// What happened to a ray's unit of light beyond the places where it arrived.
struct PathLosses {
  Spectrum escaped{};   ///< left the scene or met a black back
  Spectrum absorbed{};  ///< taken up by mirrors and by glass that is tinted or absorbs
  Spectrum cut{};       ///< still under way when the depth limit was reached
  /// Radiance of the sky's dome where it left the scene, times what of that would come back this
  /// way, W/(m^2 sr); empty if it did not leave, by clear panes alone (that is direct light), or
  /// there is no sky.
  Spectrum sky{};
};

/// Where light arrives at something diffuse, behind mirrors and clear surfaces.
struct LightArrival {
  const ElementHit& hit;
  const Spectrum& throughput;
  Eigen::Vector3d position;  ///< m
  bool through_panes_only;   ///< it went straight on, through smooth thin panes and nothing else
};

/// Which normals mirror and refract.
enum class PathNormals {
  facets,  ///< of the polygons, so that what is reflected adds up facet by facet
  smooth,  ///< of the surfaces they stand for, where files give those (see FacetNormals)
};

/// Follows rays through mirrors and clear glass until something diffuse takes them up (extended
/// form factors, Sillion & Puech 1989). At glass one branch is followed, picked with Fresnel's
/// probability, and at rough surfaces one direction of their lobe (see sample_scattering), so that
/// a ray stays a ray and the mean is exact. Bodies that absorb do so along the way, see Media.
class LightPaths {
 public:
  LightPaths(const Scene& scene, const ElementCaster& caster, int max_depth,
             PathNormals normals = PathNormals::facets);

  /// Whether the scene has any mirror or glass at all.
  bool has_specular() const { return has_specular_; }
  /// Whether light that meets this facet goes on undiffused (in part or whole).
  bool is_specular(int facet) const { return specular_[facet] != 0; }
  /// Whether the facet's sides take part in diffuse exchange (reflect or emit diffusely).
  bool is_diffuse(int facet) const { return diffuse_[facet] != 0; }

  /// `arrive` is called for every diffuse arrival behind the specular facet that
  /// `hit` of `ray` names (the facet's own diffuse share, if any, is the caller's). `key` picks
  /// branches.
  PathLosses follow(const Ray& ray, const ElementHit& hit, std::uint64_t key,
                    const std::function<void(const LightArrival&)>& arrive) const;
  PathLosses follow(const Ray& ray, const ElementHit& hit, std::uint64_t key,
                    const std::function<void(const ElementHit&, const Spectrum&)>& arrive) const;
  /// The same by another caster of the same scene, such as ElementCaster::at() gives.
  PathLosses follow(const ElementCaster& caster, const Ray& ray, const ElementHit& hit,
                    std::uint64_t key,
                    const std::function<void(const LightArrival&)>& arrive) const;

 private:
  bool continue_at(const ElementCaster& caster, Ray& ray, const ElementHit& hit, std::uint64_t key,
                   Media& media, Spectrum& throughput, bool& through_panes_only,
                   PathLosses& losses) const;
  void absorb(const Ray& ray, const ElementHit& hit, const Media& media, Spectrum& throughput,
              PathLosses& losses) const;

  const Scene& scene_;
  const ElementCaster& caster_;
  int max_depth_ = 8;
  bool has_specular_ = false, absorbs_ = false;
  std::vector<char> specular_, diffuse_;
  std::vector<int> material_;            // per facet
  std::vector<Eigen::Vector3d> normal_;  // per facet; zero for spheres
  std::vector<const Sphere*> sphere_;    // per facet; null for polygons
  std::optional<FacetNormals> smooth_;   // null: the facets' own
};

}  // namespace lightwell
