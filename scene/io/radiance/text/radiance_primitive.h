#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace lightwell {

/// A position in the files of a RADIANCE scene.
struct RadianceLocation {
  const std::filesystem::path* file = nullptr;
  int line = 0;  ///< 0: of a file whose lines say nothing

  /// "file:line: problem"
  std::string sentence(std::string_view problem) const;
  /// Throws InputError "file:line: problem".
  [[noreturn]] void fail(std::string_view problem) const;
  /// Throws LimitError "file:line: problem".
  [[noreturn]] void fail_limit(std::string_view problem) const;
};

/// Class of a primitive by its type.
enum class RadianceKind { surface, material, pattern, texture, mixture, alias, unknown };

RadianceKind radiance_kind(std::string_view type);

/// A primitive of a RADIANCE scene as in its file: modifier, type, name and arguments. `strings` of
/// an alias holds the original name.
struct RadiancePrimitive {
  std::string modifier{}, type{}, name{};
  std::vector<std::string> strings{};
  std::vector<double> reals{};
  RadianceLocation location{};
  /// Map from the coordinates of a pattern's formulas to those of the scene: a rotation or
  /// mirroring, a uniform scaling and a translation.
  Eigen::Affine3d frame = Eigen::Affine3d::Identity();

  RadianceKind kind() const { return radiance_kind(type); }
  /// The three real arguments from number `first` on.
  Eigen::Vector3d point(std::size_t first) const {
    return {reals[first], reals[first + 1], reals[first + 2]};
  }
  /// Throws InputError "file:line: type 'name' problem".
  [[noreturn]] void fail(std::string_view problem) const;
  /// Throws InputError unless there are exactly `count` real arguments.
  void require_reals(std::size_t count) const;
};

/// Receives a scene's primitives one by one, in file order.
using RadianceSink = std::function<void(const RadiancePrimitive&)>;

/// Modifier of a primitive without one.
inline constexpr std::string_view radiance_void = "void";

}  // namespace lightwell
