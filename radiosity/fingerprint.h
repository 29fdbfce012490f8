#pragma once

#include <Eigen/Core>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lightwell {

struct PatchMesh;

/// A number of 64 bits that all that is added decides, in its order: equal for equal input, and for
/// other input as good as never. Steps of FNV-1a (Fowler, Noll & Vo), each over 8 bytes and with
/// its upper half folded into the lower. Against accidents, not against forgery.
class Fingerprint {
 public:
  void add_bytes(std::span<const std::byte> bytes);

  template <class Number>
  requires std::is_arithmetic_v<Number> || std::is_enum_v<Number>
  void add(Number number) { add_bytes(std::as_bytes(std::span(&number, 1))); }
  void add(std::string_view text) { add_bytes(std::as_bytes(std::span(text))); }
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void add(const std::vector<Number>& numbers) { add_bytes(std::as_bytes(std::span(numbers))); }
  /// Sizes and numbers.
  template <class Derived>
  void add(const Eigen::PlainObjectBase<Derived>& numbers) {
    add(numbers.rows());
    add(numbers.cols());
    add_bytes(std::as_bytes(std::span(numbers.data(), static_cast<std::size_t>(numbers.size()))));
  }
  /// What of a mesh decides the light on it.
  void add(const PatchMesh& mesh);

  std::uint64_t value() const { return state_; }

 private:
  void step(std::uint64_t word) {
    state_ = (state_ ^ word) * 0x100000001b3u;
    state_ ^= state_ >> 32U;
  }

  std::uint64_t state_ = 0xcbf29ce484222325u;
};

}  // namespace lightwell
