#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/io/json_object.h"
#include "scene/io/pictures/picture_mean.h"

namespace lightwell {

/// A glTF 2.0 file, text or binary, and its buffers. References by index are checked on access, and
/// so are buffers that are missing or were cut off.
class GltfFile {
 public:
  /// Throws InputError naming the file and, for torn JSON, the line.
  explicit GltfFile(const std::filesystem::path& path);
  ~GltfFile();
  GltfFile(const GltfFile&) = delete;
  GltfFile& operator=(const GltfFile&) = delete;

  const JsonObject& root() const { return *root_; }
  /// Number of members of a list ("nodes"); 0 if the file lacks the list.
  std::size_t count(const char* list) const;
  /// Member `index` of a list ("nodes"). Throws InputError naming `asking` if there is none.
  const JsonObject& at(const char* list, std::size_t index, const JsonObject& asking) const;

  /// Elements of a VEC3 accessor (floats or integers), which may be no finite numbers.
  std::vector<Eigen::Vector3d> vectors(std::size_t accessor, const JsonObject& asking) const;
  /// Elements of a VEC2 accessor (texture coordinates), which may be no finite numbers.
  std::vector<Eigen::Vector2d> pairs(std::size_t accessor, const JsonObject& asking) const;
  /// Elements of a SCALAR accessor of whole numbers, all below `limit`.
  std::vector<int> indices(std::size_t accessor, std::size_t limit, const JsonObject& asking) const;
  /// Bytes of a buffer view; those of a compressed one are unpacked once and kept, as far as all of
  /// them are not far more than the buffers have.
  std::string_view view(std::size_t buffer_view, const JsonObject& asking) const;
  /// Mean of a texture's picture; empty if the picture's format is not supported.
  std::optional<PictureMean> texture_mean(std::size_t texture, PictureCode code,
                                          const JsonObject& asking) const;
  /// A texture's picture with all pixels; empty if the picture's format is not supported.
  std::optional<Picture> texture_picture(std::size_t texture, PictureCode code,
                                         const JsonObject& asking) const;

 private:
  struct Elements;
  struct Content;
  void read_buffers(std::string_view binary_chunk);
  // Calls `read` with the bytes and the name of a texture's picture.
  template <class Read>
  auto read_texture(std::size_t texture, const JsonObject& asking, Read read) const
      -> decltype(read(std::string_view(), std::string()));
  template <int size>
  std::vector<Eigen::Matrix<double, size, 1>> tuples(std::size_t accessor,
                                                     const JsonObject& asking) const;
  std::string resource(const JsonObject& owner, const std::string& uri) const;
  std::string_view slice(std::size_t buffer, const JsonObject& owner) const;
  // `owner` has a bufferView and a byteOffset; `a` is its accessor.
  Elements located(const JsonObject& owner, const JsonObject& a, std::size_t count,
                   std::size_t size) const;
  std::string substituted(const JsonObject& sparse, std::size_t size, const Elements& dense) const;
  // Elements of a sparse accessor are put together in `store`.
  Elements elements(std::size_t accessor, std::string_view type, const JsonObject& asking,
                    std::string& store) const;

  std::filesystem::path path_;
  std::unique_ptr<Content> content_;
  std::optional<JsonObject> root_;
};

}  // namespace lightwell
