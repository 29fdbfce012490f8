#include "scene/hemisphere_sets.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/parallel.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr std::uint64_t set_key = 0x5e75;
// Enough for neighbours to differ, few enough to stay in the second-level cache.
constexpr int most_sets = 64, fewest_sets = 8, points_in_cache = 1 << 16;

}  // namespace

HemisphereSets::HemisphereSets(int count)
    : count_(count), sets_(std::clamp(points_in_cache / count, fewest_sets, most_sets)) {
  const SobolPoints sobol(count);
  const auto size = static_cast<std::size_t>(count);
  points_.resize(size * static_cast<std::size_t>(sets_));
  parallel_for(sets_, 1, [&](int begin, int end) {
    std::vector<Eigen::Array4f> points(size);
    for (int set = begin; set < end; ++set) {
      sobol.points(0, random_key(static_cast<std::uint64_t>(set), set_key), points);
      HemispherePoint* at = points_.data() + static_cast<std::size_t>(set) * size;
      for (const Eigen::Array4f& p : points) {
        // The first two dimensions are stratified best; directions gain most by it.
        const Eigen::Vector3f d = cosine_direction(p[0], p[1]).cast<float>();
        *at++ = {p[2], p[3], d.x(), d.y(), d.z()};
      }
    }
  });
}

HemisphereSets::Draw HemisphereSets::draw(std::uint64_t key) const {
  const auto set = std::min(static_cast<int>(random_uniform(key) * sets_), sets_ - 1);
  const double turn = 2.0 * std::numbers::pi * random_uniform(key + 1);
  Draw draw;
  draw.points_ = {points_.data() + static_cast<std::ptrdiff_t>(set) * count_,
                  static_cast<std::size_t>(count_)};
  draw.shift_ = {random_uniform(key + 2), random_uniform(key + 3)};
  draw.cosine_ = std::cos(turn);
  draw.sine_ = std::sin(turn);
  return draw;
}

Eigen::Matrix3d HemisphereSets::Draw::frame(const Eigen::Vector3d& normal) const {
  Eigen::Vector3d a, b;
  tangent_frame(normal, a, b);
  Eigen::Matrix3d frame;
  frame << cosine_ * a + sine_ * b, cosine_ * b - sine_ * a, normal;
  return frame;
}

}  // namespace lightwell
