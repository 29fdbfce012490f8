#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>

#include "radiosity/radiation/point_exposure.h"
#include "radiosity/radiation/shortwave.h"
#include "radiosity/radiation/sky_exposure.h"

namespace lightwell {

/// Sun and even sky of an instant, or their means over an hour.
struct SunAndSky {
  Eigen::Vector3d sun = Eigen::Vector3d::UnitZ();  ///< unit, towards the sun
  double direct = 0.0;                             ///< across the sun's rays, W/m^2, >= 0
  double diffuse = 0.0;                            ///< of the sky on open level ground, W/m^2, >= 0
};

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

  const Eigen::ArrayXd& sky_view() const { return sky_view_; }
  const PointViews& points() const { return views_; }

  /// Calls `each` with the number of every instant and its light, in order. `albedo`: of the rows,
  /// [0, highest_albedo]; `rays`: see sun_factors(). Throws as shortwave_exchange() does, and
  /// Interrupted if `progress` requests a stop.
  void run(std::span<const SunAndSky> instants, const Eigen::ArrayXd& albedo, int rays,
           const std::function<void(int number, const ShortwaveInstant&)>& each,
           const Progress& progress = {}) const;

 private:
  const FacetViewFactors& found_;
  const ElementCaster& caster_;
  std::vector<SurfacePoint> points_;
  Eigen::ArrayXd sky_view_;
  PointViews views_;
};

}  // namespace lightwell
