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

/// 64-bit hash of a sequence of values: equal for equal input, and different for different input
/// with a probability of nearly 1. The steps are those by which XXH64 takes in 8 bytes (Collet
/// 2012). Protects against accidents, not against forgery.
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
  /// Adds the sizes, then the numbers.
  template <class Derived>
  void add(const Eigen::PlainObjectBase<Derived>& numbers) {
    add(numbers.rows());
    add(numbers.cols());
    add_bytes(std::as_bytes(std::span(numbers.data(), static_cast<std::size_t>(numbers.size()))));
  }
  /// Adds all of the mesh that affects its light.
  void add(const PatchMesh& mesh);
  /// Adds the geometry of patches and elements, their materials' numbers, and the holes of
  /// textures.
  void add_geometry(const PatchMesh& mesh);

  std::uint64_t value() const { return state_; }

 private:
  // One-to-one in the word and in the state: one changed word always changes the hash.
  void step(std::uint64_t word) {
    constexpr std::uint64_t p1 = 0x9e3779b185ebca87u, p2 = 0xc2b2ae3d27d4eb4fu,
                            p4 = 0x85ebca77c2b2ae63u;
    state_ = std::rotl(state_ ^ (std::rotl(word * p2, 31) * p1), 27) * p1 + p4;
  }

  std::uint64_t state_ = 0x27d4eb2f165667c5u;
};

}  // namespace lightwell
