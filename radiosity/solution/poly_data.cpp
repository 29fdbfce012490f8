#include "radiosity/solution/poly_data.h"

#include <fmt/format.h>

#include <numeric>
#include <type_traits>
#include <utility>

#include "radiosity/solution/compressed_blocks.h"
#include "scene/atomic_file.h"

namespace lightwell {
namespace {

void set_polygons(PolyData& data, const PatchMesh& mesh, std::span<const int> elements,
                  const std::vector<char>& is_written) {
  std::vector<std::int64_t> point_of(is_written.size(), -1);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (!is_written[v]) continue;
    point_of[v] = static_cast<std::int64_t>(data.points.size() / 3);
    const auto& position = mesh.position(v);
    data.points.insert(data.points.end(), position.data(), position.data() + 3);
  }
  for (const int e : elements) {
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      data.corners.push_back(point_of[mesh.corners[e][c]]);
    }
    data.ends.push_back(static_cast<std::int64_t>(data.corners.size()));
  }
}

template <class T>
std::string packed(const std::vector<T>& values) {
  return compressed_blocks(
      {reinterpret_cast<const char*>(values.data()), sizeof(T) * values.size()});
}

std::string packed(const std::vector<std::string>& values) {
  std::string text;
  for (const std::string& value : values) {
    text += value.c_str();  // a zero byte ends a text
    text += '\0';
  }
  return compressed_blocks(text);
}

// Writes the XML, which says where in the appended data each array is, and the data.
class PolyDataText {
 public:
  std::vector<std::string> write(PolyData data) {
    const std::size_t points = data.points.size() / 3, polygons = data.ends.size();
    xml_ =
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n  <PolyData>\n";
    if (!data.field.empty()) add_section("    ", "FieldData", "", data.field);
    xml_ += fmt::format(
        "    <Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" "
        "NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n",
        points, polygons);
    const auto active = [](const char* kind, const std::string& name) {
      return name.empty() ? std::string() : fmt::format(" {}=\"{}\"", kind, name);
    };
    add_section("      ", "PointData",
                active("Scalars", data.point_scalars) + active("Normals", data.point_normals),
                data.of_points);
    add_section("      ", "CellData", active("Scalars", data.polygon_scalars), data.of_polygons);
    std::vector<DataArray> coordinates{{"Points", 3, std::move(data.points)}};
    add_section("      ", "Points", "", coordinates);
    for (const char* cells : {"Verts", "Lines", "Strips"}) add_cells(cells, {}, {});
    add_cells("Polys", std::move(data.corners), std::move(data.ends));
    xml_ += "    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n   _";
    pieces_.insert(pieces_.begin(), std::move(xml_));
    pieces_.emplace_back("\n  </AppendedData>\n</VTKFile>\n");
    return std::move(pieces_);
  }

 private:
  void add_section(const std::string& indent, const char* name, const std::string& attributes,
                   std::vector<DataArray>& arrays) {
    xml_ += fmt::format("{}<{}{}>\n", indent, name, attributes);
    const bool has_counts = name == std::string_view("FieldData");
    for (DataArray& array : arrays) {
      xml_ += indent + "  ";
      add_array(array, has_counts);
    }
    xml_ += fmt::format("{}</{}>\n", indent, name);
  }

  void add_cells(const char* name, std::vector<std::int64_t> corners,
                 std::vector<std::int64_t> ends) {
    std::vector<DataArray> arrays{{"connectivity", 1, std::move(corners)},
                                  {"offsets", 1, std::move(ends)}};
    add_section("      ", name, "", arrays);
  }

  void add_array(DataArray& array, bool has_count) {
    std::visit(
        [&](auto& values) {
          using T = typename std::remove_reference_t<decltype(values)>::value_type;
          constexpr bool is_text = std::is_same_v<T, std::string>;
          if constexpr (is_text) {
            xml_ += "<Array type=\"String\"";
          } else {
            xml_ += fmt::format("<DataArray type=\"{}\"", data_type_name<T>());
          }
          xml_ += fmt::format(" Name=\"{}\"", array.name);
          if (array.columns != 1) xml_ += fmt::format(" NumberOfComponents=\"{}\"", array.columns);
          for (std::size_t k = 0; k < array.labels.size(); ++k) {
            xml_ += fmt::format(" ComponentName{}=\"{}\"", k, array.labels[k]);
          }
          if (has_count) {
            xml_ += fmt::format(" NumberOfTuples=\"{}\"",
                                values.size() / static_cast<std::size_t>(array.columns));
          }
          xml_ += fmt::format(" format=\"appended\" offset=\"{}\"/>\n", offset_);
          pieces_.push_back(packed(values));
          offset_ += pieces_.back().size();
          values = {};
        },
        array.values);
  }

  std::string xml_;
  std::vector<std::string> pieces_;  // of the appended data
  std::size_t offset_ = 0;           // of the next array in the appended data, in bytes
};

}  // namespace

void add_strings(std::vector<DataArray>& arrays, const std::string& name,
                 const std::vector<std::string>& values) {
  if (!values.empty()) arrays.push_back({name, 1, values});
}

void set_element_polygons(PolyData& data, const PatchMesh& mesh) {
  std::vector<int> elements(static_cast<std::size_t>(mesh.element_count()));
  std::iota(elements.begin(), elements.end(), 0);
  set_polygons(data, mesh, elements,
               std::vector<char>(static_cast<std::size_t>(mesh.vertex_count()), 1));
}

void set_element_polygons(PolyData& data, const PatchMesh& mesh, std::span<const int> elements) {
  std::vector<char> is_written(static_cast<std::size_t>(mesh.vertex_count()), 0);
  for (const int e : elements) {
    for (int c = 0; c < mesh.corner_count(e); ++c) is_written[mesh.corners[e][c]] = 1;
  }
  set_polygons(data, mesh, elements, is_written);
}

std::vector<std::string> poly_data_text(PolyData data) {
  return PolyDataText().write(std::move(data));
}

void write_pieces(const std::filesystem::path& path, const std::vector<std::string>& text) {
  AtomicStream file(path);
  for (const std::string& piece : text) {
    file.stream().write(piece.data(), static_cast<std::streamsize>(piece.size()));
    if (!file.stream()) break;
  }
  file.commit();
}

}  // namespace lightwell
