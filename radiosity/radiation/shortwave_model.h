#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "radiosity/radiation/dome_views.h"
#include "radiosity/radiation/point_exposure.h"
#include "radiosity/radiation/shortwave.h"
#include "radiosity/radiation/sky_exposure.h"
#include "scene/sky.h"
#include "scene/sky_patch_means.h"
#include "scene/sky_patches.h"

namespace lightwell {

/// Sun and sky of an instant, or their means over an hour.
struct SunAndSky {
  Eigen::Vector3d sun = Eigen::Vector3d::UnitZ();  ///< unit, towards the sun
  double direct = 0.0;                             ///< across the sun's rays, W/m^2, >= 0
  double diffuse = 0.0;                            ///< of the sky on open level ground, W/m^2, >= 0
  /// Radiance over the dome, about `sun`; empty: even.
  std::optional<SkyGradation> gradation{};
};

/// The same light under Perez' all-weather sky (perez_sky()), whose state is kept within the
/// model's data; `day_of_year` counts from 1. Without light of the dome, or with the sun below the
/// horizon of `up`, the sky stays even.
SunAndSky under_perez_sky(SunAndSky light, const Eigen::Vector3d& up, int day_of_year);

/// Light of an instant, W/m^2, on rows and at points.
struct ShortwaveInstant {
  Eigen::ArrayXd direct{}, diffuse{};  ///< of rows
  ShortwaveExchange exchange{};
  Eigen::ArrayXd point_direct{}, point_diffuse{}, point_reflected{};
};

/// View factors and points prepared for sun and sky of many instants: what does not depend on the
/// sun is computed once. Keeps references to the view factors and to the caster, which is of their
/// mesh.
class ShortwaveModel {
 public:
  /// `up`: unit, to the zenith. Throws Interrupted if `progress` requests a stop.
  ShortwaveModel(const FacetViewFactors& found, const ElementCaster& caster,
                 std::span<const SurfacePoint> points, const Eigen::Vector3d& up,
                 const Progress& progress = {});

  /// Finds what rows and points see of each of 577 patches of the dome (Reinhart's, of the second
  /// subdivision), which skies with a gradation need. Takes 2.3 kB for each row and point. Throws
  /// Interrupted if `progress` requests a stop.
  void see_dome(const Progress& progress = {});

  const Eigen::ArrayXd& sky_view() const { return sky_view_; }
  const PointViews& points() const { return views_; }

  /// Calls `each` with the number of every instant and its light, in order. `albedo`: of the rows,
  /// [0, highest_albedo]; `rays`: see sun_factors(). Throws as shortwave_exchange() does,
  /// Interrupted if `progress` requests a stop, and std::logic_error for a gradation without
  /// see_dome().
  void run(std::span<const SunAndSky> instants, const Eigen::ArrayXd& albedo, int rays,
           const std::function<void(int number, const ShortwaveInstant&)>& each,
           const Progress& progress = {}) const;

 private:
  const FacetViewFactors& found_;
  const ElementCaster& caster_;
  std::vector<SurfacePoint> points_;
  /// The dome in patches, and the views of it.
  struct Dome {
    explicit Dome(const Eigen::Vector3d& up);
    /// pi times the radiance of each patch, for 1 W/m^2 on open level ground.
    Eigen::VectorXf exitances(const SunAndSky& light) const;

    SkyPatches patches;
    SkyPatchMeans means;
    DomeViews of_rows{}, of_points{};
  };
  ShortwaveInstant first_light(const SunAndSky& light, int rays, const Progress& progress) const;

  Eigen::Vector3d up_;
  Eigen::ArrayXd sky_view_;
  PointViews views_;
  std::optional<Dome> dome_{};
};

}  // namespace lightwell
