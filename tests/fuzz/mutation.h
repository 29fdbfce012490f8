// Parts that the changes of several formats share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "scene/sampling.h"

namespace lightwell::fuzz {

/// Random choices of one change, which follow from its seed.
class Choice {
 public:
  explicit Choice(std::uint64_t seed) : seed_(seed) {}
  /// A number from 0 to count - 1; 0 for a count of 0.
  std::size_t below(std::size_t count) {
    const double u = random_uniform(random_key(seed_, ++number_));
    return static_cast<std::size_t>(u * static_cast<double>(count));
  }
  bool is_one_of(std::size_t count) { return below(count) == 0; }

 private:
  std::uint64_t seed_, number_ = 0;
};

/// A number in the machine's byte order at `at`, which must lie in `bytes`.
template <class Number>
Number number_at(std::string_view bytes, std::size_t at) {
  Number number;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

template <class Number>
std::string bytes_of(Number number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}

/// Longest contents that a change makes: longer ones take time and show nothing new.
inline constexpr std::size_t longest_contents = 1 << 16;

/// The contents of a zlib stream. Empty for a damaged stream and for very long contents.
std::optional<std::string> inflated(std::string_view stream);
/// A zlib stream of `contents`.
std::string deflated(std::string_view contents);

}  // namespace lightwell::fuzz
