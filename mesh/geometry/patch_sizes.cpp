#include "mesh/geometry/patch_sizes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lightwell {

using Eigen::Vector3d;

namespace {

// Longest patch of the surroundings as a share of its distance from what is near.
constexpr double of_distance = 0.5;
// A facet whose sizes differ by more levels is cut into patches of several sizes.
constexpr int even_levels = 1;

}  // namespace

PatchSizes::PatchSizes(const CutSize& near, double farthest, Scenery scenery)
    : near_(near),
      scenery_(std::move(scenery)),
      levels_(std::max(0, static_cast<int>(std::lround(std::log2(farthest / near.patch_size))))) {}

PatchSizes PatchSizes::with(int elements_per_edge) const {
  PatchSizes sizes = *this;
  sizes.near_.elements_per_edge = elements_per_edge;
  return sizes;
}

CutSize PatchSizes::at_level(int level) const {
  CutSize size = near_;
  size.patch_size = std::ldexp(near_.patch_size, level);
  return size;
}

int PatchSizes::level_at(double distance) const {
  const double times = of_distance * distance / near_.patch_size;
  return times > 1.0 ? std::min(levels_, static_cast<int>(std::log2(times))) : 0;
}

std::array<int, 2> PatchSizes::levels_within(const Vector3d& center, double radius) const {
  const double distance = scenery_.box.exteriorDistance(center);
  return {level_at(distance - radius), level_at(distance + radius)};
}

double PatchSizes::within(const Vector3d& center, double radius) const {
  return at_level(levels_within(center, radius)[0]).patch_size;
}

FacetSize PatchSizes::of_facet(int facet, const Eigen::AlignedBox3d& box) const {
  if (is_near(facet)) return {.cut = near_};
  double farthest = 0.0;
  for (int c = 0; c < 8; ++c) {
    const Vector3d corner = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(c));
    farthest = std::max(farthest, scenery_.box.exteriorDistance(corner));
  }
  const int low = level_at(scenery_.box.exteriorDistance(box)), high = level_at(farthest);
  return {.cut = at_level(low), .graded = high > low + even_levels ? this : nullptr};
}

CutSize PatchSizes::of_round_shape(int facet) const {
  return is_near(facet) ? near_ : at_level(levels_);
}

std::vector<double> PatchSizes::cuts(const Vector3d& a, const Vector3d& b) const {
  std::vector<double> cuts;
  const double length = (b - a).norm();
  const auto cut = [&](const auto& self, double from, double to) -> void {
    const double half = 0.5 * (to - from), middle = 0.5 * (from + to);
    const auto [low, high] = levels_within(a + middle * (b - a), half * length);
    if (high > low + even_levels) {
      self(self, from, middle);
      cuts.push_back(middle);
      self(self, middle, to);
      return;
    }
    const int pieces = at_level(low).pieces(2.0 * half * length);
    for (int k = 1; k < pieces; ++k) {
      cuts.push_back(from + (to - from) * (static_cast<double>(k) / pieces));
    }
  };
  cut(cut, 0.0, 1.0);
  return cuts;
}

double PatchSizes::elements(const FacetSize& size, double area, double boundary) const {
  const auto count = [&](const CutSize& cut, double of_area, double of_boundary) {
    // A strip narrower than an element is cut along its length alone.
    const double element = cut.element_size();
    return std::max(of_area / (element * element), of_boundary / (2.0 * element));
  };
  if (!size.graded) return std::max(1.0, count(size.cut, area, boundary));
  // Around what is near, about as much as a square twice as long; a ring twice as wide as the last
  // has as many patches.
  const double about = 2.0 * scenery_.box.diagonal().norm() + 2.0 * near_.patch_size;
  const double per_patch = static_cast<double>(near_.elements_per_edge) * near_.elements_per_edge;
  constexpr double of_ring = 64.0;
  return count(near_, std::min(area, about * about), std::min(boundary, 4.0 * about)) +
         of_ring * per_patch * levels_ + count(at_level(levels_), area, boundary);
}

}  // namespace lightwell
