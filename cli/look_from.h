#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "scene/rays/ray_caster.h"
#include "scene/scene.h"

namespace lightwell {

/// Cameras and places that somebody looks from, of --look-from.
struct LookFromArguments {
  /// Names of cameras, files of places, or `everywhere`; empty: errors matter everywhere.
  std::vector<std::string> names{};

  static constexpr const char* everywhere = "everywhere";

  void add_to(CLI::App& command, const std::string& group);
  /// The rays of SolveOptions::view_rays. Throws InputError if the scene has no camera of a name,
  /// or if a file of places cannot be read.
  std::vector<Ray> rays(const Scene& scene) const;
  /// Command-line options that repeat the arguments; begins with a blank.
  std::string text() const;
};

}  // namespace lightwell
