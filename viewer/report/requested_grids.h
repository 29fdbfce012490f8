#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "raytrace/readings/lux_grid.h"
#include "scene/io/lighting_design.h"

namespace lightwell {

/// A number for what has a name: a height above a surface, the power of a luminaire.
struct NamedNumber {
  std::string name{};
  double value = 0.0;
};

/// Surfaces, and planes above surfaces, with a grid of points each. Names are those of
/// surfaces_named(). Lengths in metres.
struct GridRequest {
  std::vector<std::string> surfaces{};
  std::vector<NamedNumber> planes{};  ///< heights above surfaces, >= 0
  /// Strip along the outline of planes that is left out, >= 0; empty: 0.5 m, which EN 12464-1
  /// leaves out along walls.
  std::optional<double> margin{};
  double spacing = 0.0;  ///< largest distance between points; 0: by EN 12464-1

  bool is_empty() const { return surfaces.empty() && planes.empty(); }
};

/// Indices into Scene::surfaces: the surface of this name, or else all whose name or material fits
/// it as a pattern, as in a shell. Throws InputError if there is none.
std::vector<int> surfaces_named(const Scene& scene, const std::string& name);

/// Throws InputError unless a surface of each name is there: before the long work that the grids
/// wait for.
void require_surfaces(const GridRequest& asked, const Scene& scene);

/// The grids of a scene file, of surfaces and of planes, in this order. The grids lie before the
/// front of their surface; above a level surface of two sides whose front faces down, unless far
/// more of the scene is around its front than around its back, as with a ceiling. `scene` has the
/// surfaces of the file by their names (see JoinedSurfaces::apart), and `caster` is of its mesh.
/// Throws InputError for a surface that is not there, and what lux_grid() throws, also for one of
/// the surfaces that fit a pattern.
std::vector<LuxGrid> requested_grids(const GridRequest& asked,
                                     std::span<const CalculationGrid> of_file, const Scene& scene,
                                     const ElementCaster& caster, const Eigen::Vector3d& up);

}  // namespace lightwell
