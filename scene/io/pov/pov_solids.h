#pragma once

#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "scene/io/corner_maps.h"
#include "scene/io/polygon.h"
#include "scene/io/pov/pov_value.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// Polygons in the space of their shape.
struct PovFacets {
  std::vector<Loop> loops{};
  std::vector<NormalLoop> normals{};  ///< one for each loop, or empty
  std::vector<UvLoop> uv{};           ///< one for each loop, or empty
  std::vector<Polygon> polygons{};    ///< with holes
};

/// A part of a shape that becomes one surface.
struct PovPiece {
  std::variant<PovFacets, Sphere, Frustum> shape{};
  std::string_view suffix{};         ///< behind the name of the shape
  const PovNode* texture = nullptr;  ///< of this piece alone; null: that of the shape
};

/// A shape in its own space, before its transformations.
struct PovSolid {
  std::vector<PovPiece> pieces{};
  bool is_closed = true;  ///< a body with an inside
};

/// Reads what stands first in the block of a shape: box, sphere, cylinder, cone, disc, torus,
/// lathe, prism, polygon, triangle, smooth_triangle, mesh or mesh2. Empty, with nothing passed, for
/// a block of another kind. A solid without pieces has no area. Throws InputError for values that
/// make no such shape.
std::optional<PovSolid> read_pov_solid(PovCursor& cursor, Remarks& remarks);

PovSolid read_pov_prism(PovCursor& cursor);
PovSolid read_pov_polygon(PovCursor& cursor);
PovSolid read_pov_triangle(PovCursor& cursor);
PovSolid read_pov_mesh(PovCursor& cursor);
PovSolid read_pov_mesh2(PovCursor& cursor);
/// A surface of revolution about y, of round pieces.
PovSolid read_pov_lathe(PovCursor& cursor);

}  // namespace lightwell
