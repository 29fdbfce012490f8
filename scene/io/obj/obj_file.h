#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "scene/io/mesh_file.h"
#include "scene/io/text_file.h"

namespace lightwell {

/// An f line; its corners are a range of ObjContent::corners.
struct ObjFace {
  int line = 0;
  int group = 0, material = -1;
  std::size_t first = 0, count = 0;
};

/// What an OBJ file says, numbers checked.
struct ObjContent {
  std::vector<Eigen::Vector3d> vertices{};
  std::vector<int> corners{};
  std::vector<Eigen::Vector3d> normals{};  ///< of any length; zero where the file has no numbers
  std::vector<int> corner_normals{};  ///< by corner; -1: none; empty if the file has no normals
  std::vector<Eigen::Vector2d> uv{};  ///< v points down from the picture's top, unlike in the file
  std::vector<int> corner_uv{};       ///< by corner; -1: none; empty if the file has no uv
  std::vector<ObjFace> faces{};
  std::vector<std::string> groups{};
  std::vector<std::string> material_names{};
  std::vector<std::string> material_files{};
  int free_form = 0;  ///< curves and surfaces
};

/// Reads an OBJ file's lines; vertices are scaled by `metres_per_unit`. Throws InputError naming
/// file, line and value.
ObjContent read_obj_content(const TextFile& file, double metres_per_unit);

}  // namespace lightwell
