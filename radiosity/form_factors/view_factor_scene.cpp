#include "radiosity/form_factors/view_factor_scene.h"

namespace lightwell {
namespace {

constexpr int one_sided_material = 0, two_sided_material = 1;

Material plain(const Bands& bands, bool one_sided) {
  return {.name = one_sided ? "one-sided" : "two-sided",
          .reflectance = constant_spectrum(bands, 0.5f),
          .specular = constant_spectrum(bands, 0.0f),
          .emission = constant_spectrum(bands, 0.0f),
          .one_sided = one_sided};
}

// The facet with only its own vertices.
PolygonMesh alone(const PolygonMesh& mesh, const Facet& facet) {
  PolygonMesh result;
  const auto copy = [&](const std::vector<int>& loop) {
    std::vector<int> corners;
    for (const int v : loop) {
      corners.push_back(static_cast<int>(result.vertices.size()));
      result.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
    }
    return corners;
  };
  Facet copied{.boundary = copy(facet.boundary)};
  for (const auto& hole : facet.holes) copied.holes.push_back(copy(hole));
  result.facets.push_back(std::move(copied));
  return result;
}

}  // namespace

ViewFactorScene make_view_factor_scene(const NumberedScene& numbered, const FacetCheck& check,
                                       bool two_sided) {
  const Scene& from = numbered.scene;
  const std::vector<FacetRef> facets = scene_facets(from);
  std::vector<char> is_left_out(facets.size(), 0);
  std::vector<int> opposite(facets.size(), -1);
  for (const FacetPair& pair : check.duplicates)
    is_left_out[static_cast<std::size_t>(pair.second)] = 1;
  for (const FacetPair& pair : check.opposites) {
    is_left_out[static_cast<std::size_t>(pair.second)] = 1;
    opposite[static_cast<std::size_t>(pair.first)] = pair.second;
  }

  const int rows = static_cast<int>(numbered.rows.size());
  ViewFactorScene view{.row_count = two_sided ? 2 * rows : rows};
  Scene& scene = view.scene;
  scene.file = from.file;
  scene.title = from.title;
  scene.metres_per_unit = from.metres_per_unit;
  scene.unit_name = from.unit_name;
  constexpr double any_low_nm = 400.0, any_high_nm = 700.0;
  scene.bands = spectral_bands(any_low_nm, any_high_nm, 1);
  scene.materials = {plain(scene.bands, true), plain(scene.bands, false)};
  for (std::size_t f = 0; f < facets.size(); ++f) {
    if (is_left_out[f]) continue;
    const int row = numbered.row_of_facet[f];
    int back = two_sided && row >= 0 ? rows + row : -1;
    if (opposite[f] >= 0) back = numbered.row_of_facet[static_cast<std::size_t>(opposite[f])];
    const bool has_back = back >= 0 || row < 0 || opposite[f] >= 0;
    const Surface& surface = from.surfaces[static_cast<std::size_t>(facets[f].surface)];
    Surface copy{.name = surface.name,
                 .material = has_back ? two_sided_material : one_sided_material};
    if (const auto* mesh = std::get_if<PolygonMesh>(&surface.shape)) {
      copy.shape = alone(*mesh, mesh->facets[static_cast<std::size_t>(facets[f].facet)]);
    } else {
      copy.shape = surface.shape;
    }
    scene.surfaces.push_back(std::move(copy));
    view.front_row.push_back(row);
    view.back_row.push_back(back);
  }
  return view;
}

std::vector<int> rows_of_patches(const ViewFactorScene& view, const PatchMesh& mesh) {
  std::vector<int> rows;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const auto facet = static_cast<std::size_t>(mesh.facet[mesh.first_element[p]]);
    rows.push_back(mesh.is_back[p] ? view.back_row[facet] : view.front_row[facet]);
  }
  return rows;
}

}  // namespace lightwell
