#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
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
  int of_primitive(const JsonObject& primitive, bool is_closed);
  /// Name of the primitive's set of texture coordinates for its base colour ("TEXCOORD_0"), or
  /// for its emission or its normal map if what goes before has no picture; empty if none has one.
  std::string texture_coordinates(const JsonObject& primitive) const;

 private:
  Material read(const JsonObject& from, bool is_closed);
  Spectrum base_color(const JsonObject& from);
  void set_surface(const JsonObject& from, bool is_closed, Material& material);
  void set_shaded(const JsonObject& from, const Spectrum& base, bool is_closed, Material& material);
  void pass_light(const JsonObject& from, const Spectrum& base, float dielectric, double clear,
                  double alpha, Material& material);
  void cut_by_alpha(const JsonObject& from, Material& material);
  void set_relief(const JsonObject& from, Material& material);
  void set_coat(const JsonObject& from, double alpha, Material& material);
  void set_clear(const JsonObject& from, const Spectrum& base, double alpha, bool is_closed,
                 Material& material);
  void set_emission(const JsonObject& from, Material& material);
  // Coat of a dielectric: its own or its clear coat; empty: none.
  struct CoatLayer {
    float index = 1.5f;
    Spectrum share{};
  };
  static std::optional<CoatLayer> coat_layer(const JsonObject& from);
  // Light that leaves a sheet diffusely on the other side: its share, [0,1], and colour.
  struct PassedLight {
    float scattered = 0.0f;
    Spectrum hue{};
  };
  PassedLight diffusely_passed(const JsonObject& from);
  // Share of a dielectric's light, [0,1], that passes without being scattered.
  double clear_share(const JsonObject& from);
  // Pictures of shares and roughness, and the numbers that stand where there is none.
  struct SharePictures {
    float even_alpha = 1.0f;   // factor of the picture, or the roughness without one
    float even_metal = 0.0f;   // mean
    float clear_share = 1.0f;  // of a clear coat, where no picture has it
    bool is_clear_coat = false;
    std::optional<ShareTexture> roughness{}, metal{}, coat{}, translucency{};
  };
  SharePictures share_pictures(const JsonObject& from, float metal_factor);
  void set_gloss(const JsonObject& from, const SharePictures& pictures, const Spectrum& color,
                 bool has_metal, Material& material, SurfacePattern& pattern);
  static float metal_factor_of(const JsonObject& from);
  std::optional<ReflectanceTexture> base_texture(const JsonObject& from);
  void set_pattern_of(const JsonObject& from, const Spectrum& base, bool is_closed,
                      Material& material);
  bool follows(const JsonObject& info, std::string_view key, const JsonObject& from) const;
  std::string coordinates_of_material(const JsonObject& material) const;
  // Channel `number` (3: alpha) of a picture of shares; empty without a picture that is laid over
  // the surface as others are.
  std::optional<ShareTexture> share_picture(const std::optional<JsonObject>& owner, const char* key,
                                            int number, float factor, const JsonObject& from);
  std::optional<Picture> linear_picture(const JsonObject& info, const JsonObject& from);
  // Picture of baseColorTexture or diffuseTexture; empty if absent or of an unsupported format.
  std::optional<Picture> base_picture(const JsonObject& from);
  std::optional<Picture> color_picture(const JsonObject& info, const JsonObject& from);
  void lay_on_picture(const JsonObject& from, const Spectrum& base, Material& material);
  SurfaceTexture laid_on(const JsonObject& info, std::shared_ptr<const Texture> picture) const;
  // Mean of the texture under `key` of `owner`: white without a texture, grey 0.5 with a remark if
  // its format is not supported. `from` is the material.
  PictureMean texture_mean(const std::optional<JsonObject>& owner, const char* key,
                           PictureCode code, const JsonObject& from);

  const GltfFile& file_;
  Scene& scene_;
  Remarks& remarks_;
  std::map<std::pair<std::optional<std::size_t>, bool>, int> index_of_;
  std::map<std::pair<std::size_t, PictureCode>, std::optional<PictureMean>> textures_;
  std::map<std::size_t, std::optional<Picture>> color_pictures_;   // by texture
  std::map<std::size_t, std::optional<Picture>> linear_pictures_;  // by texture
  std::map<std::pair<std::size_t, int>, std::shared_ptr<const Texture>> channels_;
};

}  // namespace lightwell
