#include "scene/io/radiance/files/radiance_compiled.h"

#include <fmt/format.h>

#include "scene/io/mesh_file.h"

namespace lightwell {

void pass_mesh_source(const RadiancePrimitive& mesh, const std::filesystem::path& obj,
                      const RadianceSink& sink) {
  const Scene scene = read_obj_file(obj, 1.0, MeshMaterials::ignored);
  RadiancePrimitive polygon{
      .modifier = mesh.modifier, .type = "polygon", .location = mesh.location};
  if (polygon.modifier == radiance_void) polygon.modifier = obj.stem().string();
  int count = 0;
  for (const Surface& surface : scene.surfaces) {
    const auto& source = std::get<PolygonMesh>(surface.shape);
    for (const Facet& facet : source.facets) {
      polygon.name = fmt::format("{}.{}", mesh.name, ++count);
      polygon.reals.clear();
      for (const int v : facet.boundary) {
        const Eigen::Vector3d& p = source.vertices[static_cast<std::size_t>(v)];
        polygon.reals.insert(polygon.reals.end(), {p.x(), p.y(), p.z()});
      }
      sink(polygon);
    }
  }
}

}  // namespace lightwell
