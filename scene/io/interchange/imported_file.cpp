#include "scene/io/interchange/imported_file.h"

#include <fmt/format.h>

#include <assimp/scene.h>

#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <map>

#include "scene/errors.h"
#include "scene/io/interchange/import_trial.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

// Keeps the library from opening files: the scene file is in memory, and pictures are read here.
class NoFiles : public Assimp::IOSystem {
 public:
  bool Exists(const char*) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
  void Close(Assimp::IOStream*) override {}
};

// The message of the library as one sentence's end.
std::string plain(std::string message) {
  if (message.find("bad_alloc") != std::string::npos) {
    return "its contents ask for far more memory than a file of its size needs";
  }
  std::ranges::replace(message, '\n', ' ');
  while (!message.empty() && (message.back() == '.' || message.back() == ' ')) message.pop_back();
  return message.empty() ? "unknown contents" : message;
}

Eigen::Affine3d transform_of(const aiNode& node) {
  const aiMatrix4x4& m = node.mTransformation;
  Eigen::Affine3d result;
  result.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, 0.0,
      0.0, 0.0, 1.0;
  return result;
}

// Names of FBX nodes that the library splits carry its mark.
std::string name_of(const aiNode& node) {
  const std::string name = node.mName.C_Str();
  return name.substr(0, name.find("_$AssimpFbx$"));
}

// A COLLADA file without what the library stumbles over: numbers that follow blanks (<rotate> 0 0 1
// 90</rotate>) end the reading, and cameras without a name lose their angles.
std::string readable_by_library(const std::string& xml) {
  constexpr std::string_view blanks = " \t\r\n", beginnings = "+-.0123456789";
  constexpr std::string_view camera = "<camera ";
  std::string result;
  result.reserve(xml.size());
  for (std::size_t i = 0; i < xml.size(); ++i) {
    result += xml[i];
    if (xml[i] == '<' && xml.compare(i, camera.size(), camera) == 0) {
      result += R"(camera name="" )";
      i += camera.size() - 1;
    }
    if (xml[i] != '>') continue;
    const std::size_t next = xml.find_first_not_of(blanks, i + 1);
    if (next != std::string::npos && beginnings.find(xml[next]) != std::string_view::npos) {
      i = next - 1;
    }
  }
  return result;
}

bool is_sound(const aiMesh& mesh, const aiScene& scene) {
  if (!mesh.HasPositions() || mesh.mMaterialIndex >= scene.mNumMaterials) return false;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    for (unsigned i = 0; i < face.mNumIndices; ++i) {
      if (face.mIndices[i] >= mesh.mNumVertices) return false;
    }
  }
  return true;
}

}  // namespace

struct ImportedFile::Content {
  explicit Content(const std::filesystem::path& path) : text(path) {}

  // Returns the library's message on a fault.
  std::string import(bool is_fbx) {
    importer.SetIOHandler(new NoFiles);
    importer.SetPropertyBool("IMPORT_COLLADA_IGNORE_UP_DIRECTION", true);
    importer.SetPropertyBool("IMPORT_FBX_IGNORE_UP_DIRECTION", true);
    // Joined into one matrix, the library's turns before and after the rotation are wrong.
    importer.SetPropertyBool("IMPORT_FBX_PRESERVE_PIVOTS", true);
    const std::string bytes = is_fbx ? text.text() : readable_by_library(text.text());
    scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, is_fbx ? "fbx" : "dae");
    if (!scene) return plain(importer.GetErrorString());
    if (!scene->mRootNode) return "it has no nodes";
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
      if (!is_sound(*scene->mMeshes[m], *scene)) return fmt::format("mesh {} is torn", m + 1);
    }
    return {};
  }

  TextFile text;
  Assimp::Importer importer{};
  const aiScene* scene = nullptr;  // the importer's
};

ImportedFile::ImportedFile(const std::filesystem::path& path)
    : path_(path), is_fbx_(lower_extension(path) == ".fbx") {
  require_readable(path);
  const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(path));
  if (bytes > largest_import) {
    throw LimitError(
        fmt::format("{}: the file has {} MiB; files of this format may have {}: split "
                    "it, or export glTF",
                    path.string(), bytes >> 20, largest_import >> 20));
  }
  content_ = std::make_unique<Content>(path);
  const auto refuse = [&](const std::string& fault) {
    throw InputError(fmt::format("{}: the file is damaged or no {} file: {}; export it again",
                                 path.string(), is_fbx_ ? "FBX" : "COLLADA", fault));
  };
  // A .zae archive under the name of a .dae may hold far more than its bytes say.
  if (!is_fbx_ && content_->text.text().starts_with("PK")) refuse("it is an archive; unpack it");
  const auto import = [&] { return content_->import(is_fbx_); };
  if (const std::string fault = trial_fault(import, bytes); !fault.empty()) refuse(fault);
  if (const std::string fault = import(); !fault.empty()) refuse(fault);
  take_unit();
  place_nodes();
}

ImportedFile::~ImportedFile() = default;

const aiScene& ImportedFile::scene() const {
  return *content_->scene;
}

// The library scales the root of a COLLADA file to metres, and leaves FBX files in their unit.
void ImportedFile::take_unit() {
  const aiScene& file = scene();
  if (is_fbx_) {
    float centimetres = 1.0f;
    if (file.mMetaData) file.mMetaData->Get("UnitScaleFactor", centimetres);
    metres_per_unit_ = 0.01 * static_cast<double>(centimetres);
  } else {
    metres_per_unit_ = static_cast<double>(file.mRootNode->mTransformation.a1);
  }
  if (!(metres_per_unit_ > 0.0 && std::isfinite(metres_per_unit_))) {
    throw InputError(fmt::format("{}: the unit of length is {} m; it must be above 0",
                                 path_.string(), metres_per_unit_));
  }
}

void ImportedFile::place_nodes() {
  Eigen::Affine3d to_metres = Eigen::Affine3d::Identity();
  if (is_fbx_) to_metres.linear() *= metres_per_unit_;
  struct Open {
    const aiNode* node;
    Eigen::Affine3d parent;
  };
  std::vector<Open> open = {{.node = scene().mRootNode, .parent = to_metres}};
  while (!open.empty()) {
    const Open next = open.back();
    open.pop_back();
    const Eigen::Affine3d to_world = next.parent * transform_of(*next.node);
    nodes_.push_back({.node = next.node, .name = name_of(*next.node), .to_world = to_world});
    // Pushed backwards, since the stack returns the last one first.
    for (unsigned c = next.node->mNumChildren; c > 0; --c) {
      open.push_back({.node = next.node->mChildren[c - 1], .parent = to_world});
    }
  }
}

std::vector<int> ImportedFile::places_of(const std::vector<std::string>& names) const {
  std::map<std::string, std::vector<int>> nodes_of;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    nodes_of[nodes_[i].node->mName.C_Str()].push_back(static_cast<int>(i));
  }
  std::map<std::string, std::size_t> alike, seen;
  for (const std::string& name : names) ++alike[name];
  std::vector<int> places;
  for (const std::string& name : names) {
    const std::vector<int>& nodes = nodes_of[name];
    const std::size_t turn = seen[name]++ * nodes.size() / alike[name];
    places.push_back(nodes.empty() ? -1 : nodes[turn]);
  }
  return places;
}

bool ImportedFile::has_word(std::string_view word) const {
  return content_->text.text().find(word) != std::string::npos;
}

}  // namespace lightwell
