#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "scene/io/gltf/gltf_file.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// Converts materials of a glTF file (mapping in docs/scene-format.md).
class GltfMaterials {
 public:
  GltfMaterials(const GltfFile& file, Scene& scene, Remarks& remarks)
      : file_(file), scene_(scene), remarks_(remarks) {}

  /// Index of the scene's material for a mesh's primitive, added if new.
  /// On a closed body a clear material refracts and emission leaves on the outside only.
  /// On an open sheet a clear material is a thin pane, and emission leaves on both sides where the
  /// file declares the material double-sided.
  int of_primitive(const GltfObject& primitive, bool is_closed);
  /// Name of the primitive's set of texture coordinates for its base colour ("TEXCOORD_0"), or
  /// for its emission or its normal map if what goes before has no picture; empty if none has one.
  std::string texture_coordinates(const GltfObject& primitive) const;

 private:
  Material read(const GltfObject& from, bool is_closed);
  Spectrum base_color(const GltfObject& from);
  void set_surface(const GltfObject& from, bool is_closed, Material& material);
  void set_shaded(const GltfObject& from, const Spectrum& base, bool is_closed, Material& material);
  void pass_light(const GltfObject& from, const Spectrum& base, float dielectric, double clear,
                  double alpha, Material& material);
  void cut_by_alpha(const GltfObject& from, Material& material);
  void set_relief(const GltfObject& from, Material& material);
  void set_coat(const GltfObject& from, double alpha, Material& material);
  void set_clear(const GltfObject& from, const Spectrum& base, double alpha, bool is_closed,
                 Material& material);
  void set_emission(const GltfObject& from, Material& material);
  // Picture of baseColorTexture or diffuseTexture; empty if absent or of an unsupported format.
  std::optional<Picture> base_picture(const GltfObject& from);
  std::optional<Picture> color_picture(const GltfObject& info, const GltfObject& from);
  void lay_on_picture(const GltfObject& from, const Spectrum& base, Material& material);
  SurfaceTexture laid_on(const GltfObject& info, std::shared_ptr<const Texture> picture) const;
  // Mean of the texture under `key` of `owner`: white without a texture, grey 0.5 with a remark if
  // its format is not supported. `from` is the material.
  PictureMean texture_mean(const std::optional<GltfObject>& owner, const char* key,
                           PictureCode code, const GltfObject& from);

  const GltfFile& file_;
  Scene& scene_;
  Remarks& remarks_;
  std::map<std::pair<std::optional<std::size_t>, bool>, int> index_of_;
  std::map<std::pair<std::size_t, PictureCode>, std::optional<PictureMean>> textures_;
  std::map<std::size_t, std::optional<Picture>> color_pictures_;  // by texture
};

}  // namespace lightwell
