#include "scene/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lightwell {
namespace {

MotionKey key_at(const RigidMotion& motion, double time) {
  const auto& keys = motion.keys;
  const auto next = std::ranges::upper_bound(keys, time, {}, &MotionKey::time);
  if (next == keys.begin()) return keys.front();
  if (next == keys.end()) return keys.back();
  const MotionKey &a = *(next - 1), &b = *next;
  const double part = (time - a.time) / (b.time - a.time);
  return {.time = time,
          .degrees = a.degrees + part * (b.degrees - a.degrees),
          .translation = a.translation + part * (b.translation - a.translation)};
}

}  // namespace

Eigen::Isometry3d RigidMotion::pose(double time) const {
  const MotionKey key = key_at(*this, time);
  const Eigen::AngleAxisd turn(key.degrees * std::numbers::pi / 180.0, axis);
  return Eigen::Translation3d(pivot + key.translation) * turn * Eigen::Translation3d(-pivot);
}

Eigen::Isometry3d RigidMotion::at(double time) const {
  return pose(time) * pose(rest_time).inverse();
}

std::string fault(const RigidMotion& motion) {
  if (motion.keys.size() < 2) {
    return fmt::format("has {}; give two at least, or leave the motion out",
                       motion.keys.empty() ? "no keys" : "one key");
  }
  constexpr double unit = 1e-6;
  if (!(std::abs(motion.axis.norm() - 1.0) <= unit)) return "has an axis that is not of length 1";
  if (!motion.pivot.allFinite()) return "has a pivot that is not finite";
  if (!std::isfinite(motion.rest_time)) return "rests at a time that is not finite";
  for (std::size_t i = 0; i < motion.keys.size(); ++i) {
    const MotionKey& key = motion.keys[i];
    if (!std::isfinite(key.time) || !std::isfinite(key.degrees) || !key.translation.allFinite()) {
      return fmt::format("has a number in key {} that is not finite", i + 1);
    }
    if (i > 0 && !(key.time > motion.keys[i - 1].time)) {
      return fmt::format(
          "has key {} at {:g} s, which is not after the one before it; times must "
          "ascend",
          i + 1, key.time);
    }
  }
  return {};
}

}  // namespace lightwell
