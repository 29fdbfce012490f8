#include "scene/sampling.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

namespace lightwell {
namespace {

// splitmix64 (Steele, Lea & Flood 2014): a bijection with full avalanche.
std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

std::uint32_t reverse_bits(std::uint32_t x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  return __builtin_bswap32(x);
}

// Nested uniform (Owen) scrambling of the bits of x, most significant first: on reversed bits, a
// permutation in which each bit depends on lower bits only (Laine & Karras 2011; constants of
// Burley 2020's follow-up by Vegdahl).
std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
  x = reverse_bits(x);
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return reverse_bits(x);
}

using DirectionNumbers = std::array<std::uint32_t, 32>;

// Joe & Kuo 2008, "new-joe-kuo-6": degree s, polynomial a, initial m of dimensions 2 to 5.
DirectionNumbers direction_numbers(int s, std::uint32_t a, std::array<std::uint32_t, 3> m) {
  DirectionNumbers v{};
  for (int j = 0; j < 32; ++j) {
    if (j < s) {
      v[j] = m[j] << (31 - j);
      continue;
    }
    v[j] = v[j - s] ^ (v[j - s] >> s);
    for (int k = 1; k < s; ++k) v[j] ^= ((a >> (s - 1 - k)) & 1u) * v[j - k];
  }
  return v;
}

}  // namespace

std::uint64_t random_key(std::uint64_t a, std::uint64_t b, std::uint64_t c, std::uint64_t d) {
  return mix(mix(mix(mix(a) ^ b) ^ c) ^ d);
}

double random_uniform(std::uint64_t key) {
  return static_cast<double>(mix(key) >> 11) * 0x1p-53;
}

SobolPoints::SobolPoints(int count) : points_(count) {
  DirectionNumbers first{};
  for (int j = 0; j < 32; ++j) first[j] = 1u << (31 - j);
  const std::array<DirectionNumbers, 4> v = {first, direction_numbers(1, 0, {1}),
                                             direction_numbers(2, 1, {1, 3}),
                                             direction_numbers(3, 1, {1, 3, 1})};
  // Gray-code order (Antonov & Saleev 1979) visits the same points for every power of two.
  Eigen::Array<std::uint32_t, 4, 1> x;
  x.setZero();
  for (int i = 0; i < count; ++i) {
    points_[i] = x;
    const int bit = std::countr_one(static_cast<std::uint32_t>(i));
    for (int d = 0; d < 4; ++d) x[d] ^= v[d][bit];
  }
}

Eigen::Array4f SobolPoints::point(int i, std::uint64_t key) const {
  Eigen::Array4f result;
  points(i, key, {&result, 1});
  return result;
}

double SobolPoints::fifth(int i, std::uint64_t key) {
  static const DirectionNumbers v = direction_numbers(3, 2, {1, 1, 1});
  const auto index = static_cast<std::uint32_t>(i);
  std::uint32_t x = 0;
  for (std::uint32_t gray = index ^ (index >> 1); gray != 0; gray &= gray - 1) {
    x ^= v[static_cast<std::size_t>(std::countr_zero(gray))];
  }
  constexpr std::uint64_t dimension = 4;
  const std::uint32_t scrambled =
      owen_scramble(x, static_cast<std::uint32_t>(mix(key + dimension)));
  return static_cast<double>(scrambled) * 0x1p-32;
}

void SobolPoints::points(int first, std::uint64_t key, std::span<Eigen::Array4f> result) const {
  std::array<std::uint32_t, 4> seed;
  for (int d = 0; d < 4; ++d) {
    seed[d] = static_cast<std::uint32_t>(mix(key + static_cast<std::uint64_t>(d)));
  }
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto& point = points_[static_cast<std::size_t>(first) + i];
    for (int d = 0; d < 4; ++d) {
      // 24 bits: the most a float in [0,1) can hold without rounding up to 1.
      result[i][d] = static_cast<float>(owen_scramble(point[d], seed[d]) >> 8) * 0x1p-24f;
    }
  }
}

Eigen::Vector3d cosine_direction(float u, float v) {
  const double a = 2.0 * u - 1.0, b = 2.0 * v - 1.0;
  if (a == 0.0 && b == 0.0) return Eigen::Vector3d::UnitZ();
  constexpr double quarter_pi = std::numbers::pi / 4.0;
  const bool wide = std::abs(a) > std::abs(b);
  const double r = wide ? a : b;
  // Taylor series serve up to 45 degrees, to 2e-10, and give the same bits with every C library.
  const double phi = quarter_pi * (wide ? b / a : a / b), x2 = phi * phi;
  const double cosine =
      1 + x2 * (-1.0 / 2 + x2 * (1.0 / 24 + x2 * (-1.0 / 720 + x2 * (1.0 / 40320))));
  const double sine =
      phi * (1 + x2 * (-1.0 / 6 + x2 * (1.0 / 120 + x2 * (-1.0 / 5040 + x2 * (1.0 / 362880)))));
  const double near = r * cosine, far = r * sine;
  const double x = wide ? near : far, y = wide ? far : near;
  return {x, y, std::sqrt(std::max(0.0, 1.0 - x * x - y * y))};
}

void tangent_frame(const Eigen::Vector3d& n, Eigen::Vector3d& first, Eigen::Vector3d& second) {
  const double sign = std::copysign(1.0, n.z());
  const double a = -1.0 / (sign + n.z());
  const double b = n.x() * n.y() * a;
  first = {1.0 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()};
  second = {b, sign + n.y() * n.y() * a, -n.y()};
}

TableDraw draw_from_table(std::span<const double> cdf, double u) {
  const double wanted = u * cdf.back();
  auto i = static_cast<std::size_t>(std::ranges::upper_bound(cdf, wanted) - cdf.begin());
  i = std::min(i, cdf.size() - 1);
  while (i > 0 && !(cdf[i] > cdf[i - 1])) --i;
  const double low = i > 0 ? cdf[i - 1] : 0.0;
  const double share = cdf[i] - low;
  return {.index = static_cast<int>(i),
          .within = std::clamp((wanted - low) / share, 0.0, 1.0),
          .share = share};
}

Eigen::Vector3d triangle_point(float u, float v) {
  const double root = std::sqrt(static_cast<double>(u));
  return {1.0 - root, root * (1.0 - v), root * v};
}

}  // namespace lightwell
