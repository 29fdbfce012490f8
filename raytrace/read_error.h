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
Eigen::ArrayXd read_errors(const LitScene& lit, const RadiositySolution& solution,
                           const BandArray& radiosity, const GatherPoints& points);

}  // namespace lightwell
