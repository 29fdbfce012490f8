#pragma once

#include <Eigen/Core>

#include "mesh/elements/element_caster.h"
#include "radiosity/form_factors/facet_view_factors.h"
#include "scene/progress.h"

namespace lightwell {

/// Sky view factor of each row, [0, 1]: share of what a row sends out that reaches the dome above
/// the horizon. With a dome of even radiance L, the row's irradiance is pi L times the factor; the
/// factor of a point is (1 + cos tilt) / 2 where nothing is in the way.
///
/// The share that meets no row is that of the view factors; rays tell which part of the share
/// passes above the horizon, and which part below it or to black backs. Without such losses the
/// factor is as exact as the view factors; otherwise its standard error is about 2e-3.
///
/// `up`: unit, to the zenith. Rows without area have 0. Throws Interrupted if `progress` requests a
/// stop.
Eigen::ArrayXd sky_view_factors(const FacetViewFactors& found, const Eigen::Vector3d& up,
                                const Progress& progress = {});

/// Fewest shadow rays of a patch: of one sun, and of many suns, whose errors average out.
inline constexpr int rays_of_one_sun = 1024, rays_of_many_suns = 64;

/// Mean over each row of the cosine to the sun where a point sees the sun's middle, and of 0 where
/// it does not, [0, 1]: irradiance by the sun over that across its rays. By shadow rays to `rays`
/// points of each patch, and to 16 times as many where some are lit and some are not. With 1024,
/// straight shadows along an edge of a rectangle are good to 1/1024 of the unshadowed value, others
/// to some 2e-3; with fewer, errors grow as the inverse of the number, or of its root.
///
/// `sun`: unit, towards the sun. `rays`: a power of two from 64 to 1024. Rows without area have 0.
/// Throws Interrupted if `progress` requests a stop.
Eigen::ArrayXd sun_factors(const FacetViewFactors& found, const ElementCaster& caster,
                           const Eigen::Vector3d& sun, int rays = rays_of_one_sun,
                           const Progress& progress = {});

/// The same with a caster of its own.
Eigen::ArrayXd sun_factors(const FacetViewFactors& found, const Eigen::Vector3d& sun);

}  // namespace lightwell
