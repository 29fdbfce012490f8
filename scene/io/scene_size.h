#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scene/io/polygon.h"
#include "scene/scene.h"

namespace lightwell {

/// Triangles that a scene may amount to by copies alone, whatever the size of its files: some 1 GB.
inline constexpr std::int64_t most_copied_triangles = 4'000'000;
/// Least bytes of a file for each further triangle. Files of plain triangles have more.
inline constexpr std::int64_t bytes_per_triangle = 4;
/// Largest number of triangles in a scene with copies, some 5 GB.
inline constexpr std::int64_t most_triangles = 20'000'000;

/// Number of triangles that a polygon of so many corners amounts to, at least 1.
std::int64_t triangles_of(std::size_t corners);
/// Number of triangles that polygons amount to.
std::int64_t triangles_of(const PolygonMesh& mesh);
std::int64_t triangles_of(const std::vector<Loop>& loops);

/// Counts the triangles of a scene before they are made: instances, arrays and generators multiply
/// them, so that a small file could fill all memory.
class SceneSize {
 public:
  /// Receives the sentence on a scene that is too large, and throws LimitError.
  using Refusal = std::function<void(const std::string& sentence)>;

  /// Counts `triangles` that are about to be made. Calls `refuse` where they bring the scene to
  /// more than most_copied_triangles and one for every bytes_per_triangle bytes of the files that
  /// FilesRead lists, or to more than most_triangles.
  void add(std::int64_t triangles, const Refusal& refuse);

 private:
  std::int64_t triangles_ = 0;
};

}  // namespace lightwell
