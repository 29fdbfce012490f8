#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/many_lights/light_tree.h"
#include "scene/specular.h"

namespace lightwell {

/// A point of a rough surface, as it chooses lamps: by its lobe. The references must outlive this.
class LobeView {
 public:
  LobeView(const Eigen::Vector3d& position, const SurfaceInteraction& interaction,
           const RoughLobe& lobe);

  const Eigen::Vector3d& position() const { return position_; }
  /// About the most that the lights of a node may add to the light off the surface, mean of the
  /// bands: intensity over squared distance, times the density of the lobe in that direction of the
  /// node's ball that is nearest to a smooth surface's. Above 0 if the intensity is.
  double weight(const LightNode& node) const;
  /// The same for light of this irradiance, W/m^2, from one direction.
  double weight(double irradiance, const Eigen::Vector3d& direction) const;

 private:
  double density_about(const Eigen::Vector3d& direction, double sine) const;

  Eigen::Vector3d position_;
  const SurfaceInteraction& interaction_;
  const RoughLobe& lobe_;
  SmoothScattering smooth_;  // directions off a smooth surface
};

/// A sampled direction towards a lamp.
struct LampSample {
  const Emitter* emitter = nullptr;
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit
  double distance = 0.0;                                 ///< m
  double density = 0.0;                                  ///< probability density, 1/sr
};

/// A sampled source without surface.
struct DrawnSource {
  const FreeSource* source = nullptr;
  double chance = 1.0;
};

/// Sampled directions towards the lights of DirectLight, for rough surfaces. A highlight sampled
/// by the lobe alone is noisy, since few directions of the lobe meet a small lamp (Veach & Guibas
/// 1995).
///
/// Lights are drawn by halves of LightTree in proportion to LobeView::weight(), so that a draw of
/// 100 000 lamps costs about twice one of 300. Points of polygons are uniform in area, points of
/// spheres uniform in solid angle.
class LampSamples {
 public:
  explicit LampSamples(const DirectLight& direct_light);

  /// Draws a direction to an emitter from a point on a facet by three numbers in [0,1). Empty if
  /// the drawn lamp sends no light to the point or is the facet itself. Visibility is not tested.
  std::optional<LampSample> draw(const LobeView& from, int facet, double which, double u,
                                 double v) const;
  /// Probability density of draw(), 1/sr, in the direction of a point on the lit side of a facet; 0
  /// if the facet is no emitter of DirectLight.
  double density(const LobeView& from, const Eigen::Vector3d& point, int facet) const;

  /// Draws one of the sources without surface, but not the sky's dome, by `which` in [0,1); empty
  /// if no such source sends light to the point.
  std::optional<DrawnSource> draw_source(const LobeView& from, double which) const;

 private:
  double density_of(double share, const Emitter& emitter, const Eigen::Vector3d& from,
                    const Eigen::Vector3d& direction, double distance) const;

  const std::vector<Emitter>& emitters_;
  const std::vector<FreeSource>& sources_;
  std::optional<LightTree> tree_{}, tree_of_lamps_{};  // of emitters; of sources
  std::vector<int> distant_{};                         // sources that are far away
  std::vector<int> of_facet_{};                        // emitter per facet; -1: none
};

}  // namespace lightwell
