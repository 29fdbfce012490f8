#pragma once

#include <Eigen/Core>

#include "scene/coat.h"
#include "scene/relief.h"

namespace lightwell {

/// Factor of the light that a surface takes from a direction, over that of a flat surface without a
/// coat: CoatedBase::factor() of the angle to the normal, ReliefSlope::gain(), or the product of
/// both. Of even light the mean of either is 1.
struct ReceiverGain {
  const CoatedBase* base = nullptr;     ///< null: no coat
  const ReliefSlope* relief = nullptr;  ///< null: no relief

  /// True if the factor is 1 for all directions.
  bool is_plain() const { return !base && !relief; }
  /// `direction`, of any length, points to where light comes from, and `normal` is unit.
  double factor(const Eigen::Vector3d& direction, const Eigen::Vector3d& normal) const {
    double result = base ? base->factor(direction.normalized().dot(normal)) : 1.0;
    if (relief) result *= relief->gain(direction);
    return result;
  }
};

}  // namespace lightwell
