#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "scene/io/interchange/imported_file.h"
#include "scene/io/pictures/picture_mean.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

struct aiMaterial;

namespace lightwell {

/// A picture of a material: its name in the file, its layout, and the number of its set of texture
/// coordinates.
struct ImportedPicture {
  std::string name{};
  SurfaceTexture image{};
  int uv_set = 0;
};

/// Converts materials of a COLLADA or FBX file (mapping in docs/scene-format.md).
class InterchangeMaterials {
 public:
  InterchangeMaterials(const ImportedFile& file, Scene& scene, Remarks& remarks)
      : file_(file), scene_(scene), remarks_(remarks) {}

  /// Index of the scene's material for material `number` of the file, added if new. A clear
  /// material is glass on a closed body and a thin pane on an open sheet.
  int of(unsigned number, bool is_closed);
  /// Set of texture coordinates that the material's pictures use.
  int uv_set(unsigned number) const;

 private:
  Material read(const aiMaterial& from, const std::string& name, bool is_closed);
  void set_mirror(const aiMaterial& from, Material& material);
  void lay_on_picture(const aiMaterial& from, Material& material);
  void set_emission(const aiMaterial& from, Material& material);
  void set_relief(const aiMaterial& from, Material& material);
  void set_opacity(const aiMaterial& from, bool is_closed, Material& material);
  void set_mask(const aiMaterial& from, Material& material);
  std::optional<Picture> open(const ImportedPicture& picture, PictureCode code,
                              const std::string& material);
  std::optional<Picture> read_picture_of(const ImportedPicture& picture, PictureCode code);

  const ImportedFile& file_;
  Scene& scene_;
  Remarks& remarks_;
  PictureFiles pictures_;
  std::map<std::pair<std::string, PictureCode>, std::optional<Picture>> embedded_;
  std::map<std::pair<unsigned, bool>, int> index_of_;
};

}  // namespace lightwell
