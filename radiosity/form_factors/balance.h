#pragma once

#include <Eigen/Core>
#include <functional>

#include "radiosity/journal/journal_phase.h"

namespace lightwell {

/// Scale factors d > 0 with sum_j d_i S_ij d_j + d_i open_i = target_i for a symmetric S >= 0: the
/// symmetric scaling of Sinkhorn & Knopp 1967 in the square-root form of Knight, Ruiz & Ucar 2014.
/// `product(x)` is S x. Each column of `open` and `target` is a problem of its own. Empty rows and
/// rows of target <= 0 keep d = 1 or go to 0, and do not count in the error. A column ends when the
/// relative error of every row is below `tolerance`; all columns end after `max_iterations`.
/// Resumes from the state that `phase` holds.
Eigen::ArrayXXd symmetric_scaling(
    const std::function<Eigen::ArrayXXd(const Eigen::ArrayXXd&)>& product,
    const Eigen::ArrayXXd& open, const Eigen::ArrayXXd& target, JournalPhase phase = {},
    double tolerance = 1e-8, int max_iterations = 200);

}  // namespace lightwell
