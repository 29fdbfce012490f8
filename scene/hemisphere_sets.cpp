#include "scene/hemisphere_sets.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Enough sets for neighbouring patches to differ, few enough for the second-level cache.
constexpr int most_sets = 64, fewest_sets = 8, points_in_cache = 1 << 16;

// Index of a direction, projected onto the unit disc, along a curve that keeps neighbours together
// (Morton 1966).
unsigned place_on_curve(const HemispherePoint& point) {
  constexpr int bits = 8;
  const auto cell = [](float x) { return static_cast<unsigned>((0.5f * x + 0.5f) * 255.0f); };
  const unsigned column = cell(point.x), row = cell(point.y);
  unsigned index = 0;
  for (int i = 0; i < bits; ++i) {
    index |= (column >> i & 1) << (2 * i) | (row >> i & 1) << (2 * i + 1);
  }
  return index;
}

void sort_by_direction(std::span<HemispherePoint> points) {
  std::vector<std::pair<unsigned, HemispherePoint>> sorted;
  sorted.reserve(points.size());
  for (const HemispherePoint& p : points) sorted.emplace_back(place_on_curve(p), p);
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    return std::pair(a.first, a.second.rank) < std::pair(b.first, b.second.rank);
  });
  std::transform(sorted.begin(), sorted.end(), points.begin(),
                 [](const auto& p) { return p.second; });
}

}  // namespace

HemisphereSets::HemisphereSets(int count, bool with_planar_points)
    : count_(count), sets_(std::clamp(points_in_cache / count, fewest_sets, most_sets)) {
  const SobolPoints sobol(count);
  const auto size = static_cast<std::size_t>(count);
  points_.resize(size * static_cast<std::size_t>(sets_));
  if (with_planar_points) planar_points_.resize(points_.size());
  parallel_for(sets_, 1, [&](int begin, int end) {
    std::vector<Eigen::Array4f> points(size);
    for (int set = begin; set < end; ++set) {
      sobol.points(0, random_key(static_cast<std::uint64_t>(set), RandomPurpose::hemisphere_sets),
                   points);
      const std::size_t begin_of_set = static_cast<std::size_t>(set) * size;
      const auto made = std::span(points_).subspan(begin_of_set, size);
      for (std::size_t i = 0; i < size; ++i) {
        const Eigen::Array4f& p = points[i];
        // The first two dimensions are stratified best, and directions gain most by stratification.
        const Eigen::Vector3f d = cosine_direction(p[0], p[1]).cast<float>();
        made[i] = {d.x(), d.y(), d.z(), static_cast<int>(i % block)};
        if (with_planar_points) planar_points_[begin_of_set + i] = {p[2], p[3]};
      }
      for (std::size_t first = 0; first < size; first += block) {
        sort_by_direction(made.subspan(first, std::min<std::size_t>(block, size - first)));
      }
    }
  });
}

HemisphereSets::Draw HemisphereSets::draw(std::uint64_t key) const {
  const auto set = std::min(static_cast<int>(random_uniform(key) * sets_), sets_ - 1);
  const double turn = 2.0 * std::numbers::pi * random_uniform(key + 1);
  const auto size = static_cast<std::size_t>(count_), first = static_cast<std::size_t>(set) * size;
  Draw draw;
  draw.points_ = std::span(points_).subspan(first, size);
  if (!planar_points_.empty()) draw.planar_points_ = std::span(planar_points_).subspan(first, size);
  draw.shift_ = {random_uniform(key + 2), random_uniform(key + 3)};
  draw.cosine_ = std::cos(turn);
  draw.sine_ = std::sin(turn);
  return draw;
}

std::span<const HemispherePoint> HemisphereSets::Draw::points(
    int first, int size, std::vector<HemispherePoint>& some) const {
  const auto begin = static_cast<std::size_t>(first);
  const auto whole = points_.subspan(begin, std::min<std::size_t>(block, points_.size() - begin));
  if (static_cast<std::size_t>(size) == whole.size()) return whole;
  some.clear();
  std::copy_if(whole.begin(), whole.end(), std::back_inserter(some),
               [&](const HemispherePoint& point) { return point.rank < size; });
  return some;
}

Eigen::Matrix3d HemisphereSets::Draw::frame(const Eigen::Vector3d& normal) const {
  Eigen::Vector3d a, b;
  tangent_frame(normal, a, b);
  Eigen::Matrix3d frame;
  frame << cosine_ * a + sine_ * b, cosine_ * b - sine_ * a, normal;
  return frame;
}

}  // namespace lightwell
