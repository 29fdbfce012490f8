#include "scene/io/gltf/gltf_geometry.h"

#include <fmt/format.h>

#include <utility>

#include "scene/io/gltf/gltf_compressed.h"

namespace lightwell {
namespace {

void check_count(const JsonObject& attributes, std::size_t count, const char* what,
                 std::size_t vertices) {
  if (count == 0 || count == vertices) return;
  attributes.fail(fmt::format("has {} {} for {} vertices", count, what, vertices));
}

GltfGeometry unpack(const GltfFile& file, const JsonObject& primitive, const JsonObject& draco,
                    const std::string& uv_set,
                    const std::function<void(std::int64_t triangles)>& expect) {
  const auto attributes = draco.object("attributes");
  const auto view = draco.index("bufferView");
  if (!attributes || !view) draco.fail("lacks 'bufferView' or 'attributes'");
  const auto number = [&](const std::string& name) {
    const auto given = name.empty() ? std::nullopt : attributes->index(name.c_str());
    return given ? static_cast<std::int64_t>(*given) : -1;
  };
  const DracoAttributes numbers{
      .position = number("POSITION"), .normal = number("NORMAL"), .uv = number(uv_set)};
  if (numbers.position < 0) attributes->fail("lacks 'POSITION'");
  DracoMesh mesh = decode_draco(primitive, file.view(*view, draco), numbers, expect);
  return {.positions = std::move(mesh.positions),
          .normals = std::move(mesh.normals),
          .uv = std::move(mesh.uv),
          .indices = std::move(mesh.indices)};
}

}  // namespace

GltfGeometry read_geometry(const GltfFile& file, const JsonObject& primitive,
                           const JsonObject& attributes, const std::string& uv_set,
                           const std::function<void(std::int64_t triangles)>& expect) {
  if (const auto draco = primitive.extension("KHR_draco_mesh_compression")) {
    return unpack(file, primitive, *draco, uv_set, expect);
  }
  const auto position = attributes.index("POSITION");
  if (!position) attributes.fail("lacks 'POSITION'");
  GltfGeometry geometry{.positions = file.vectors(*position, attributes)};
  if (const auto accessor = primitive.index("indices")) {
    geometry.indices = file.indices(*accessor, geometry.positions.size(), primitive);
  }
  if (const auto accessor = attributes.index("NORMAL")) {
    geometry.normals = file.vectors(*accessor, attributes);
    check_count(attributes, geometry.normals.size(), "normals", geometry.positions.size());
  }
  const auto uv = uv_set.empty() ? std::nullopt : attributes.index(uv_set.c_str());
  if (uv) {
    geometry.uv = file.pairs(*uv, attributes);
    check_count(attributes, geometry.uv.size(), "texture coordinates", geometry.positions.size());
  }
  return geometry;
}

}  // namespace lightwell
