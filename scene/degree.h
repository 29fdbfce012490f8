#pragma once

#include <numbers>

namespace lightwell {

/// One degree in radians.
inline constexpr double degree = std::numbers::pi / 180.0;

}  // namespace lightwell
