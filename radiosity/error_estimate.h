#pragma once

#include "mesh/elements/element_caster.h"
#include "radiosity/emitters/direct_light.h"
#include "radiosity/emitters/lit_scene.h"
#include "radiosity/solve.h"

namespace lightwell {

struct ErrorEstimate {
  double square = 0.0;     ///< mean of the squared relative error over the places
  double deviation = 0.0;  ///< that one's standard error
  double noise =
      0.0;          ///< in the error: what the rays of both gathers leave, as they tell themselves
  int batches = 1;  ///< of places

  double error() const;  ///< one standard error up
  double least() const;  ///< and one down
};

/// Relative RMS error of interpolated irradiance over the area that reflects: at random places,
/// `options.error_points` or more (see estimate_points), against gathers with twice the rays of
/// the solution's or more (see estimate_rays) and other random numbers. Those read the solution's
/// own light: what is too much or too little of it in all, such as power that interpolation cuts
/// off, comes back in them, by as much as reflections are of all light, and is reckoned with. The
/// noise of both is left in, which makes up for the rest of what both have in common. Half of the
/// places are spread evenly, half go by the squared error that refinement says is left in elements,
/// or where nothing was refined by the range of their corners (importance sampling: few places tell
/// of errors that sit in few). What is given is the upper end of what is known: the mean square and
/// its standard error. What it is relative to, error_reference() says. `caster` is of the
/// solution's mesh.
///
/// `of_elements`, if given, gets the estimated RMS error of interpolation over each element, for
/// solutions of which refinement tells none: it is in proportion to the range of the corners'
/// irradiance, no less than 5 %, and in the mean square over the places what is off there beyond
/// the noise of both gathers. (Unchanged if there is nothing to go by.)
///
/// Each `batch`, from 0, is of other places and rays.
ErrorEstimate estimate_error(const LitScene& lit, const SolveOptions& options,
                             const RadiositySolution& solution,
                             Eigen::ArrayXf* of_elements = nullptr, int batch = 0);

/// Of the places of both, batches being of as many each.
ErrorEstimate joined(const ErrorEstimate& a, const ErrorEstimate& b);

}  // namespace lightwell
