#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// A scene whose polygons keep the numbers their file gives them, whatever became of them on the
/// way: some were dropped, some cut into several facets, some put together.
struct NumberedScene {
  /// A polygon of the file, or what the file puts together under one number.
  struct Row {
    std::string name{};      ///< of the surface it belongs to; empty if it was dropped
    double emittance = 1.0;  ///< as the file gives it, [0,1]
  };
  Scene scene{};
  std::vector<Row> rows{};          ///< in the order of the file
  std::vector<int> row_of_facet{};  ///< by scene-wide facet; -1: opaque, but of no number
  bool is_enclosure = false;        ///< the file says that its surfaces close a space
};

/// Reads what read_scene() reads. Rows are faces in .obj, .ply and .stl, the S records of .vs3 less
/// those combined with an earlier one, and what facets and spheres the scene has in other formats,
/// where a polygon that was dropped has no number. Throws InputError naming file, line or object,
/// value and remedy.
NumberedScene read_numbered_scene(const std::filesystem::path& path);

/// The same for one .vs3 file.
NumberedScene read_numbered_vs3(const std::filesystem::path& path);

}  // namespace lightwell
