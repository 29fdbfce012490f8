#include "mesh/geometry/cut_size.h"

#include <algorithm>
#include <cmath>

namespace lightwell {
namespace {

constexpr double whole = 1.0 - 1e-9;  // a length of 3.0000000001 patches is three patches

}  // namespace

int CutSize::patches(double length) const {
  return std::max(1, static_cast<int>(std::ceil(length / patch_size * whole)));
}

int CutSize::pieces(double length) const {
  if (length >= patch_size * whole) return elements_per_edge * patches(length);
  return std::max(1, static_cast<int>(std::ceil(length / element_size() * whole)));
}

}  // namespace lightwell
