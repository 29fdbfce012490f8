#include "viewer/export/fill_texels.h"

#include <algorithm>
#include <cstddef>

namespace lightwell {
namespace {

/// Calls see(j) for the up to eight neighbours of texel i.
template <class See>
void around(int size, int i, See&& see) {
  const int x = i % size, y = i / size;
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, size - 1); ++v) {
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, size - 1); ++u) {
      if (u != x || v != y) see(v * size + u);
    }
  }
}

// Grows known texels by rings. A ring counts as known only when the whole ring is computed: texels
// of one ring do not average each other, neither around a chart nor where two charts' rings meet.
void grow(int size, int rings, std::vector<char>& is_known, std::span<BandArray* const> pictures) {
  constexpr char is_asked = 2;
  std::vector<int> ring;
  for (int i = 0; i < size * size; ++i) {
    if (is_known[i] == 1) ring.push_back(i);
  }
  for (int r = 0; r < rings && !ring.empty(); ++r) {
    std::vector<int> next;
    for (const int i : ring) {
      around(size, i, [&](int j) {
        if (is_known[j] != 0) return;
        is_known[j] = is_asked;
        next.push_back(j);
      });
    }
    for (const int j : next) {
      for (BandArray* picture : pictures) picture->row(j).setZero();
      float count = 0.0f;
      around(size, j, [&](int i) {
        if (is_known[i] != 1) return;
        count += 1.0f;
        for (BandArray* picture : pictures) picture->row(j) += picture->row(i);
      });
      for (BandArray* picture : pictures) picture->row(j) /= count;
    }
    for (const int j : next) is_known[j] = 1;
    ring = std::move(next);
  }
}

// Fills unknown texels from a picture of half the size, recursively.
void pull_push(int size, const std::vector<char>& is_known, BandArray& picture) {
  if (size == 1) return;
  const int half = (size + 1) / 2;
  BandArray coarse = BandArray::Zero(static_cast<Eigen::Index>(half) * half, picture.cols());
  std::vector<char> is_coarse_known(static_cast<std::size_t>(half) * half, 0);
  std::vector<float> count(is_coarse_known.size(), 0.0f);
  const auto parent = [&](int i) { return i / size / 2 * half + i % size / 2; };
  for (int i = 0; i < size * size; ++i) {
    if (is_known[i] == 0) continue;
    coarse.row(parent(i)) += picture.row(i);
    count[parent(i)] += 1.0f;
  }
  for (std::size_t c = 0; c < count.size(); ++c) {
    if (count[c] == 0.0f) continue;
    is_coarse_known[c] = 1;
    coarse.row(static_cast<Eigen::Index>(c)) /= count[c];
  }
  pull_push(half, is_coarse_known, coarse);
  for (int i = 0; i < size * size; ++i) {
    if (is_known[i] == 0) picture.row(i) = coarse.row(parent(i));
  }
}

}  // namespace

void fill_texels(int size, std::vector<char> is_known, int rings,
                 std::span<BandArray* const> pictures) {
  if (std::ranges::none_of(is_known, [](char known) { return known != 0; })) return;
  grow(size, rings, is_known, pictures);
  for (BandArray* picture : pictures) pull_push(size, is_known, *picture);
}

}  // namespace lightwell
