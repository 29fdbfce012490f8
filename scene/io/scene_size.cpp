#include "scene/io/scene_size.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/io/text_file.h"

namespace lightwell {

std::int64_t triangles_of(std::size_t corners) {
  return std::max<std::int64_t>(static_cast<std::int64_t>(corners) - 2, 1);
}

std::int64_t triangles_of(const PolygonMesh& mesh) {
  std::int64_t sum = 0;
  for (const Facet& facet : mesh.facets) {
    sum += triangles_of(facet.boundary.size());
    for (const auto& hole : facet.holes)
      sum += triangles_of(hole.size() + 4);  // joined by a bridge
  }
  return sum;
}

std::int64_t triangles_of(const std::vector<Loop>& loops) {
  std::int64_t sum = 0;
  for (const Loop& loop : loops) sum += triangles_of(loop.size());
  return sum;
}

void SceneSize::add(std::int64_t triangles, const Refusal& refuse) {
  triangles_ += triangles;
  if (triangles_ <= most_copied_triangles) return;
  const std::int64_t most =
      std::min(most_copied_triangles + FilesRead::bytes() / bytes_per_triangle, most_triangles);
  if (triangles_ <= most) return;
  refuse(fmt::format(
      "brings the scene to {} triangles; files of this size may amount to {}: use fewer copies or "
      "coarser shapes",
      triangles_, most));
}

}  // namespace lightwell
