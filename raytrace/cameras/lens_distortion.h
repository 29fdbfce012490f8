#pragma once

#include <Eigen/Core>
#include <optional>

#include "scene/camera.h"

namespace lightwell {

/// Returns where a lens shows what a pinhole shows at `p`, see LensDistortion.
Eigen::Vector2d distorted(const LensDistortion& lens, const Eigen::Vector2d& p);

/// Derivative of distorted().
Eigen::Matrix2d distortion_slope(const LensDistortion& lens, const Eigen::Vector2d& p);

/// Greatest distance from the picture's middle, before distortion, at which farther points are
/// shown farther out too: beyond, the polynomial folds the picture over itself. Infinite: nowhere.
double fold_radius(const LensDistortion& lens);

/// Inverse of distorted() within `fold`, the result of fold_radius(); empty where the lens shows
/// nothing. Newton's method from the solution without tangential terms, which a bracket holds, so
/// that it is always found.
std::optional<Eigen::Vector2d> undistorted(const LensDistortion& lens, const Eigen::Vector2d& q,
                                           double fold);

}  // namespace lightwell
