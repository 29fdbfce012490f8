#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/form_factors/facet_view_factors.h"
#include "scene/progress.h"
#include "scene/surface_point.h"

namespace lightwell {

/// Shares of the hemisphere of points, weighted by the cosine, that sky and rows cover.
struct PointViews {
  Eigen::ArrayXd sky{};                         ///< sky view factor of each point, [0, 1]
  std::vector<std::vector<FormFactor>> rows{};  ///< of each point, by row; FormFactor::patch: a row
};

/// Sky and rows as points see them, by 16384 rays each, stratified: the standard error of a share p
/// is below that of independent rays, sqrt(p (1 - p) / 16384) <= 4e-3. Light from below the horizon
/// and from black backs is none.
///
/// `up`: unit, to the zenith. Throws Interrupted if `progress` requests a stop.
PointViews point_views(const FacetViewFactors& found, const ElementCaster& caster,
                       std::span<const SurfacePoint> points, const Eigen::Vector3d& up,
                       const Progress& progress = {});

/// Cosine to the sun at each point that sees the middle of the sun, 0 at others, [0, 1]. `sun`:
/// unit, towards the sun.
Eigen::ArrayXd point_sun_factors(const ElementCaster& caster, std::span<const SurfacePoint> points,
                                 const Eigen::Vector3d& sun);

/// Irradiance of each point by what rows reflect, sum_j F_j albedo_j E_j, W/m^2. `E`: irradiance of
/// the rows with all reflections, W/m^2.
Eigen::ArrayXd point_reflections(const PointViews& views, const Eigen::ArrayXd& albedo,
                                 const Eigen::ArrayXd& E);

}  // namespace lightwell
