#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

struct aiNode;
struct aiScene;

namespace lightwell {

/// Largest COLLADA or FBX file that is read: the library takes some 15 times as much memory.
inline constexpr std::int64_t largest_import = std::int64_t{512} << 20;

/// A vector of the library.
template <class Vector>
Eigen::Vector3d vector_of(const Vector& v) {
  return {v.x, v.y, v.z};
}

/// A node of the file and its place in the scene, in metres.
struct ImportedNode {
  const aiNode* node = nullptr;  ///< not null
  std::string name{};
  Eigen::Affine3d to_world = Eigen::Affine3d::Identity();
};

/// A COLLADA or FBX file as assimp reads it. The file's axis stays upright.
class ImportedFile {
 public:
  /// Throws InputError naming the file: too large, damaged, or of another format.
  explicit ImportedFile(const std::filesystem::path& path);
  ~ImportedFile();
  ImportedFile(const ImportedFile&) = delete;
  ImportedFile& operator=(const ImportedFile&) = delete;

  const aiScene& scene() const;
  bool is_fbx() const { return is_fbx_; }
  double metres_per_unit() const { return metres_per_unit_; }
  /// Every node, parents before their children, in the order of the file.
  const std::vector<ImportedNode>& nodes() const { return nodes_; }
  /// Numbers of the nodes that place each of several lights or cameras. Equal names go to nodes of
  /// this name in turn: instances repeat names. -1: no node has the name.
  std::vector<int> places_of(const std::vector<std::string>& names) const;
  /// True if a word occurs in a COLLADA file's text.
  bool has_word(std::string_view word) const;

 private:
  struct Content;
  void take_unit();
  void place_nodes();

  std::filesystem::path path_;
  std::unique_ptr<Content> content_;
  bool is_fbx_ = false;
  double metres_per_unit_ = 1.0;
  std::vector<ImportedNode> nodes_{};
};

}  // namespace lightwell
