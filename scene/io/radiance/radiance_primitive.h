#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace lightwell {

/// Where something stands in the files of a RADIANCE scene.
struct RadianceLocation {
  const std::filesystem::path* file = nullptr;
  int line = 0;

  /// Throws InputError "file:line: problem".
  [[noreturn]] void fail(std::string_view problem) const;
};

/// What a primitive's type makes of it.
enum class RadianceKind { surface, material, pattern, texture, mixture, alias, unknown };

RadianceKind radiance_kind(std::string_view type);

/// A primitive of a RADIANCE scene as its file gives it: what it is made of (another primitive),
/// what it is, what it is called, and its arguments. An alias has the name it stands for in
/// `strings`.
struct RadiancePrimitive {
  std::string modifier{}, type{}, name{};
  std::vector<std::string> strings{};
  std::vector<double> reals{};
  RadianceLocation location{};

  RadianceKind kind() const { return radiance_kind(type); }
  /// Throws InputError "file:line: type 'name' problem".
  [[noreturn]] void fail(std::string_view problem) const;
  /// Throws InputError unless there are as many real arguments.
  void require_reals(std::size_t count) const;
};

/// Takes a scene's primitives one by one, in their order.
using RadianceSink = std::function<void(const RadiancePrimitive&)>;

/// The modifier of what has none.
inline constexpr std::string_view radiance_void = "void";

}  // namespace lightwell
