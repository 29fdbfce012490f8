#pragma once

#include <Eigen/Core>
#include <functional>

#include "radiosity/journal/journal_phase.h"

namespace lightwell {

/// Scale factors d > 0 with sum_j d_i S_ij d_j + d_i open_i = target_i for a symmetric S >= 0: the
/// symmetric scaling of Sinkhorn & Knopp 1967 in the square-root form of Knight, Ruiz & Ucar 2014.
/// `product(x)` is S x. One problem for each column of `open` and `target`; they do not touch each
/// other. Rows with nothing in them, or with target <= 0, keep d = 1 or go to 0 and are not counted
/// in the error. A column ends when every row is within `tolerance` (relative), all end after
/// `max_iterations`. Goes on from the state that `phase` holds.
Eigen::ArrayXXd symmetric_scaling(
    const std::function<Eigen::ArrayXXd(const Eigen::ArrayXXd&)>& product,
    const Eigen::ArrayXXd& open, const Eigen::ArrayXXd& target, JournalPhase phase = {},
    double tolerance = 1e-8, int max_iterations = 200);

}  // namespace lightwell
