#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scene/io/mesh_file.h"
#include "scene/io/text_file.h"

namespace lightwell {

/// A face (an f line). Its corners are `count` entries of ObjContent::corners from `first`.
struct ObjFace {
  int line = 0;
  int group = 0, material = -1;
  std::size_t first = 0, count = 0;
};

/// The word of a vertex that names no finite number, such as "nan".
struct PlacelessVertex {
  int line = 0;
  std::string word{};
};

/// Contents of an OBJ file with checked numbers.
struct ObjContent {
  std::vector<Eigen::Vector3d> vertices{};
  std::map<int, PlacelessVertex> placeless{};  ///< by vertex; each has a coordinate that is nan
  std::vector<int> corners{};
  std::vector<Eigen::Vector3d> normals{};  ///< of any length; zero where the file lacks numbers
  std::vector<int> corner_normals{};  ///< by corner; -1: none; empty if the file has no normals
  /// v points down from the picture's top, opposite to the file's direction.
  std::vector<Eigen::Vector2d> uv{};
  std::vector<int> corner_uv{};  ///< by corner; -1: none; empty if the file has no uv
  std::vector<ObjFace> faces{};
  std::vector<std::string> groups{};
  std::vector<std::string> material_names{};
  std::vector<std::string> material_files{};
  int free_form = 0;  ///< number of curves and surfaces
};

/// A file's name in an OBJ or MTL file, which some programs write between quotation marks.
std::string_view without_quotes(std::string_view name);

/// Reads an OBJ file's lines; vertices are scaled by `metres_per_unit`. Throws InputError naming
/// file, line and value.
ObjContent read_obj_content(const TextFile& file, double metres_per_unit);

}  // namespace lightwell
