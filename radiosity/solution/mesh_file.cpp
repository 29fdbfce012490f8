#include "radiosity/solution/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "mesh/patches/element_quality.h"
#include "mesh/patches/patch_colors.h"
#include "radiosity/solution/poly_data.h"

namespace lightwell {
namespace {

std::vector<int> elements_of(const PatchMesh& mesh, MeshSides sides) {
  std::vector<int> elements;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (sides == MeshSides::both || !mesh.is_back[mesh.patch[e]]) elements.push_back(e);
  }
  return elements;
}

// Adds the column of value(e) over `elements`.
template <class Value>
void add_column(std::vector<DataArray>& cells, const char* name, const std::vector<int>& elements,
                Value&& value) {
  std::vector<decltype(value(0))> values;
  values.reserve(elements.size());
  for (const int e : elements) values.push_back(value(e));
  add_values(cells, name, values.data(), static_cast<std::ptrdiff_t>(values.size()));
}

// Palette of Okabe & Ito 2008, "Color universal design", distinguishable with any colour vision.
// Numbers beyond the palette get its colours again, darker.
std::vector<unsigned char> palette_colors(const std::vector<int>& numbers) {
  constexpr std::array<std::array<int, 3>, 8> palette = {{{86, 180, 233},
                                                          {230, 159, 0},
                                                          {0, 158, 115},
                                                          {240, 228, 66},
                                                          {204, 121, 167},
                                                          {0, 114, 178},
                                                          {213, 94, 0},
                                                          {160, 160, 160}}};
  std::vector<unsigned char> colors;
  colors.reserve(3 * numbers.size());
  for (const int number : numbers) {
    const auto n = static_cast<std::size_t>(number);
    for (const int channel : palette[n % palette.size()]) {
      const auto divisor = static_cast<int>(std::min<std::size_t>(1 + n / palette.size(), 8));
      colors.push_back(static_cast<unsigned char>(channel / divisor));
    }
  }
  return colors;
}

void add_cells(std::vector<DataArray>& cells, const PatchMesh& mesh,
               const std::vector<int>& elements) {
  const auto add = [&](const char* name, auto&& value) {
    add_column(cells, name, elements, value);
  };
  const std::vector<int> color = patch_colors(mesh);
  add("element", [](int e) { return e; });
  add("patch", [&](int e) { return mesh.patch[e]; });
  add("facet", [&](int e) { return mesh.facet[e]; });
  add("surface", [&](int e) { return mesh.surface[mesh.patch[e]]; });
  add("material", [&](int e) { return mesh.material[mesh.patch[e]]; });
  add("patch_color", [&](int e) { return color[mesh.patch[e]]; });
  add("area", [&](int e) { return double{mesh.element_area[e]}; });
  add("patch_area", [&](int e) { return double{mesh.area[mesh.patch[e]]}; });
  add("least_angle", [&](int e) { return element_shape(mesh, e).least_angle_degrees; });
  add("aspect_ratio", [&](int e) { return element_shape(mesh, e).aspect_ratio; });
  add("is_back", [&](int e) -> unsigned char { return mesh.is_back[mesh.patch[e]] ? 1 : 0; });
  std::vector<int> number;
  for (const int e : elements) number.push_back(color[mesh.patch[e]]);
  add_values(cells, "patch_rgb", palette_colors(number).data(),
             static_cast<std::ptrdiff_t>(elements.size()), 3);
}

}  // namespace

void write_mesh(const std::filesystem::path& path, const PatchMesh& mesh, MeshSides sides,
                const Provenance& provenance) {
  const std::vector<int> elements = elements_of(mesh, sides);
  PolyData data;
  set_element_polygons(data, mesh, elements);
  add_cells(data.of_polygons, mesh, elements);
  data.polygon_scalars = "patch_rgb";
  add_strings(data.field, "version", {provenance.version});
  add_strings(data.field, "scene_file", {provenance.scene_file});
  add_strings(data.field, "scene_hash", {fmt::format("{:016x}", provenance.scene_hash)});
  add_strings(data.field, "options", {provenance.options});
  write_pieces(path, poly_data_text(std::move(data)));
}

}  // namespace lightwell
