#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>

#include "mesh/elements/element_caster.h"
#include "radiosity/sky/noise_goal.h"
#include "radiosity/sky/sky_cells.h"
#include "radiosity/sky/sky_sites.h"
#include "radiosity/visibility/clear_panes.h"
#include "scene/receiver_gain.h"
#include "scene/sampling.h"
#include "scene/scene.h"
#include "scene/surface_point.h"

namespace lightwell {

/// Rays of a point to the cells that its site knows as open: `first`, and `most` more unless all of
/// the first get out. A third as many go to the other cells.
struct SkyEffort {
  int first = 32;
  int most = 128;  ///< 1 to most_sky_rays
  /// Noise to reach, if set. The first rays then only estimate the noise, and as many follow as
  /// reach the goal by themselves: at least half of `first`, at most `goal.most_times` times `most`
  /// and `first` more. Otherwise `most` rays follow, and all rays count.
  NoiseGoal goal{};
};
constexpr int most_sky_rays = 1 << 16;

/// Irradiance of a point from the dome.
struct SkyGlow {
  Spectrum irradiance{};  ///< W/m^2
  /// Estimated standard error, mean of the bands, W/m^2: little above the true one (see SkyLight).
  double noise = 0.0;
  double gain = 1.0;  ///< mean of the receiver's factor over the light, which `irradiance` has
};

/// About the irradiance that a point gets from the dome, in steps of the cosine to its normal.
struct SkyByCosine {
  static constexpr int steps = 32;
  std::array<double, steps> light{};   ///< W/m^2, mean of the bands
  std::array<double, steps> cosine{};  ///< mean over the light of each step

  /// The light with CoatedBase::factor(), and without it.
  Eigen::Array2d at_base(const CoatedBase& base) const;
};

/// Irradiance from the dome of a Sky, without its sun, which is another source.
///
/// The irradiance that each cell of the dome (SkyCells) gives an unobstructed point is known. A
/// window shows a small part of the dome, so rays are not spread evenly: SkySites says through
/// which cells rays get out near the point, and each cell gets rays in proportion to its
/// unobstructed irradiance times the weight of its site. Some rays go to the other cells, weighted
/// accordingly, so that the mean is right wherever the site is wrong.
///
/// For the cells that the site knows as open, the estimate is a control variate: the irradiance
/// that rays find, minus the irradiance that the same rays would find without any occluder, times
/// the visible share, plus the known irradiance times that share. An unobstructed point has no
/// noise. Where less than half is visible, the light that rays find is the estimate by itself.
///
/// Seams of seam_share let no light through. The walls of a house that are open at an edge by the
/// rounding of their vertices would show single bright vertices: one ray of thousands gets out
/// there, and carries the light of all.
///
/// Each ray lies in a step of its own along the curve of the cells. Pairs of neighbouring steps
/// tell the noise: the mean of (a - b)^2 is the variance of a + b plus the squared difference of
/// their means (collapsed strata, Cochran 1977).
class SkyLight {
 public:
  /// `scene` must have a sky. Finds what the surfaces see of the sky where points ask for it (see
  /// SkySites); the mesh of `caster` must outlive the light, or last until find_all().
  SkyLight(const Scene& scene, const ElementCaster& caster);
  SkyLight(const SkyLight&) = delete;
  SkyLight& operator=(const SkyLight&) = delete;

  /// Finds what all surfaces see of the sky, with all threads.
  void find_all() { sites_.find_all(); }

  /// E per band, W/m^2, at a point. `key` decides the directions of the rays; panes dim the light
  /// that passes through them. E counts times the mean of `gain` over the light that the rays
  /// find.
  SkyGlow irradiance(const ElementCaster& caster, const SurfacePoint& at, std::uint64_t key,
                     const SkyEffort& effort = {}, const ReceiverGain& gain = {}) const;

  /// An estimate of E by a single ray, unbiased, for points that are themselves many samples: the
  /// noise is that of the light through the cells that the site knows as open.
  Spectrum irradiance_by_one_ray(const ElementCaster& caster, const SurfacePoint& at,
                                 std::uint64_t key, const ReceiverGain& gain = {}) const;

  /// About the light of the dome at a point by its angle, without rays of the point: that of the
  /// cells, as far as the rays of the point's site got out. Where nothing is known, the light of an
  /// unobstructed point.
  std::shared_ptr<const SkyByCosine> by_cosine(const SurfacePoint& at) const;
  /// About the share of points near `at` that see a unit direction: 0 or 1 in the open, or the
  /// share that the site's rays found. 1 where nothing is known.
  double open_share(const SurfacePoint& at, const Eigen::Vector3d& direction) const;

  /// A direction towards the dome, drawn as for irradiance_by_one_ray().
  struct Aim {
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit
    double density = 0.0;                                  ///< 1/sr; 0: no direction was found
  };
  /// The site that holds a point; null: nothing is known of the sky there.
  const SkySites::Site* site(const SurfacePoint& at) const { return sites_.find(at); }
  /// A direction by three random numbers in [0,1), towards what points of the site see of the dome.
  Aim aim(const SkySites::Site& site, double which, double u, double v) const;
  /// Density of aim()'s directions at a unit direction, 1/sr.
  double density(const SkySites::Site& site, const Eigen::Vector3d& direction) const;

  /// Irradiance of an unobstructed point: see SkyCells::unobstructed.
  Spectrum unobstructed(const Eigen::Vector3d& normal) const { return cells_.unobstructed(normal); }

 private:
  class Estimate;
  struct Draw;
  static Draw draw_cell(const SkySites::Site& site, double which);
  struct Share;
  struct Shares;
  void set_weights(Shares& shares) const;
  Shares shares_of(const SkySites::Weights& site, const Eigen::Vector3d& normal) const;
  SkyByCosine light_by_cosine(const SkySites::Site& site, const Eigen::Vector3d& normal) const;
  std::shared_ptr<const Shares> shares_at(const ElementCaster& caster, const SurfacePoint& at,
                                          std::uint64_t key) const;

  std::uint64_t number_ = 0;  // of this sky among all
  int bands_ = 0;
  double seam_ = 0.0;  // metres, the widest seam that stands for the rounding of vertices
  ClearPanes panes_;
  SkyCells cells_;
  SkySites sites_;
  SobolPoints sobol_;
};

}  // namespace lightwell
