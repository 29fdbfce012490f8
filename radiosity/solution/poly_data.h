#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// An array of VTK PolyData: rows of `columns` numbers, or texts.
struct DataArray {
  std::string name{};
  int columns = 1;
  std::variant<std::vector<unsigned char>, std::vector<int>, std::vector<std::int64_t>,
               std::vector<float>, std::vector<double>, std::vector<std::string>>
      values{};
  std::vector<std::string> labels{};  ///< of the columns: XML text without < > & " '; may be empty
};

/// VTK's word for a type of numbers.
template <class T>
constexpr std::string_view data_type_name() {
  if constexpr (std::is_same_v<T, unsigned char>) return "UInt8";
  if constexpr (std::is_same_v<T, int>) return "Int32";
  if constexpr (std::is_same_v<T, std::int64_t>) return "Int64";
  if constexpr (std::is_same_v<T, float>) return "Float32";
  if constexpr (std::is_same_v<T, double>) return "Float64";
}

/// Adds an array of `rows` x `columns` values. VTK files cannot hold empty arrays: an empty array
/// is not added, and nullptr is returned. The pointer is good until another array is added.
template <class T>
DataArray* add_values(std::vector<DataArray>& arrays, const std::string& name, const T* values,
                      std::ptrdiff_t rows, int columns = 1) {
  if (rows == 0 || columns == 0) return nullptr;
  arrays.push_back({name, columns, std::vector<T>(values, values + rows * columns)});
  return &arrays.back();
}

/// Adds an array of strings. An empty array is not added.
void add_strings(std::vector<DataArray>& arrays, const std::string& name,
                 const std::vector<std::string>& values);

/// VTK PolyData of polygons.
struct PolyData {
  std::vector<double> points{};         ///< x, y, z of each point
  std::vector<std::int64_t> corners{};  ///< points of the polygons, one polygon after another
  std::vector<std::int64_t> ends{};     ///< polygon i ends before corners[ends[i]]
  std::vector<DataArray> field{};       ///< of any length
  std::vector<DataArray> of_points{}, of_polygons{};  ///< one row for each
  /// Names of the arrays that programs show first: colours of points and polygons, normals.
  std::string point_scalars{}, point_normals{}, polygon_scalars{};
};

/// Sets the mesh's vertices, in double precision, and one polygon per element.
void set_element_polygons(PolyData& data, const PatchMesh& mesh);

/// Sets one polygon for each of `elements`, and only the vertices of these elements, in the mesh's
/// order.
void set_element_polygons(PolyData& data, const PatchMesh& mesh, std::span<const int> elements);

/// The text of a VTK XML file (.vtp) in pieces, with raw appended data compressed by zlib, without
/// an XML declaration ("VTK File Formats", Kitware). The arrays are freed on the way.
std::vector<std::string> poly_data_text(PolyData data);

/// Writes a text in pieces under a temporary name and renames it. Throws std::runtime_error naming
/// the file and the system's reason if writing fails.
void write_pieces(const std::filesystem::path& path, const std::vector<std::string>& text);

}  // namespace lightwell
