#pragma once

#include <Eigen/Core>

#include "radiosity/gather/final_gather.h"

namespace lightwell {

/// Error of illuminance that a gather at each point takes over from the solution whose light its
/// rays read, lx:
///
///     e = (1/N) sum_k rho_k e_k     e_k: illuminance_errors() where cosine-distributed ray k ends
///
/// as if the errors of all surfaces had the same sign: the mean of independent errors would vanish
/// with N, but errors of a solution last over whole surfaces. Rays continue through mirrors and
/// glass, and out of gaps, as a gather's rays do. 0 if the solution has no estimate of its errors.
///
/// In a gap few paths lead out to the light. A sure_gather() of `rays` rays in whose sets the exits
/// of the gap are looked for (GapExits) meets them, and so do the paths of e. Otherwise it may meet
/// none of them, so that its own noise says nothing of them. What none of n trials meets has a
/// probability below 3/n (odds of 19 to 1), so for the share g of rays that begin in a gap
///
///     e += g 3 / rays mean(rho E)     the mean over the lit surfaces of the part of the gap
Eigen::ArrayXd read_errors(const LitScene& lit, const RadiositySolution& solution,
                           const BandArray& radiosity, const GatherPoints& points, int rays);

}  // namespace lightwell
