#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "viewer/export/page_data.h"

namespace lightwell {

/// Values of the page at the offset that the page's description has.
template <class T>
std::vector<T> values_at(const PageData& page, const nlohmann::ordered_json& place,
                         std::size_t count) {
  const std::size_t offset = place["offset"];
  EXPECT_EQ(offset % sizeof(T), 0u);  // typed arrays need aligned offsets
  EXPECT_LE(offset + count * sizeof(T), page.bytes.size());
  std::vector<T> values(count);
  std::memcpy(values.data(), page.bytes.data() + offset, count * sizeof(T));
  return values;
}

/// The value of an IEEE 754 binary16 number.
inline float half_to_float(std::uint16_t bits) {
  const int exponent = bits >> 10 & 31, fraction = bits & 1023;
  const double size =
      exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  return static_cast<float>(bits & 0x8000 ? -size : size);
}

}  // namespace lightwell
