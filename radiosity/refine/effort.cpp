#include "radiosity/refine/effort.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lightwell {

// The numbers of rays and patches were set by whole solves: docs/figures.md ("Rooms") has the error
// and the time of two rooms for several targets. Neither number has a measurement of its own.
int form_factor_rays(double target, int most) {
  if (!(target > 0.0)) return most;
  constexpr double rays_for_one_percent = 128.0, fewest = 64.0;
  const double wanted = std::clamp(rays_for_one_percent * 0.01 / target, fewest, 1e6);
  return std::min(most, static_cast<int>(std::bit_ceil(static_cast<unsigned>(wanted))));
}

int patch_count_for(double target, int most) {
  if (!(target > 0.0)) return most;
  constexpr double patches_for_two_percent = 800.0, fewest = 600.0;
  const double wanted = std::clamp(patches_for_two_percent * 0.02 / target, fewest, 1e6);
  return std::min(most, static_cast<int>(std::lround(wanted)));
}

int rays_for_noise(int rays, double found, double target) {
  constexpr double fewest = 128.0;
  const double wanted = rays * std::pow(found / target, 1.0 / noise_order);
  const double enough = std::clamp(wanted, fewest, double{most_gather_rays});
  const auto whole = static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::ceil(enough))));
  for (const int eighths : {5, 6, 7}) {
    const int less = eighths * (whole / 8);
    if (less >= enough) return less;
  }
  return whole;
}

int estimate_points(int asked, std::int64_t vertices) {
  // 512 points give an error to some 10 %, eight times as many to less than 4 %.
  constexpr std::int64_t share = 32, most_times = 8;
  std::int64_t points = asked;
  while (points > 0 && points < most_times * asked && 2 * points * share <= vertices) points *= 2;
  return static_cast<int>(points);
}

int estimate_rays(int rays, std::int64_t vertices, int points) {
  constexpr std::int64_t share = 8, often = 4;
  constexpr int fewest = 256;
  const bool is_cheap = often * points * share <= vertices;
  return std::max((is_cheap ? 4 : 2) * rays, fewest);
}

}  // namespace lightwell
