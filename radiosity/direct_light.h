#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mesh/element_caster.h"
#include "scene/scene.h"

namespace lightwell {

/// An emitting facet whose light is computed by closed form times visibility, never left to chance.
struct Emitter {
  int facet = 0;        ///< scene-wide facet number
  Spectrum exitance{};  ///< M, W/m^2
  double area = 0.0;    ///< m^2, one side
  bool emits_both_sides = false;
  bool is_sphere = false;
  Sphere sphere{};
  /// Boundary first, then holes (opposite winding); counter-clockwise seen from the emitting front.
  std::vector<std::vector<Eigen::Vector3d>> loops{};
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  /// Triangles that tile the polygon, for sampling points on it, with their running share of the
  /// area.
  std::vector<std::array<Eigen::Vector3d, 3>> triangles{};
  std::vector<double> area_cdf{};
};

struct ShadowOptions {
  /// Shadow rays per emitter and point: `min_rays` stratified ones first; where they disagree, up
  /// to `max_rays`.
  int min_rays = 16;
  int max_rays = 64;
};

/// Light straight from the scene's emitters. Emitters are taken in order of falling exitance (one
/// exitance at a time) until a quarter of the scene's area is reached: those are small and bright,
/// and hemisphere sampling would miss them; what emits beyond that is large and is found by any
/// hemisphere of rays.
class DirectLight {
 public:
  DirectLight(const Scene& scene, const PatchMesh& mesh);

  const std::vector<Emitter>& emitters() const { return emitters_; }
  /// Whether the facet's emission is accounted for here (and must not be counted again by other
  /// rays).
  bool owns(int facet) const { return owned_[facet] != 0; }

  /// Irradiance E (W/m^2 per band) at a point with unit normal n, from all emitters, unoccluded
  /// closed form (Lambert's contour formula, Baum, Rushmeier & Winget 1989) times the visible
  /// share, which is the cosine-weighted share of shadow rays that get through. `facet` is where
  /// the point lies (-1: in free space); `key` decides the sample positions.
  Spectrum irradiance(const ElementCaster& caster, const Eigen::Vector3d& point,
                      const Eigen::Vector3d& normal, int facet, std::uint64_t key,
                      const ShadowOptions& options = {}) const;

 private:
  std::vector<Emitter> emitters_;
  std::vector<char> owned_;
  int bands_ = 0;
};

}  // namespace lightwell
