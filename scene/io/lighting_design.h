#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// A plane over a surface of a scene on which illuminance is asked for, a [[grids]] table.
struct CalculationGrid {
  std::string name{};
  int surface = 0;                 ///< index into Scene::surfaces
  double height = 0.0;             ///< m above it, >= 0
  std::optional<double> margin{};  ///< m along the outline that is left out; else what is usual
  double spacing = 0.0;            ///< m between points, at most; 0: what is usual
};

/// What a scene file says of a design beside its light. Nothing here changes a solution.
struct LightingDesign {
  std::vector<CalculationGrid> grids{};
  // Of each of Scene::lamps; empty without lamps, or where the format says nothing of them.
  std::vector<double> watts{};            ///< electric power; 0: unknown
  std::vector<double> luminous_height{};  ///< m, of the sides that a photometric file gives a lamp
};

/// Of the file that the scene was read from: [[grids]], and of [[lamps]] `watts`, else what the
/// photometric file says, unless `lumens` make of it another luminaire than that one. Nothing for
/// formats other than the native one. Throws what read_scene throws.
LightingDesign read_lighting_design(const Scene& scene);

}  // namespace lightwell
