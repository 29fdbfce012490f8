#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "scene/io/gltf/gltf_file.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// Materials of a glTF file as materials of a scene; docs/scene-format.md says what becomes what.
class GltfMaterials {
 public:
  GltfMaterials(const GltfFile& file, Scene& scene, Remarks& remarks)
      : file_(file), scene_(scene), remarks_(remarks) {}

  /// Index of the scene's material for a mesh's primitive, added where it is new. On a closed body
  /// clear materials refract, and what shines does so outwards only; on an open sheet they are thin
  /// panes, and shine to both sides where the file says double-sided.
  int of_primitive(const GltfObject& primitive, bool is_closed);
  /// Which of a primitive's sets of texture coordinates its base colour lies on ("TEXCOORD_0");
  /// empty if the base colour is no picture.
  std::string texture_coordinates(const GltfObject& primitive) const;

 private:
  Material read(const GltfObject& from, bool is_closed);
  Spectrum base_color(const GltfObject& from);
  void set_surface(const GltfObject& from, bool is_closed, Material& material);
  void set_shaded(const GltfObject& from, const Spectrum& base, bool is_closed, Material& material);
  void set_clear(const GltfObject& from, const Spectrum& base, double alpha, bool is_closed,
                 Material& material);
  Spectrum emission(const GltfObject& from);
  // What baseColorTexture or diffuseTexture shows, if it is of a format that is read.
  std::optional<Picture> base_picture(const GltfObject& from);
  void lay_on_picture(const GltfObject& from, const Spectrum& base, Material& material);
  SurfaceTexture laid_on(const GltfObject& info, std::shared_ptr<const Texture> picture) const;
  // Mean of the texture that `owner` names with `key`: white without one, grey 0.5 with a remark if
  // its format is not read. `from` is the material.
  PictureMean texture_mean(const std::optional<GltfObject>& owner, const char* key,
                           PictureCode code, const GltfObject& from);

  const GltfFile& file_;
  Scene& scene_;
  Remarks& remarks_;
  std::map<std::pair<std::optional<std::size_t>, bool>, int> index_of_;
  std::map<std::pair<std::size_t, PictureCode>, std::optional<PictureMean>> textures_;
  std::map<std::size_t, std::optional<Picture>> base_pictures_;  // by texture
};

}  // namespace lightwell
