#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "raytrace/readings/lux_grid.h"
#include "scene/io/lighting_design.h"

namespace lightwell {

/// NAME@NUMBER or NAME=NUMBER.
struct NamedNumber {
  std::string name{};
  double value = 0.0;
};

/// Reads a NamedNumber whose name and number stand on either side of `mark`. Throws
/// CLI::ValidationError of `option` for a number below `least`.
NamedNumber named_number(const std::string& text, char mark, const char* option, double least);

/// Options that name surfaces, and planes above surfaces, with a grid of points each.
struct GridArguments {
  std::vector<std::string> surfaces{};
  std::vector<NamedNumber> planes{};
  std::optional<double> margin{};  ///< in the scene file's unit; unset: 0.5 m
  double spacing = 0.0;            ///< in the scene file's unit; 0: that of EN 12464-1

  /// Adds --surface, --plane, --margin and --spacing. The object must outlive the command.
  void add_to(CLI::App& command);
  bool is_empty() const { return surfaces.empty() && planes.empty(); }
  /// The grids of the scene file, of --surface and of --plane, in this order. Throws InputError for
  /// a surface that the scene has not, and what lux_grid() throws.
  std::vector<LuxGrid> grids(const Scene& scene, const LightingDesign& design,
                             const Eigen::Vector3d& up) const;
};

}  // namespace lightwell
