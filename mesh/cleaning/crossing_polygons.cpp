#include "mesh/cleaning/crossing_polygons.h"

#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "mesh/cleaning/region_outline.h"
#include "scene/io/crossing_polygon.h"
#include "scene/io/remarks.h"

namespace lightwell {
namespace {

bool may_cross(const PolygonMesh& mesh, const Facet& facet) {
  if (!facet.holes.empty()) return true;  // a hole may lie outside
  return facet.boundary.size() > 3 &&
         do_loops_cross({std::span(facet.boundary)}, mesh.vertices, facet_normal(mesh, facet));
}

// The pieces of a facet that crosses itself, over vertices added to the mesh; nothing for a facet
// that does not. Where no edges cross, pieces and facet have the same area.
std::optional<std::vector<Facet>> pieces_of(const Facet& facet, PolygonMesh& mesh) {
  if (!may_cross(mesh, facet)) return std::nullopt;
  const auto points = [&](const std::vector<int>& loop) {
    Loop result;
    for (const int v : loop) result.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
    return result;
  };
  Polygon polygon{.boundary = points(facet.boundary)};
  std::vector<int> corners = facet.boundary;
  for (const auto& hole : facet.holes) {
    polygon.holes.push_back(points(hole));
    corners.insert(corners.end(), hole.begin(), hole.end());
  }
  std::vector<Facet> pieces;
  double area = 0.0;
  const std::size_t vertices = mesh.vertices.size();
  for (const auto& piece : convex_pieces(polygon)) {
    Facet& next = pieces.emplace_back();
    next.uv_map = facet.uv_map;
    next.normal_map = facet.normal_map;
    for (const PieceCorner& corner : piece) {
      const int from = corners[static_cast<std::size_t>(corner.from)];
      next.boundary.push_back(corner.from == corner.to ? from
                                                       : static_cast<int>(mesh.vertices.size()));
      if (corner.from != corner.to) mesh.vertices.push_back(corner.of(points(corners)));
    }
    area += facet_area(mesh, next);
  }
  constexpr double rounding = 1e-6;
  if (std::abs(area - facet_area(mesh, facet)) <= rounding * area) {
    mesh.vertices.resize(vertices);
    return std::nullopt;
  }
  std::erase_if(pieces, [&](const Facet& piece) { return is_thin(points(piece.boundary)); });
  return pieces;
}

}  // namespace

void cut_crossing_polygons(Scene& scene) {
  Repairs repairs;
  for (Surface& surface : scene.surfaces) {
    auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
    if (!mesh) continue;
    std::vector<Facet> facets;
    const int before = repairs.crossing;
    for (std::size_t f = 0; f < mesh->facets.size(); ++f) {
      if (const auto pieces = pieces_of(mesh->facets[f], *mesh)) {
        // The facets so far are copied only once one of them changes.
        if (repairs.crossing++ == before) {
          facets.assign(mesh->facets.begin(),
                        mesh->facets.begin() + static_cast<std::ptrdiff_t>(f));
        }
        facets.insert(facets.end(), pieces->begin(), pieces->end());
      } else if (repairs.crossing > before) {
        facets.push_back(mesh->facets[f]);
      }
    }
    if (repairs.crossing > before) mesh->facets = std::move(facets);
  }
  for (const std::string& note : repairs.notes()) add_loss(scene, note + ".");
}

}  // namespace lightwell
