#include "radiosity/effort.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lightwell {

int form_factor_rays(double target, int most) {
  if (!(target > 0.0)) return most;
  constexpr double rays_for_one_percent = 256.0, fewest = 64.0;
  const double wanted = std::clamp(rays_for_one_percent * 0.01 / target, fewest, 1e6);
  return std::min(most, static_cast<int>(std::bit_ceil(static_cast<unsigned>(wanted))));
}

int patch_count_for(double target, int most) {
  if (!(target > 0.0)) return most;
  constexpr double patches_for_two_percent = 800.0, fewest = 600.0;
  const double wanted = std::clamp(patches_for_two_percent * 0.02 / target, fewest, 1e6);
  return std::min(most, static_cast<int>(std::lround(wanted)));
}

int deepest_level(double target, int usual) {
  constexpr int deeper = 3;
  return target > 0.0 ? usual + deeper : usual;
}

int rays_for_noise(int rays, double found, double target) {
  constexpr double order = 2.0 / 3.0, fewest = 64.0, most = 1 << 15;
  const double wanted = rays * std::pow(found / target, 1.0 / order);
  return static_cast<int>(
      std::bit_ceil(static_cast<unsigned>(std::ceil(std::clamp(wanted, fewest, most)))));
}

int estimate_rays(int rays, std::int64_t vertices, int places) {
  constexpr std::int64_t share = 8, enough = 2048;
  const std::int64_t least = 2 * std::int64_t{rays};
  const std::int64_t cheap = vertices * rays / (share * std::max(places, 1));
  const auto wanted = static_cast<std::uint64_t>(std::clamp(cheap, least, std::max(least, enough)));
  return static_cast<int>(std::max<std::uint64_t>(std::bit_floor(wanted), least));
}

}  // namespace lightwell
