#pragma once

#include <cstdint>
#include <vector>

namespace lightwell {

/// Appends the triangles of a convex polygon, a fan about its first corner, whose `count` corners
/// have the numbers from `first` on.
inline void append_fan(std::uint32_t first, std::uint32_t count,
                       std::vector<std::uint32_t>& triangles) {
  for (std::uint32_t c = 1; c + 1 < count; ++c) {
    for (const std::uint32_t corner : {0u, c, c + 1}) triangles.push_back(first + corner);
  }
}

}  // namespace lightwell
