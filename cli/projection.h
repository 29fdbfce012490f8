#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <utility>

#include "scene/scene.h"

namespace lightwell {

/// Options that change how a camera sees.
struct ProjectionArguments {
  std::optional<Projection> projection{};  ///< unset: the camera's
  /// Full angle in degrees; of an orthographic picture its width in the scene file's unit.
  std::optional<double> extent{};
  std::optional<double> near_limit{};  ///< in the scene file's unit
  std::optional<Eigen::Vector2d> shift{};
  std::optional<std::pair<int, int>> size{};  ///< width and height in pixels; unset: the camera's

  /// Adds --projection, --near and --shift.
  void add_to(CLI::App& command, const std::string& group);
  /// `camera` with these options. An orthographic picture without extent shows all of the scene.
  /// Throws InputError for a camera that cannot be so.
  Camera view(const Camera& camera, const Scene& scene) const;
  /// Command-line options that repeat the projection, each after a space.
  std::string text() const;
};

}  // namespace lightwell
