#pragma once

#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/solution/solution.h"

namespace lightwell {

/// Elements in gaps that are measured one by one. Models of many crumbs have a hundred thousand
/// elements in gaps, and those of a surface are much alike.
inline constexpr int most_gap_elements = 2048;

/// Raises RadiositySolution::interpolation_error of the elements that lie in narrow gaps, at least
/// in part: under another surface at less than 0.15 of their gap_sizes(). Light in a gap
/// falls off within about the gap's width, which the vertices of larger elements do not sample.
/// Inside these elements irradiance is gathered at four points, and the RMS difference from the
/// interpolated one becomes the element's error where it is greater. An element with a dark corner
/// has the error of light that the corners' rays may have missed.
///
/// At most `most` elements are measured one by one (see measure_inside()).
///
/// `radiosity` is the result of gatherable_radiosity() for the solution; null: found here.
///
/// Does nothing without an error estimate. The caster of `lit` is of the solution's mesh; `gather`
/// decides the shadow rays. Throws Interrupted when progress says stop.
void add_gap_errors(const LitScene& lit, const GatherOptions& gather, RadiositySolution& solution,
                    int most = most_gap_elements, const BandArray* radiosity = nullptr);

}  // namespace lightwell
