#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/io/read_scene.h"
#include "scene/scene.h"

namespace lightwell {

/// A scene whose facets refer to the polygon numbers of its file, although some polygons were
/// dropped, some cut into several facets, and some combined.
struct NumberedScene {
  /// A polygon of the file, or several polygons that the file combines under one number.
  struct Row {
    std::string name{};      ///< name of its surface; empty if the polygon was dropped
    double emittance = 1.0;  ///< as in the file, [0,1]
  };
  Scene scene{};
  std::vector<Row> rows{};          ///< in the order of the file
  std::vector<int> row_of_facet{};  ///< by scene-wide facet; -1: opaque, without a number
  bool is_enclosure = false;        ///< the file declares that its surfaces close a space
};

/// Reads a scene of any format of read_scene(). Rows by format: faces (.obj, .ply, .stl), S records
/// less those combined with an earlier one (.vs3), and facets and spheres of the scene (other
/// formats; a dropped polygon has no row). Throws InputError naming file, line or object, value and
/// remedy.
NumberedScene read_numbered_scene(const std::filesystem::path& path,
                                  References references = References::anywhere);

/// The scene with a row for each facet and round shape.
NumberedScene numbered_by_facets(Scene scene);

/// read_numbered_scene() for a .vs3 file.
NumberedScene read_numbered_vs3(const std::filesystem::path& path);

}  // namespace lightwell
