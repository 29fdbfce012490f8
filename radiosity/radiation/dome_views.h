#pragma once

#include <Eigen/Core>
#include <span>

#include "mesh/elements/element_caster.h"
#include "radiosity/form_factors/facet_view_factors.h"
#include "scene/progress.h"
#include "scene/sky_patches.h"
#include "scene/surface_point.h"

namespace lightwell {

/// Shares of what rows or points send out that reach each patch of the sky, a line for each: with
/// patches of radiance L, irradiance is pi sum_p L_p views(i, p). With 577 patches a line takes
/// 2.3 kB.
using DomeViews = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Views of the dome from rows. Lines add up to the rows' sky view factors, `sky_view`.
///
/// Rays tell which share of each patch is open, 4096 of each facet of the mesh; the irradiance of
/// an unobstructed facet by each patch is known, so that such facets have no noise. In a street,
/// irradiances by three of Perez' skies are the integrals to 3e-3 of open ground's.
/// Throws Interrupted if `progress` requests a stop.
DomeViews dome_views(const FacetViewFactors& found, const ElementCaster& caster,
                     const SkyPatches& sky, const Eigen::ArrayXd& sky_view,
                     const Progress& progress = {});

/// The same from points, by 16384 rays each.
DomeViews point_dome_views(const ElementCaster& caster, std::span<const SurfacePoint> points,
                           const SkyPatches& sky, const Eigen::ArrayXd& sky_view,
                           const Progress& progress = {});

}  // namespace lightwell
